#include "render/leaf_sites.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/parallel.hpp"
#include "base/tuning.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kSitesBlock = 512;  // [task]

BoxF floatBox(const Box& box) { return box.empty() ? BoxF{} : BoxF{Vec3f(box.lower), Vec3f(box.upper)}; }

bool sameBox(const BoxF& a, const BoxF& b) { return a.lower == b.lower && a.upper == b.upper; }

/// Of sites, which reach where: a tree for those of each size, since small ones beside large ones make wide nodes.
class Reaches {
 public:
  explicit Reaches(std::span<const LeafSite> sites) {
    std::map<int, Group> groups;  // by octave
    for (std::uint32_t i = 0; i < sites.size(); ++i) {
      const BoxF& box = sites[i].reach;
      Group& group = groups[std::ilogb(glm::length(box.upper - box.lower) + std::numeric_limits<float>::min())];
      group.sites.push_back(i), group.boxes.push_back(box);
    }
    for (auto& [octave, group] : groups) trees_.push_back({BoxTree(std::move(group.boxes)), std::move(group.sites)});
  }

  /// visit(site), by size.
  template <class Visit>
  void overlapping(const BoxF& box, const Visit& visit) const {
    for (const auto& [tree, sites] : trees_) tree.overlapping(box, [&](std::uint32_t k) { visit(sites[k]); });
  }

 private:
  struct Group {
    std::vector<std::uint32_t> sites;
    std::vector<BoxF> boxes;
  };
  struct Tree {
    BoxTree tree;
    std::vector<std::uint32_t> sites;
  };
  std::vector<Tree> trees_;
};

}  // namespace

Standing::Standing(const Scene& scene) : boxes_(scene.primitives.size()), materials_(scene.primitives.size()) {
  parallelFor(boxes_.size(), kSitesBlock, [&](std::size_t i) {
    boxes_[i] = floatBox(bounds(scene.primitives[i].shape));
    materials_[i] = scene.primitives[i].material;
  });
  for (const Placement& p : scene.placements) {
    placed_.push_back({p.primitive, p.matrix});
    if (!p.present) boxes_[p.primitive.index()] = BoxF{};
  }
}

std::vector<char> Standing::changedSince(const Standing& before) const {
  std::vector<char> moved(std::max(boxes_.size(), before.boxes_.size()), 0);
  for (std::size_t i = 0; i < moved.size(); ++i)
    moved[i] = i >= boxes_.size() || i >= before.boxes_.size() || !sameBox(boxes_[i], before.boxes_[i]) ||
               materials_[i] != before.materials_[i];
  // What was turned may have the same box.
  std::map<PrimitiveId, Mat4> was(before.placed_.begin(), before.placed_.end());
  for (const auto& [primitive, matrix] : placed_) {
    const auto found = was.find(primitive);
    if (found == was.end() || found->second != matrix) moved[primitive.index()] = 1;
    if (found != was.end()) was.erase(found);
  }
  for (const auto& [primitive, matrix] : was) moved[primitive.index()] = 1;
  return moved;
}

std::vector<BoxF> Standing::movedSince(const Standing& before) const {
  const std::vector<char> moved = changedSince(before);
  std::vector<BoxF> result;
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (!moved[i]) continue;
    for (const auto* boxes : {&before.boxes_, &boxes_})
      if (i < boxes->size() && (*boxes)[i].lower.x <= (*boxes)[i].upper.x) result.push_back((*boxes)[i]);
  }
  return result;
}

LeafSites::LeafSites(const hierarchy::Elements& elements, const Scene& scene, const LeafSites* before)
    : elements_(elements), scene_(scene), standing_(scene), siteOf_(elements.size(), kNone) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    if (!elements.isReceivingLeaf(hierarchy::ElementId(i))) continue;
    siteOf_[i] = static_cast<std::uint32_t>(all_.size());
    LeafSite site;
    site.leaf = hierarchy::ElementId(i);
    all_.push_back(site);
  }
  parallelFor(all_.size(), kSitesBlock, [&](std::size_t i) {
    LeafSite& site = all_[i];
    const hierarchy::ElementGeometry& g = elements.shape(site.leaf);
    site.center = g.center;
    site.fineness = 1.0f / std::max(g.area, 1e-30f);
    site.support = PatchSupport(elements, scene, site.leaf);
    site.box = {g.lower, g.upper};
    site.reach = site.support.bounds(elements, site.leaf);
  });
  findNear(before);
  if (before) findDisturbed(before->standing_);
}

bool LeafSites::sameSurface(hierarchy::ElementId a, hierarchy::ElementId b) const {
  const hierarchy::PatchDomain &da = elements_.domain[a.index()], &db = elements_.domain[b.index()];
  const bool samePrimitive = da.primitive == db.primitive;
  if (samePrimitive && (elements_.hasFaces(a) || elements_.hasFaces(b)))
    return elements_.at(a).front == elements_.at(b).front &&
           glm::dot(elements_.shape(a).normal, elements_.shape(b).normal) > deltalux::tuning::kSmooth;
  if (!elements_.at(a).flat || !elements_.at(b).flat)
    return samePrimitive && elements_.at(a).front == elements_.at(b).front;
  const hierarchy::ElementGeometry &ga = elements_.shape(a), &gb = elements_.shape(b);
  const float cosine = glm::dot(ga.normal, gb.normal);
  if (samePrimitive) return cosine > deltalux::tuning::kSmooth;
  const float size = std::sqrt(std::min(ga.area, gb.area));
  return cosine > 0 && glm::length(glm::cross(ga.normal, gb.normal)) < deltalux::tuning::kNegligible &&
         std::abs(glm::dot(gb.center - ga.center, ga.normal)) < deltalux::tuning::kNegligible * size;
}

void LeafSites::findNear(const LeafSites* before) {
  std::vector<std::uint32_t> numberNow;  // by number before
  std::vector<BoxF> changed;             // where leaves came and went
  if (before) {
    before_.assign(all_.size(), kNone);
    numberNow.assign(before->size(), kNone);
    for (std::uint32_t i = 0; i < all_.size(); ++i) {
      const std::size_t element = all_[i].leaf.index();
      const std::uint32_t was = element < before->siteOf_.size() ? before->siteOf_[element] : kNone;
      if (was != kNone && all_[i].sameAs(before->all_[was])) {
        before_[i] = was, numberNow[was] = i;
      } else {
        changed.push_back(all_[i].reach);
      }
    }
    for (std::size_t was = 0; was < before->size(); ++was)
      if (numberNow[was] == kNone) changed.push_back(before->all_[was].reach);
    if (!changed.empty()) {
      const BoxTree around(changed);
      parallelFor(all_.size(), kSitesBlock, [&](std::size_t i) {
        if (before_[i] != kNone) around.overlapping(all_[i].box, [&](std::uint32_t) { before_[i] = kNone; });
      });
    }
  }
  const Reaches reaches(!before || !changed.empty() ? std::span(std::as_const(all_)) : std::span<const LeafSite>());

  std::vector<std::vector<std::uint32_t>> lists((all_.size() + kSitesBlock - 1) / kSitesBlock);
  nearBegin_.assign(all_.size() + 1, 0);
  parallelBlocks(all_.size(), kSitesBlock, [&](std::size_t begin, std::size_t end) {
    auto& list = lists[begin / kSitesBlock];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = list.size();
      if (this->before(i) != kNone) {
        for (const std::uint32_t was : before->near(before_[i])) list.push_back(numberNow[was]);
      } else {
        reaches.overlapping(all_[i].box, [&](std::uint32_t j) {
          if (j != i && sameSurface(all_[i].leaf, all_[j].leaf) &&
              all_[j].support.reaches(elements_, scene_, all_[i].leaf))
            list.push_back(j);
        });
        std::sort(list.begin() + static_cast<std::ptrdiff_t>(first), list.end());
      }
      nearBegin_[i + 1] = static_cast<std::uint32_t>(list.size() - first);
    }
  });
  for (std::size_t i = 0; i < all_.size(); ++i) nearBegin_[i + 1] += nearBegin_[i];
  near_.reserve(nearBegin_.back());
  for (const auto& list : lists) near_.insert(near_.end(), list.begin(), list.end());
}

void LeafSites::findDisturbed(const Standing& before) {
  std::vector<BoxF> moved = standing_.movedSince(before);
  if (moved.empty()) return;
  disturbed_.assign(all_.size(), 0);
  const BoxTree tree(std::move(moved));
  parallelFor(all_.size(), kSitesBlock, [&](std::size_t i) {
    BoxF box = all_[i].box;
    for (const std::uint32_t j : near(i)) box.extend(all_[j].box);
    const Vec3f margin(0.25f * glm::length(box.upper - box.lower));  // rays run a little above
    tree.overlapping({box.lower - margin, box.upper + margin}, [&](std::uint32_t) { disturbed_[i] = 1; });
  });
}

}  // namespace deltalux::rendering
