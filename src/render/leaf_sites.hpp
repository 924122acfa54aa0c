#pragma once
// The leaves that irradiance is reconstructed from, where they lie, and which of them may take part at whose points:
// what follows from geometry alone. Made from the sites of the solution before, only what has changed is looked for
// anew; the result is the same.
// Cost: per leaf that is new, or of a surface with one that is new or gone nearby, a search in the trees of the sides
// that its own surface can go on in.
#include <deltalux/scene.hpp>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "render/patch_support.hpp"
#include "render/standing.hpp"

namespace deltalux::rendering {

struct LeafSite {
  hierarchy::ElementId leaf;
  PrimitiveId primitive;
  bool front = true, flat = false, faces = false;
  Vec3f center{0.0f}, normal{0.0f};
  float fineness = 0;  // 1 / area
  PatchSupport support;
  BoxF box;    // of the leaf
  BoxF reach;  // of its support

  bool sameAs(const LeafSite& other) const {
    return leaf == other.leaf && center == other.center && normal == other.normal && fineness == other.fineness &&
           support == other.support && box.lower == other.box.lower && box.upper == other.box.upper;
  }
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
  /// The sites of one side of a primitive, and where their supports reach.
  struct Side {
    std::size_t number = 0;  // particles::sideIndex
    PrimitiveId primitive;
    std::vector<std::uint32_t> sites = {};  // ascending
    BoxF reach = {};                        // of all
    bool flat = false;                      // any
    std::optional<Vec3f> normal = {};       // where all are flat and have the same
    std::shared_ptr<const BoxTree> reaches = {};

    void add(std::uint32_t site, const LeafSite&);
    void plantTree(std::span<const LeafSite>);
    /// Whether a site of one may be of the same surface as one of the other.
    bool mayContinue(const Side&) const;
  };
  /// Those that have sites, ascending, without trees.
  static std::vector<Side> sidesOf(std::span<const LeafSite>);

  /// Over what their sites reach.
  static BoxTree treeOver(std::span<const Side>);

  /// By site, its number before where it stands as it did; and by number before.
  struct Matching {
    std::vector<std::uint32_t> before, now;
  };
  Matching match(const LeafSites& before) const;
  /// Trees over reaches: those of the sides before whose sites all stand.
  void plantTrees(const LeafSites* before, const Matching&);
  /// Leaves what stands beside a site that came or went without a number before.
  void findBefore(const LeafSites& before, const Matching&);
  void findNear(const LeafSites* before, std::span<const std::uint32_t> numberNow);
  void findDisturbed(const Standing& before);

  const hierarchy::Elements& elements_;
  const Scene& scene_;
  Standing standing_;
  std::vector<LeafSite> all_;
  std::vector<Side> sides_;
  std::vector<std::uint32_t> siteOf_;  // per element
  std::vector<std::uint32_t> nearBegin_, near_;
  std::vector<std::uint32_t> before_;
  std::vector<char> disturbed_;
};

}  // namespace deltalux::rendering
