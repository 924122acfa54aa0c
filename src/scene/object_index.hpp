#pragma once
// Names to objects while a scene is being read: interning by hash, where internObject searches.
#include <deltalux/scene.hpp>
#include <string>
#include <string_view>
#include <unordered_map>

namespace deltalux::scene {

class ObjectIndex {
 public:
  /// Indexes what `scene` already has; `scene` must outlive the index and get its objects through it alone.
  explicit ObjectIndex(Scene& scene);

  /// Finds or makes the object `name` and all its prefixes split at `separator`.
  ObjectId intern(std::string_view name, char separator);

 private:
  struct Hash {
    using is_transparent = void;
    std::size_t operator()(std::string_view s) const { return std::hash<std::string_view>{}(s); }
  };
  ObjectId findOrMake(std::string_view name, ObjectId parent);

  Scene& scene_;
  std::unordered_map<std::string, ObjectId, Hash, std::equal_to<>> byName_;
};

}  // namespace deltalux::scene
