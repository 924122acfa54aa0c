#include "render/leaf_sites.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "base/smooth.hpp"
#include "base/tuning.hpp"
#include "particles/side_index.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kSitesBlock = 512;  // [task]

bool areParallel(const Vec3f& a, const Vec3f& b) {
  return glm::dot(a, b) > 0 && glm::length(glm::cross(a, b)) < deltalux::tuning::kNegligible;
}

bool sameSurface(const LeafSite& a, const LeafSite& b) {
  const bool samePrimitive = a.primitive == b.primitive;
  if (samePrimitive && (a.faces || b.faces)) return a.front == b.front && glm::dot(a.normal, b.normal) > kSmooth;
  if (!a.flat || !b.flat) return samePrimitive && a.front == b.front;
  if (samePrimitive) return glm::dot(a.normal, b.normal) > kSmooth;
  const float size = 1 / std::sqrt(std::max(a.fineness, b.fineness));
  return areParallel(a.normal, b.normal) &&
         std::abs(glm::dot(b.center - a.center, a.normal)) < deltalux::tuning::kNegligible * size;
}

}  // namespace

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
    site.primitive = elements.domain[site.leaf.index()].primitive;
    site.front = elements.at(site.leaf).front, site.flat = elements.at(site.leaf).flat;
    site.faces = elements.hasFaces(site.leaf);
    site.center = g.center, site.normal = g.normal;
    site.fineness = 1.0f / std::max(g.area, 1e-30f);
    site.support = PatchSupport(elements, scene, site.leaf);
    site.box = {g.lower, g.upper};
    site.reach = site.support.bounds(elements, site.leaf);
  });
  sides_ = sidesOf(all_);
  const Matching matching = before ? match(*before) : Matching{};
  plantTrees(before, matching);
  if (before) findBefore(*before, matching);
  findNear(before, matching.now);
  if (before) findDisturbed(before->standing_);
}

void LeafSites::Side::add(std::uint32_t i, const LeafSite& site) {
  if (sites.empty() && site.flat) normal = site.normal;
  if (!site.flat || (normal && *normal != site.normal)) normal.reset();
  flat = flat || site.flat;
  sites.push_back(i);
  reach.extend(site.reach);
}

void LeafSites::Side::plantTree(std::span<const LeafSite> of) {
  std::vector<BoxF> boxes;
  boxes.reserve(sites.size());
  for (const std::uint32_t i : sites) boxes.push_back(of[i].reach);
  reaches = std::make_shared<const BoxTree>(std::move(boxes));
}

bool LeafSites::Side::mayContinue(const Side& other) const {
  if (primitive == other.primitive) return true;
  return flat && other.flat && (!normal || !other.normal || areParallel(*normal, *other.normal));
}

std::vector<LeafSites::Side> LeafSites::sidesOf(std::span<const LeafSite> sites) {
  const auto numberOf = [](const LeafSite& site) { return particles::sideIndex(site.primitive, site.front); };
  std::vector<std::uint32_t> placeOf;  // by number, among those that have sites
  for (const LeafSite& site : sites) {
    placeOf.resize(std::max(placeOf.size(), numberOf(site) + 1), kNone);
    placeOf[numberOf(site)] = 0;
  }
  std::vector<Side> sides;
  for (std::size_t number = 0; number < placeOf.size(); ++number) {
    if (placeOf[number] == kNone) continue;
    placeOf[number] = static_cast<std::uint32_t>(sides.size());
    sides.push_back({number, PrimitiveId(number / 2)});
  }
  for (std::uint32_t i = 0; i < sites.size(); ++i) sides[placeOf[numberOf(sites[i])]].add(i, sites[i]);
  return sides;
}

BoxTree LeafSites::treeOver(std::span<const Side> sides) {
  std::vector<BoxF> reaches;
  for (const Side& side : sides) reaches.push_back(side.reach);
  return BoxTree(std::move(reaches));
}

LeafSites::Matching LeafSites::match(const LeafSites& before) const {
  Matching m{std::vector<std::uint32_t>(all_.size(), kNone), std::vector<std::uint32_t>(before.size(), kNone)};
  parallelFor(all_.size(), kSitesBlock, [&](std::size_t i) {
    const std::size_t element = all_[i].leaf.index();
    const std::uint32_t was = element < before.siteOf_.size() ? before.siteOf_[element] : kNone;
    if (was != kNone && all_[i].sameAs(before.all_[was])) m.before[i] = was, m.now[was] = static_cast<std::uint32_t>(i);
  });
  return m;
}

void LeafSites::plantTrees(const LeafSites* before, const Matching& matching) {
  parallelFor(sides_.size(), 1, [&](std::size_t s) {
    Side& side = sides_[s];
    if (before) {
      const auto was = std::ranges::lower_bound(before->sides_, side.number, {}, &Side::number);
      if (was != before->sides_.end() && was->number == side.number && was->sites.size() == side.sites.size() &&
          std::ranges::none_of(side.sites, [&](std::uint32_t i) { return matching.before[i] == kNone; })) {
        side.reaches = was->reaches;
        return;
      }
    }
    side.plantTree(all_);
  });
}

void LeafSites::findBefore(const LeafSites& before, const Matching& matching) {
  before_ = matching.before;
  std::vector<LeafSite> changed;
  for (std::size_t i = 0; i < all_.size(); ++i)
    if (before_[i] == kNone) changed.push_back(all_[i]);
  for (std::size_t was = 0; was < before.size(); ++was)
    if (matching.now[was] == kNone) changed.push_back(before.all_[was]);
  if (changed.empty()) return;
  std::vector<Side> sides = sidesOf(changed);
  for (Side& side : sides) side.plantTree(changed);
  const BoxTree around = treeOver(sides);
  parallelFor(sides_.size(), 1, [&](std::size_t s) {
    const Side& here = sides_[s];
    around.overlapping(here.reach, [&](std::uint32_t k) {
      const Side& other = sides[k];
      if (!here.mayContinue(other)) return;
      for (const std::uint32_t i : here.sites)
        if (before_[i] != kNone && other.reaches->anyOverlapping(all_[i].box, [&](std::uint32_t j) {
              return sameSurface(all_[i], changed[other.sites[j]]);
            }))
          before_[i] = kNone;
    });
  });
}

void LeafSites::findNear(const LeafSites* before, std::span<const std::uint32_t> numberNow) {
  const BoxTree sides = treeOver(sides_);
  std::vector<std::uint32_t> sideOf(all_.size());
  for (std::uint32_t s = 0; s < sides_.size(); ++s)
    for (const std::uint32_t i : sides_[s].sites) sideOf[i] = s;

  std::vector<std::vector<std::uint32_t>> lists((all_.size() + kSitesBlock - 1) / kSitesBlock);
  nearBegin_.assign(all_.size() + 1, 0);
  parallelBlocks(all_.size(), kSitesBlock, [&](std::size_t begin, std::size_t end) {
    auto& list = lists[begin / kSitesBlock];
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = list.size();
      const LeafSite& site = all_[i];
      if (this->before(i) != kNone) {
        for (const std::uint32_t was : before->near(before_[i])) list.push_back(numberNow[was]);
      } else {
        sides.overlapping(site.box, [&](std::uint32_t s) {
          const Side& side = sides_[s];
          if (!side.mayContinue(sides_[sideOf[i]])) return;
          side.reaches->overlapping(site.box, [&](std::uint32_t k) {
            const std::uint32_t j = side.sites[k];
            if (j != i && sameSurface(site, all_[j]) && all_[j].support.reaches(elements_, scene_, site.leaf))
              list.push_back(j);
          });
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
