// Which samples an edit has made wrong. A sample stands as long as its path does and the light that it read: nothing
// that it met has moved or looks otherwise, nothing has come in between, and the patches that it read from send what
// they sent, within half a step of a screen.
#include "render/sample_changes.hpp"

#include <algorithm>
#include <bit>

#include "base/few_boxes.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "base/tuning.hpp"
#include "particles/segment_box.hpp"
#include "particles/side_index.hpp"
#include "render/place_boxes.hpp"
#include "render/reader_state.hpp"
#include "render/tuning.hpp"

namespace deltalux {

namespace rendering {

namespace {

constexpr std::size_t kSiteBlock = 512;  // [task]

/// What differs from what was noted, apart from the light of leaves.
struct Difference {
  std::vector<char> primitives;  // that moved, or look otherwise
  std::vector<Box> moved, came;  // where they were and are; where they are
  std::vector<char> textures;    // by side
  bool background = false;
};

bool sameLook(const Material& a, const Material& b) {
  return a.surface == b.surface && a.emission == b.emission && a.coverage == b.coverage && a.filter == b.filter;
}

std::uint64_t hashOf(const caustics::SurfaceCaustics& s) {
  std::uint64_t h = 1;
  const auto add = [&](float x) { h = (h ^ std::bit_cast<std::uint32_t>(x)) * 0x9e3779b97f4a7c15ull, h ^= h >> 29; };
  for (const caustics::CausticTexture& t : s.textures) {
    h = combineKeys(combineKeys(h, t.texels.size()), static_cast<std::uint64_t>(t.width));
    for (std::size_t i = 0; i < t.texels.size(); ++i) {
      for (int c = 0; c < 3; ++c) add(t.texels[i][c]);
      add(t.areas[i]);
    }
  }
  return h | 1;
}

void comparePlacements(const Scene& scene, NotedSolution& noted, Difference& d) {
  const auto now = [&](const Placement& p) { return NotedSolution::Placed{p.primitive, p.matrix, p.present}; };
  const auto differs = [](const NotedSolution::Placed& a, const NotedSolution::Placed& b) {
    return a.matrix != b.matrix || a.present != b.present;
  };
  std::vector<NotedSolution::Placed> placed;
  for (const Placement& p : scene.placements) placed.push_back(now(p));
  auto before = noted.placed.begin();
  for (const NotedSolution::Placed& p : placed) {
    for (; before != noted.placed.end() && before->primitive < p.primitive; ++before)
      d.primitives[before->primitive.index()] = 1;
    const bool known = before != noted.placed.end() && before->primitive == p.primitive;
    if (differs(p, known ? *before : NotedSolution::Placed{})) d.primitives[p.primitive.index()] = 1;
    if (known) ++before;
  }
  for (; before != noted.placed.end(); ++before) d.primitives[before->primitive.index()] = 1;
  noted.placed = std::move(placed);
}

/// Where what moved was and is, and new primitives.
void compareShapes(const Scene& scene, NotedSolution& noted, Difference& d) {
  comparePlacements(scene, noted, d);
  const std::size_t known = noted.boxes.size();
  noted.boxes.resize(scene.primitives.size());
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    if (p < known && !d.primitives[p]) continue;
    const Box box = bounds(scene.primitives[p].shape);
    if (p < known && !noted.boxes[p].empty()) d.moved.push_back(noted.boxes[p]);
    const auto at = std::lower_bound(noted.placed.begin(), noted.placed.end(), PrimitiveId(p),
                                     [](const NotedSolution::Placed& a, PrimitiveId b) { return a.primitive < b; });
    const bool there = at == noted.placed.end() || at->primitive != PrimitiveId(p) || at->present;
    noted.boxes[p] = there ? box : Box{};
    if (there) d.came.push_back(box), d.moved.push_back(box);
    d.primitives[p] = 1;
  }
}

void compareLooks(const Scene& scene, NotedSolution& noted, Difference& d) {
  std::vector<char> materials(scene.materials.size(), 1);
  for (std::size_t m = 0; m < std::min(materials.size(), noted.materials.size()); ++m)
    materials[m] = !sameLook(scene.materials[m], noted.materials[m]);
  noted.materialOf.resize(scene.primitives.size());
  for (std::size_t p = 0; p < scene.primitives.size(); ++p) {
    const MaterialId m = scene.primitives[p].material;
    if (noted.materialOf[p] != m || materials[m.index()]) d.primitives[p] = 1;
    noted.materialOf[p] = m;
  }
  noted.materials = scene.materials;

  for (std::size_t l = 0; l < std::max(scene.lights.size(), noted.lights.size()); ++l) {
    const bool there = l < scene.lights.size();
    const Light& light = there ? scene.lights[l] : noted.lights[l];
    if (there && l < noted.lights.size() && light.emitter == noted.lights[l].emitter &&
        light.scale == noted.lights[l].scale)
      continue;
    if (const auto* area = std::get_if<AreaLight>(&light.emitter))
      d.primitives[area->primitive.index()] = 1;
    else
      d.background = d.background || std::holds_alternative<SunLight>(light.emitter) ||
                     std::holds_alternative<DomeLight>(light.emitter);
  }
  d.background = d.background || scene.backdrops != noted.backdrops;
  noted.lights = scene.lights, noted.backdrops = scene.backdrops;
}

void compareTextures(const Solution& s, NotedSolution& noted, Difference& d) {
  noted.textures.resize(d.textures.size(), 0);
  std::vector<std::uint64_t> now(d.textures.size(), 0);
  parallelFor(s.caustics.surfaces.size(), 1, [&](std::size_t i) {
    const caustics::SurfaceCaustics& c = s.caustics.surfaces[i];
    now[particles::sideIndex(c.primitive, c.front)] = hashOf(c);
  });
  for (std::size_t side = 0; side < now.size(); ++side) d.textures[side] = now[side] != noted.textures[side];
  noted.textures = std::move(now);
}

Difference compareAll(const Solution& s, NotedSolution& noted) {
  Difference d;
  d.primitives.assign(s.scene.primitives.size(), 0);
  d.textures.assign(2 * s.scene.primitives.size(), 0);
  compareShapes(s.scene, noted, d);
  compareLooks(s.scene, noted, d);
  compareTextures(s, noted, d);
  return d;
}

/// Marks what moved as having come to be where it is now.
void addPlaces(const Difference& d, SampleChanges& changes) {
  for (const Box& box : coveringBoxes(d.came, kFewBoxes)) changes.places.push_back({box, changes.version});
  while (changes.places.size() > kFewBoxes) {
    changes.places[1].box.extend(changes.places[0].box);
    changes.places.erase(changes.places.begin());
  }
}

/// The light of leaves against what was noted of it. Whatever blends into the points of a leaf is read there.
class LeafComparison {
 public:
  LeafComparison(const Solution& s, const IrradianceField& field, NotedSolution& noted, const Difference& difference)
      : elements_(s.elements), field_(field), noted_(noted), difference_(difference) {
    noted_.leaves.resize(elements_.size());
    floor_ = field_.floorOf([&](std::size_t i) { return maxChannel(field_.trend(i).value); });
    findDarkest();
  }

  /// changed(element): another light can be read there.
  template <class Changed>
  void compare(const Changed& changed) {
    dropLeaves(changed);
    const std::size_t n = field_.sites();
    std::vector<char> differs(n);
    parallelFor(n, kSiteBlock,
                [&](std::size_t i) { differs[i] = change(i) > SolutionReader::kVisibleStep * darkest_[i]; });
    std::vector<char> readsOther(n);
    parallelFor(n, kSiteBlock, [&](std::size_t i) {
      const auto blended = field_.blended(i);
      const NotedSolution::Leaf& leaf = noted(i);
      readsOther[i] = leaf.key != key(i) || leaf.neighbours != neighbourhood(i) || textureChanged(i) ||
                      std::any_of(blended.begin(), blended.end(), [&](std::uint32_t j) { return differs[j]; }) ||
                      cutOtherwise(i);
    });
    for (std::size_t i = 0; i < n; ++i) {
      if (readsOther[i]) changed(field_.leafOf(i));
      NotedSolution::Leaf& leaf = noted(i);
      if (differs[i] || leaf.key != key(i)) leaf.trend = field_.trend(i);
      leaf.key = key(i), leaf.neighbours = neighbourhood(i);
    }
  }

 private:
  NotedSolution::Leaf& noted(std::size_t i) { return noted_.leaves[field_.leafOf(i).index()]; }
  std::uint64_t key(std::size_t i) const { return elements_.key[field_.leafOf(i).index()] | 1; }

  /// By site, of all leaves at whose points it is read.
  void findDarkest() {
    darkest_.assign(field_.sites(), std::numeric_limits<float>::infinity());
    for (std::size_t i = 0; i < field_.sites(); ++i) {
      const float E = std::max(maxChannel(field_.trend(i).value), floor_);
      for (const std::uint32_t j : field_.blended(i)) darkest_[j] = std::min(darkest_[j], E);
    }
  }

  /// Greatest change of what is read of a site, over all of where it is.
  float change(std::size_t i) {
    const IrradianceField::Trend now = field_.trend(i), &before = noted(i).trend;
    const hierarchy::ElementGeometry& g = elements_.shape(field_.leafOf(i));
    // Supports reach about as far again as the patch.
    const Vec3f extent = g.upper - g.lower;
    Rgb sum = glm::abs(now.value - before.value);
    for (int k = 0; k < 3; ++k) sum += extent[k] * glm::abs(now.slope[k] - before.slope[k]);
    return maxChannel(sum);
  }

  std::uint64_t neighbourhood(std::size_t i) const {
    std::uint64_t h = field_.blendedFreely(i);
    for (const std::uint32_t j : field_.blended(i)) h = (h ^ key(j)) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return h;
  }

  bool textureChanged(std::size_t i) const {
    const hierarchy::ElementId leaf = field_.leafOf(i);
    return difference_
        .textures[particles::sideIndex(elements_.domain[leaf.index()].primitive, elements_.at(leaf).front)];
  }

  /// Whether what moved stands, or stood, between the leaf and its neighbours.
  bool cutOtherwise(std::size_t i) const {
    if (difference_.moved.empty() || field_.blendedFreely(i) == field_.blended(i).size()) return false;
    Box around;
    for (const std::uint32_t j : field_.blended(i)) around.extend(elements_.box(field_.leafOf(j)));
    return std::any_of(difference_.moved.begin(), difference_.moved.end(),
                       [&](const Box& box) { return box.overlaps(around); });
  }

  /// What was a leaf and is none any more.
  template <class Changed>
  void dropLeaves(const Changed& changed) {
    std::vector<char> stands(noted_.leaves.size(), 0);
    for (std::size_t i = 0; i < field_.sites(); ++i) stands[field_.leafOf(i).index()] = 1;
    for (std::size_t e = 0; e < stands.size(); ++e) {
      if (stands[e] || noted_.leaves[e].key == 0) continue;
      noted_.leaves[e] = {};
      changed(hierarchy::ElementId(e));
    }
  }

  const hierarchy::Elements& elements_;
  const IrradianceField& field_;
  NotedSolution& noted_;
  const Difference& difference_;
  float floor_ = 0;
  std::vector<float> darkest_;
};

}  // namespace

std::shared_ptr<const SampleChanges> noteChanges(ReaderState& state, const SampleChanges* before) {
  const Solution& s = state.solution();
  auto changes = before ? std::make_shared<SampleChanges>(*before) : std::make_shared<SampleChanges>();
  changes->version = state.version;
  const Difference d = compareAll(s, state.noted);
  const std::uint64_t now = changes->version;
  bool any = d.background;
  if (d.background) changes->background = now;
  changes->primitives.resize(s.scene.primitives.size(), now);
  for (std::size_t p = 0; p < d.primitives.size(); ++p)
    if (d.primitives[p]) changes->primitives[p] = now, any = true;
  changes->patches.resize(s.elements.size(), now);
  LeafComparison(s, state.reconstruction->field, state.noted, d).compare([&](hierarchy::ElementId e) {
    changes->patches[e.index()] = now, any = true;
  });
  if (before)
    addPlaces(d, *changes);
  else
    changes->since = now;
  if (any) changes->latest = now;
  return changes;
}

}  // namespace rendering

bool SampleChanges::stale(const PixelSample& s) const {
  if (s.version < since || (!s.complete && latest > s.version)) return true;
  for (std::uint8_t i = 0; i < s.corners; ++i) {
    const PixelSample::Corner& c = s.path[i];
    if (!c.primitive.valid() && background > s.version) return true;
    if (c.primitive.valid() &&
        (c.primitive.index() >= primitives.size() || primitives[c.primitive.index()] > s.version))
      return true;
    if (c.patch != PixelSample::Corner{}.patch && (c.patch >= patches.size() || patches[c.patch] > s.version))
      return true;
  }
  for (auto place = places.rbegin(); place != places.rend() && place->version > s.version; ++place) {
    const Vec3f reach(glm::max(glm::abs(place->box.lower), glm::abs(place->box.upper)));
    const particles::SegmentBox box(place->box, 1e-6 * double(maxChannel(reach)));
    for (std::uint8_t i = 0; i < s.corners; ++i) {
      const PixelSample::Corner& c = s.path[i];
      if (box.meets(c.before == PixelSample::kEye ? s.eye : s.path[c.before].position, c.position)) return true;
    }
  }
  return false;
}

}  // namespace deltalux
