#pragma once
#include <cstdint>
#include <deltalux/edit.hpp>
#include <set>
#include <string>
#include <vector>

namespace deltalux::python {

/// Edits that are collected before they are applied. Each is tried at once on a copy of the scene, so that a mistake is
/// told where it is made, and what an edit depends on is known.
class EditList {
 public:
  EditList(const Scene& scene, std::uint64_t version) : scene_(scene), version_(version) { addAreaLights(scene_); }

  /// Throws InputError, and the list is as before.
  void take(const Edit& edit) {
    applyEdit(scene_, edit);
    edits_.push_back(edit);
  }
  const std::vector<Edit>& edits() const { return edits_; }
  /// The scene as the edits have it.
  const Scene& scene() const { return scene_; }
  /// Of the solution that they are for.
  std::uint64_t version() const { return version_; }

  std::vector<Restore> applied;    // undoes the edits that the engine has
  std::set<std::string> selected;  // objects that the engine is to move frame by frame
  /// They are for the solution that they have made so far.
  void follow(std::uint64_t version) { version_ = version; }

 private:
  Scene scene_;
  std::vector<Edit> edits_;
  std::uint64_t version_;
};

}  // namespace deltalux::python
