#include "particles/transfer.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/room.hpp"
#include "base/sort_unique.hpp"
#include "hierarchy/patch.hpp"
#include "hierarchy/side_locator.hpp"
#include "particles/surface_normal.hpp"

namespace deltalux::particles {

namespace {

constexpr std::size_t kBlock = 1024;  // [task]

/// By element: whether particles are placed there when they start or land on it.
std::vector<char> placesOf(const hierarchy::Elements& elements) {
  std::vector<char> places(elements.size());
  for (std::size_t i = 0; i < places.size(); ++i) places[i] = elements.isReceivingLeaf(hierarchy::ElementId(i));
  return places;
}

std::vector<hierarchy::ElementId> surfacesOf(const hierarchy::Elements& elements) {
  std::vector<hierarchy::ElementId> surfaces;
  for (std::size_t i = 0; i < elements.size(); ++i)
    if (elements.receives(hierarchy::ElementId(i)) && elements.topology[i].depth == 0) surfaces.emplace_back(i);
  return surfaces;
}

bool earlier(const RetracedPath& a, const RetracedPath& b) { return a.path < b.path; }

/// Whether a path first meets a side that no light reaches: it starts under what stands there.
bool startsInTheDark(const Particles& p, std::size_t path, const hierarchy::SideLocator& locator, const Scene& scene) {
  const PrimitiveId met = p.metBy(path)[1];
  if (!met.valid()) return false;
  const Shape& shape = scene[met].shape;
  if (std::holds_alternative<Mesh>(shape)) return false;  // its triangle is not known
  if (const Material& m = scene.materialOf(met); !std::holds_alternative<Opaque>(m.surface) || passesStraight(m))
    return false;
  const bool front = locator.side(met, 0, true).valid(), back = locator.side(met, 0, false).valid();
  if (front == back) return !front;
  const std::span<const Vec3f> v = p.verticesOf(path);
  return (glm::dot(normalAt(shape, Vec3(v[1]), 0), Vec3(v[1] - v[0])) < 0) != front;
}

}  // namespace

std::uint32_t ParticleTransfer::locateSender(const Particles& p, std::size_t path,
                                             const hierarchy::SideLocator& locator, const Scene& scene) const {
  const SenderCell& cell = p.senderCells[p.sender[path]];
  if (cell.kind != SenderKind::Side) return cell.light.value;
  const hierarchy::ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
  if (!side.valid() || startsInTheDark(p, path, locator, scene)) return kNone;
  return static_cast<std::uint32_t>(lights_) + locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.value;
}

void ParticleTransfer::locate(const Particles& p, std::size_t path, const hierarchy::SideLocator& locator,
                              const Scene& scene) {
  if (!(p.termination[path] & kArrived)) return;
  senderOf_[path] = locateSender(p, path, locator, scene);
  for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
    const hierarchy::ElementId side =
        locator.side(p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0);
    elementOf_[i] = side.valid() ? locator.leafAt(side, Vec2(p.uv[i])).value : kNone;
  }
}

template <class Visit>
void ParticleTransfer::visit(const Particles& p, std::size_t path, std::uint32_t sender, std::uint32_t cell,
                             const PathRange& range, const Visit& visit) const {
  const ParticleLink& link = p.links[p.link[path]];
  const float scale = link.scale;
  for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i)
    visit(Deposit{elementOf_[i], sender, scale * p.throughput[i], scale * p.nominal[cell] * gray(p.throughput[i]),
                  link.albedo});
}

ParticleTransfer::ParticleTransfer(const Particles& p, const hierarchy::Elements& elements, const Scene& scene)
    : lights_(scene.lights.size()),
      senderOf_(p.paths(), kNone),
      elementOf_(p.impactSlots(), kNone),
      places_(placesOf(elements)) {
  resizeWithRoom(entries_, elements.size()), resizeWithRoom(sums_, elements.size());
  const hierarchy::SideLocator locator(elements, scene);
  parallelFor(p.paths(), kBlock, [&](std::size_t path) { locate(p, path, locator, scene); });

  // By element; each sums its own in the order of the particles.
  std::vector<std::uint32_t> first(elements.size() + 1, 0);
  for (std::size_t path = 0; path < p.paths(); ++path)
    visit(p, path, senderOf_[path], p.sender[path], p.range[path], [&](const Deposit& l) {
      if (l.element == kNone)
        lost_ += l.weight;
      else
        ++first[l.element + 1];
    });
  for (std::size_t e = 0; e < elements.size(); ++e) first[e + 1] += first[e];
  LargeArray<Deposit> deposits(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t path = 0; path < p.paths(); ++path)
    visit(p, path, senderOf_[path], p.sender[path], p.range[path], [&](const Deposit& l) {
      if (l.element != kNone) deposits[next[l.element]++] = l;
    });
  parallelFor(elements.size(), 64, [&](std::size_t e) {
    const auto begin = deposits.begin() + first[e], end = deposits.begin() + first[e + 1];
    std::stable_sort(begin, end, [](const Deposit& a, const Deposit& b) { return a.sender < b.sender; });
    std::for_each(begin, end, [&](const Deposit& l) { add(l); });
  });
  levels_.choose(surfacesOf(elements), elements, sums_);
  for (std::size_t e = 0; e < entries_.size(); ++e)
    if (!entries_[e].empty()) surfaces_.push_back(hierarchy::surfaceOf(elements, hierarchy::ElementId(e)));
  sortUnique(surfaces_);
}

/// Paths with ends that are no places any more, or may have become some; other than those that were retraced.
std::vector<RetracedPath> ParticleTransfer::misplaced(const Particles& p, const ParticleUpdate& update) const {
  std::vector<std::vector<RetracedPath>> found((p.paths() + kBlock - 1) / kBlock);
  parallelBlocks(p.paths(), kBlock, [&](std::size_t begin, std::size_t end) {
    const auto first = static_cast<std::uint32_t>(lights_);
    for (std::size_t path = begin; path < end; ++path) {
      const PathRange range = p.range[path];
      if (range.impacts == 0) continue;
      const std::uint32_t sender = senderOf_[path];
      bool all = sender < first || (sender != kNone && places_[sender - first]);
      for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i)
        all = all && elementOf_[i] != kNone && places_[elementOf_[i]];
      if (!all)
        found[begin / kBlock].push_back(
            {static_cast<std::uint32_t>(path), p.sender[path], p.originTriangle[path], range});
    }
  });
  std::vector<RetracedPath> all, paths;
  for (const auto& block : found) all.insert(all.end(), block.begin(), block.end());
  std::set_difference(all.begin(), all.end(), update.paths.begin(), update.paths.end(), std::back_inserter(paths),
                      earlier);
  return paths;
}

void ParticleTransfer::follow(const Particles& p, const ParticleUpdate& update, const hierarchy::Elements& elements,
                              const Scene& scene) {
  DELTALUX_CHECK(!update.all && senderOf_.size() == p.paths() && elementOf_.size() <= p.impactSlots(),
                 "the particles of before");
  resizeWithRoom(entries_, elements.size()), resizeWithRoom(sums_, elements.size());
  if (p.paths() == 0) {
    places_.resize(elements.size(), 0);
    return;
  }
  std::vector<char> before = placesOf(elements);
  before.swap(places_);
  elementOf_.resize(p.impactSlots(), kNone);
  std::vector<RetracedPath> paths = update.paths;
  if (places_ != before) {
    const std::vector<RetracedPath> others = misplaced(p, update);
    paths.insert(paths.end(), others.begin(), others.end());
    std::inplace_merge(paths.begin(), paths.end() - static_cast<std::ptrdiff_t>(others.size()), paths.end(), earlier);
  }

  std::vector<char> touched(elements.size(), 0);
  for (const RetracedPath& r : paths)
    visit(p, r.path, senderOf_[r.path], r.sender, r.range, [&](const Deposit& l) {
      if (l.element == kNone)
        lost_ -= l.weight;
      else
        remove(l), touched[l.element] = 1;
    });
  const hierarchy::SideLocator locator(elements, scene);
  parallelFor(paths.size(), 64, [&](std::size_t i) { locate(p, paths[i].path, locator, scene); });
  for (const RetracedPath& r : paths)
    visit(p, r.path, senderOf_[r.path], p.sender[r.path], p.range[r.path], [&](const Deposit& l) {
      if (l.element == kNone)
        lost_ += l.weight;
      else
        add(l), touched[l.element] = 1;
    });

  std::vector<hierarchy::ElementId> changed;  // in particles, or in patches
  for (std::size_t i = 0; i < touched.size(); ++i) {
    const bool other = places_[i] != (i < before.size() ? before[i] : 0);
    if ((touched[i] || other) && elements.receives(hierarchy::ElementId(i)))
      changed.push_back(hierarchy::surfaceOf(elements, hierarchy::ElementId(i)));
    if (touched[i]) surfaces_.push_back(hierarchy::surfaceOf(elements, hierarchy::ElementId(i)));
  }
  sortUnique(changed), sortUnique(surfaces_);
  levels_.choose(changed, elements, sums_);
}

void ParticleTransfer::followAllPatches(const hierarchy::Elements& elements) {
  std::vector<hierarchy::ElementId> under;
  for (const hierarchy::ElementId e : surfaces_)
    if (elements.receives(e)) under.push_back(e);
  levels_.choose(under, elements, sums_);
}

void ParticleTransfer::followPatches(const hierarchy::Elements& elements,
                                     std::span<const hierarchy::ElementId> patches) {
  std::vector<hierarchy::ElementId> under;
  for (const hierarchy::ElementId e : patches) under.push_back(hierarchy::surfaceOf(elements, e));
  sortUnique(under);
  std::erase_if(under, [&](hierarchy::ElementId e) {
    return !elements.receives(e) || !std::binary_search(surfaces_.begin(), surfaces_.end(), e);
  });
  levels_.choose(under, elements, sums_);
}

void ParticleTransfer::add(const Deposit& l) {
  if (l.sender == kNone) return;
  DepositSums& s = sums_[l.element];
  s.weight += l.weight, s.squares += double(l.weight) * l.weight, ++s.count;
  if (l.sender >= lights_) s.feedback += feedbackOf(maxChannel(l.flux), l.albedo);
  std::vector<Entry>& all = entries_[l.element];
  auto at = std::lower_bound(all.begin(), all.end(), l.sender,
                             [](const Entry& e, std::uint32_t sender) { return e.sender < sender; });
  if (at == all.end() || at->sender != l.sender) at = all.insert(at, Entry{l.sender, 0, RgbSum(0.0)});
  ++at->count, at->flux += RgbSum(l.flux);
}

void ParticleTransfer::remove(const Deposit& l) {
  if (l.sender == kNone) return;
  DepositSums& s = sums_[l.element];
  s.weight -= l.weight, s.squares -= double(l.weight) * l.weight, --s.count;
  if (l.sender >= lights_) s.feedback -= feedbackOf(maxChannel(l.flux), l.albedo);
  std::vector<Entry>& all = entries_[l.element];
  const auto at = std::lower_bound(all.begin(), all.end(), l.sender,
                                   [](const Entry& e, std::uint32_t sender) { return e.sender < sender; });
  DELTALUX_CHECK(at != all.end() && at->sender == l.sender, "what is taken back is there");
  at->flux = glm::max(at->flux - RgbSum(l.flux), RgbSum(0.0));
  if (--at->count == 0) all.erase(at);
  if (all.empty()) s = {};
}

Rgb ParticleTransfer::power(std::size_t path, const hierarchy::Elements& elements, const Scene& scene) const {
  const std::uint32_t sender = senderOf_[path];
  if (sender == kNone) return Rgb(0.0f);
  return sender < lights_ ? scene.lights[sender].scale : elements.radiometry[sender - lights_].B;
}

void ParticleTransfer::apply(hierarchy::Elements& elements, std::span<const Rgb> scales) const {
  DELTALUX_CHECK(places_.size() == elements.size(), "the mesh that particles were placed on");
  std::vector<Rgb> B(elements.size());
  for (std::size_t i = 0; i < B.size(); ++i) {
    B[i] = elements.radiometry[i].B;
    if (places_[i]) elements.radiometry[i].particle = Rgb(0.0f);
  }
  parallelBlocks(surfaces_.size(), 16, [&](std::size_t begin, std::size_t end) {
    PatchTree tree;
    for (std::size_t i = begin; i < end; ++i) {
      if (!elements.receives(surfaces_[i])) continue;
      tree.list(elements, surfaces_[i]);
      apply(tree, B, elements, scales);
    }
  });
}

void ParticleTransfer::apply(const PatchTree& tree, const std::vector<Rgb>& B, hierarchy::Elements& elements,
                             std::span<const Rgb> scales) const {
  for (std::size_t begin = 0, end = 0; begin < tree.places.size(); begin = end) {
    const std::uint32_t level = levels_.of(tree.places[begin].element);
    end = begin + 1;
    if (level == kNone) continue;
    while (end < tree.places.size() && levels_.of(tree.places[end].element) == level) ++end;
    const double damping = levels_.damping(level);
    RgbSum flux(0.0);
    for (std::size_t i = begin; i < end; ++i)
      for (const Entry& entry : entries_[tree.places[i].element.index()])
        flux += entry.sender < lights_ ? entry.flux * RgbSum(scales[entry.sender])
                                       : damping * entry.flux * RgbSum(B[entry.sender - lights_]);
    const Rgb E(flux / std::max<double>(elements.shape(hierarchy::ElementId(level)).litArea(), 1e-30));
    for (std::size_t i = begin; i < end; ++i)
      if (const hierarchy::ElementId e = tree.places[i].element; elements.isLeaf(e))
        elements.radiometry[e.index()].particle = E;
  }
}

std::size_t ParticleTransfer::pairs() const {
  std::size_t count = 0;
  for (const auto& e : entries_) count += e.size();
  return count;
}

std::size_t ParticleTransfer::memoryBytes() const {
  return (senderOf_.capacity() + elementOf_.capacity() + surfaces_.capacity()) * 4 + places_.capacity() +
         levels_.memoryBytes() + sums_.capacity() * sizeof(DepositSums) + entries_.capacity() * sizeof(entries_[0]) +
         pairs() * sizeof(Entry);
}

}  // namespace deltalux::particles
