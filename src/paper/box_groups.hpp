#pragma once
// Boxes in groups of eight, those in groups of eight, and so on, in the order in which they were added: the parts of an
// object stand near each other in its scene, so that a shaft or a ray that misses a group misses all in it. Adding one
// costs a word a level; asking for any that is met, some eight tests a level along the way.
#include <algorithm>
#include <cstddef>
#include <deltalux/math.hpp>
#include <limits>
#include <vector>

namespace deltalux::paper {

class BoxGroups {
 public:
  struct Part {
    Vec3f lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};

    void extend(const Part& p) { lower = glm::min(lower, p.lower), upper = glm::max(upper, p.upper); }
  };

  void add(const Part& part) {
    all_.extend(part);
    std::size_t at = levels_[0].size();
    levels_[0].push_back(part);
    for (std::size_t level = 1; at >= kGroup || level < levels_.size(); ++level) {
      at /= kGroup;
      if (level == levels_.size()) levels_.push_back(firstOf(levels_[level - 1]));
      if (at == levels_[level].size()) levels_[level].emplace_back();
      levels_[level][at].extend(part);
    }
  }

  bool empty() const { return parts().empty(); }
  const std::vector<Part>& parts() const { return levels_[0]; }
  /// Around them all.
  const Part& all() const { return all_; }

  /// Whether meets(lower, upper) holds of any part; where it holds of a box, it must of all that contain it.
  template <class Meets>
  bool any(const Meets& meets) const {
    return !empty() && meets(all_.lower, all_.upper) && (parts().size() == 1 || anyOf(levels_.size() - 1, 0, meets));
  }

 private:
  static constexpr std::size_t kGroup = 8;  // [task]

  /// The level above one that has just outgrown a group.
  static std::vector<Part> firstOf(const std::vector<Part>& below) {
    std::vector<Part> level(1);
    for (std::size_t i = 0; i < std::min(kGroup, below.size()); ++i) level[0].extend(below[i]);
    return level;
  }

  template <class Meets>
  bool anyOf(std::size_t level, std::size_t group, const Meets& meets) const {
    const std::vector<Part>& boxes = levels_[level];
    const std::size_t end = std::min(boxes.size(), (group + 1) * kGroup);
    for (std::size_t i = group * kGroup; i < end; ++i)
      if (meets(boxes[i].lower, boxes[i].upper) && (level == 0 || anyOf(level - 1, i, meets))) return true;
    return false;
  }

  Part all_;
  std::vector<std::vector<Part>> levels_ = std::vector<std::vector<Part>>(1);  // the parts, groups, groups of groups
};

}  // namespace deltalux::paper
