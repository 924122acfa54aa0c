#pragma once
// The leaves that irradiance is reconstructed from, where they lie, and which of them may take part at whose points:
// what follows from geometry alone. Made from the sites of the solution before, only what has changed is looked for
// anew; the result is the same.
// Cost: a search in a box tree per leaf that is new or near to one that is new or gone.
#include <deltalux/scene.hpp>
#include <span>
#include <vector>

#include "render/patch_support.hpp"

namespace deltalux::rendering {

struct LeafSite {
  hierarchy::ElementId leaf;
  Vec3f center{0.0f};
  float fineness = 0;  // 1 / area
  PatchSupport support;
  BoxF box;    // of the leaf
  BoxF reach;  // of its support

  bool sameAs(const LeafSite& other) const {
    return leaf == other.leaf && center == other.center && fineness == other.fineness && support == other.support &&
           box.lower == other.box.lower && box.upper == other.box.upper;
  }
};

/// What of a scene can stand between two leaves, to tell where something has moved.
class Standing {
 public:
  Standing() = default;
  explicit Standing(const Scene&);
  /// By primitive: whether it came, went, moved or was changed since.
  std::vector<char> changedSince(const Standing& before) const;
  /// Where these were and are: boxes.
  std::vector<BoxF> movedSince(const Standing& before) const;

 private:
  std::vector<BoxF> boxes_;                           // by primitive
  std::vector<MaterialId> materials_;                 // the same
  std::vector<std::pair<PrimitiveId, Mat4>> placed_;  // ascending
};

class LeafSites {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  /// The elements and the scene must outlive this; `before` need not.
  LeafSites(const hierarchy::Elements&, const Scene&, const LeafSites* before);

  std::size_t size() const { return all_.size(); }
  const LeafSite& operator[](std::size_t i) const { return all_[i]; }
  std::uint32_t of(hierarchy::ElementId leaf) const { return siteOf_[leaf.index()]; }
  /// Other sites of the same surface whose supports reach the leaf, ascending.
  std::span<const std::uint32_t> near(std::size_t i) const {
    return {near_.data() + nearBegin_[i], nearBegin_[i + 1] - nearBegin_[i]};
  }
  std::size_t nearBegin(std::size_t i) const { return nearBegin_[i]; }
  std::size_t nearCount() const { return near_.size(); }

  /// The number that the same leaf had before, in the same place with the same ones near; none where that is not so.
  std::uint32_t before(std::size_t i) const { return before_.empty() ? kNone : before_[i]; }
  /// Whether something has moved where rays between the leaf and those near it run.
  bool disturbed(std::size_t i) const { return !disturbed_.empty() && disturbed_[i]; }

 private:
  void findNear(const LeafSites* before);
  void findDisturbed(const Standing& before);
  bool sameSurface(hierarchy::ElementId a, hierarchy::ElementId b) const;

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  Standing standing_;
  std::vector<LeafSite> all_;
  std::vector<std::uint32_t> siteOf_;  // per element
  std::vector<std::uint32_t> nearBegin_, near_;
  std::vector<std::uint32_t> before_;
  std::vector<char> disturbed_;
};

}  // namespace deltalux::rendering
