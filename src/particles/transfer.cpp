#include "particles/transfer.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "hierarchy/side_locator.hpp"

namespace deltalux {

namespace {

constexpr std::uint32_t kNone = RadixNode::kNone;
constexpr double kMostGain = 1;  // E of a patch if all surfaces had B = 1: no more is possible, but for noise
constexpr std::size_t kBlock = 1024;

}  // namespace

std::uint32_t ParticleTransfer::locateSender(const Particles& p, std::size_t path, const SideLocator& locator) const {
  const SenderCell& cell = p.senderCells[p.sender[path]];
  if (cell.kind != SenderKind::Side) return cell.light.value;
  const ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
  if (!side.valid()) return kNone;
  return static_cast<std::uint32_t>(lights_) + locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.value;
}

void ParticleTransfer::locate(const Particles& p, std::size_t path, const SideLocator& locator) {
  if (p.range[path].impacts == 0) return;
  senderOf_[path] = locateSender(p, path, locator);
  for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
    const ElementId side = locator.side(p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0);
    elementOf_[i] = side.valid() ? locator.leafAt(side, Vec2(p.uv[i])).value : kNone;
  }
}

template <class Visit>
void ParticleTransfer::visit(const Particles& p, std::size_t path, std::uint32_t sender, std::uint32_t cell,
                             const PathRange& range, const Visit& visit) const {
  const float scale = p.links[p.link[path]].scale;
  for (std::uint32_t i = range.impact; i < range.impact + range.impacts; ++i)
    visit(Landing{elementOf_[i], sender, scale * p.throughput[i], scale * p.nominal[cell] * gray(p.throughput[i])});
}

ParticleTransfer::ParticleTransfer(const Particles& p, const Elements& elements, const Scene& scene)
    : lights_(scene.lights.size()), senderOf_(p.paths(), kNone), elementOf_(p.impactSlots(), kNone) {
  entries_.resize(elements.size());
  sums_.resize(elements.size());
  const SideLocator locator(elements, scene);
  parallelFor(p.paths(), kBlock, [&](std::size_t path) { locate(p, path, locator); });

  // By element; each sums its own in the order of the particles.
  std::vector<std::uint32_t> first(elements.size() + 1, 0);
  for (std::size_t path = 0; path < p.paths(); ++path)
    visit(p, path, senderOf_[path], p.sender[path], p.range[path], [&](const Landing& l) {
      if (l.element == kNone)
        lost_ += l.weight;
      else
        ++first[l.element + 1];
    });
  for (std::size_t e = 0; e < elements.size(); ++e) first[e + 1] += first[e];
  std::vector<Landing> landings(first.back());
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::size_t path = 0; path < p.paths(); ++path)
    visit(p, path, senderOf_[path], p.sender[path], p.range[path], [&](const Landing& l) {
      if (l.element != kNone) landings[next[l.element]++] = l;
    });
  parallelFor(elements.size(), 64, [&](std::size_t e) {
    const auto begin = landings.begin() + first[e], end = landings.begin() + first[e + 1];
    std::stable_sort(begin, end, [](const Landing& a, const Landing& b) { return a.sender < b.sender; });
    std::for_each(begin, end, [&](const Landing& l) { add(l); });
  });
  chooseLevels(elements);
}

void ParticleTransfer::follow(const Particles& p, const ParticleUpdate& update, const Elements& elements,
                              const Scene& scene) {
  if (update.all) {
    *this = ParticleTransfer(p, elements, scene);
    return;
  }
  DELTALUX_CHECK(senderOf_.size() == p.paths() && elementOf_.size() <= p.impactSlots(), "the particles of before");
  for (const RetracedPath& r : update.paths)
    visit(p, r.path, senderOf_[r.path], r.sender, r.range, [&](const Landing& l) {
      if (l.element == kNone)
        lost_ -= l.weight;
      else
        remove(l);
    });
  entries_.resize(elements.size());
  sums_.resize(elements.size());
  elementOf_.resize(p.impactSlots(), kNone);
  const SideLocator locator(elements, scene);
  parallelFor(update.paths.size(), 64, [&](std::size_t i) { locate(p, update.paths[i].path, locator); });
  for (const RetracedPath& r : update.paths)
    visit(p, r.path, senderOf_[r.path], p.sender[r.path], p.range[r.path], [&](const Landing& l) {
      if (l.element == kNone)
        lost_ += l.weight;
      else
        add(l);
    });
  chooseLevels(elements);
}

void ParticleTransfer::add(const Landing& l) {
  Sums& s = sums_[l.element];
  s.weight += l.weight, s.squares += double(l.weight) * l.weight;
  if (l.sender == kNone) return;
  if (l.sender >= lights_) s.gain += maxChannel(l.flux);
  std::vector<Entry>& all = entries_[l.element];
  auto at = std::lower_bound(all.begin(), all.end(), l.sender,
                             [](const Entry& e, std::uint32_t sender) { return e.sender < sender; });
  if (at == all.end() || at->sender != l.sender) at = all.insert(at, Entry{l.sender, 0, RgbSum(0.0)});
  ++at->count, at->flux += RgbSum(l.flux);
}

void ParticleTransfer::remove(const Landing& l) {
  Sums& s = sums_[l.element];
  s.weight -= l.weight, s.squares -= double(l.weight) * l.weight;
  if (l.sender == kNone) return;
  if (l.sender >= lights_) s.gain -= maxChannel(l.flux);
  std::vector<Entry>& all = entries_[l.element];
  const auto at = std::lower_bound(all.begin(), all.end(), l.sender,
                                   [](const Entry& e, std::uint32_t sender) { return e.sender < sender; });
  DELTALUX_CHECK(at != all.end() && at->sender == l.sender, "what is taken back is there");
  at->flux = glm::max(at->flux - RgbSum(l.flux), RgbSum(0.0));
  if (--at->count == 0) all.erase(at);
  if (all.empty()) s = {};
}

void ParticleTransfer::chooseLevels(const Elements& elements) {
  std::vector<Sums> sums = sums_;
  std::vector<double> least(elements.size(), 0.0);
  std::vector<char> whole(elements.size(), 1);    // its particles are spread over all of it
  std::vector<char> tooMuch(elements.size(), 0);  // for so small a patch
  damping_.assign(elements.size(), 1.0f);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const ElementTopology& t = elements.topology[i];
    if (!elements.receives(ElementId(i))) continue;
    double parts = 0;
    bool split = t.childCount > 0 && entries_[i].empty();
    for (std::size_t c = 0; c < t.childCount; ++c) {
      const std::size_t child = t.firstChild.index() + c;
      const Sums& s = sums[child];
      sums[i].weight += s.weight, sums[i].squares += s.squares, sums[i].gain += s.gain, parts += least[child];
      tooMuch[i] |= tooMuch[child];
    }
    const double A = std::max<double>(elements.geometry[i].area, 1e-30);
    const double J = (2 * sums[i].squares - sums[i].weight * sums[i].weight) / A;  // [Rudemo82 (2.8)]
    whole[i] = !split || tooMuch[i] || J <= parts;
    least[i] = whole[i] ? J : parts;
    tooMuch[i] = sums[i].gain > kMostGain * A;
    // Counts where not even the whole surface is enough to spread it on.
    if (tooMuch[i]) damping_[i] = static_cast<float>(kMostGain * A / sums[i].gain);
  }
  // From above: once a patch is whole, so is everything in it.
  level_.assign(elements.size(), kNone);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementTopology& t = elements.topology[i];
    if (!elements.receives(ElementId(i))) continue;
    const bool covered = t.depth > 0 && level_[t.parent.index()] != kNone;
    if (covered)
      level_[i] = level_[t.parent.index()];
    else if (whole[i])
      level_[i] = static_cast<std::uint32_t>(i);
  }
}

Rgb ParticleTransfer::power(std::size_t path, const Elements& elements, const Scene& scene) const {
  const std::uint32_t sender = senderOf_[path];
  if (sender == kNone) return Rgb(0.0f);
  return sender < lights_ ? scene.lights[sender].scale : elements.radiometry[sender - lights_].B;
}

void ParticleTransfer::apply(Elements& elements, const Scene& scene) const {
  const auto power = [&](std::uint32_t sender) {
    return RgbSum(sender < lights_ ? scene.lights[sender].scale : elements.radiometry[sender - lights_].B);
  };
  // Flux by element, then by level.
  std::vector<RgbSum> flux(entries_.size(), RgbSum(0.0));
  parallelFor(entries_.size(), 256, [&](std::size_t e) {
    if (entries_[e].empty()) return;
    const double damping = damping_[level_[e]];
    for (const Entry& entry : entries_[e])
      flux[e] += (entry.sender < lights_ ? 1.0 : damping) * entry.flux * power(entry.sender);
  });
  for (std::size_t e = 0; e < entries_.size(); ++e)
    if (!entries_[e].empty() && level_[e] != e) flux[level_[e]] += flux[e];
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (!elements.isReceivingLeaf(ElementId(e))) continue;
    const std::uint32_t level = level_[e];
    elements.radiometry[e].particle = Rgb(flux[level] / std::max<double>(elements.geometry[level].litArea(), 1e-30));
  }
}

std::size_t ParticleTransfer::pairs() const {
  std::size_t count = 0;
  for (const auto& e : entries_) count += e.size();
  return count;
}

std::size_t ParticleTransfer::memoryBytes() const {
  return (senderOf_.capacity() + elementOf_.capacity() + level_.capacity() + damping_.capacity()) * 4 +
         sums_.capacity() * sizeof(Sums) + entries_.capacity() * sizeof(entries_[0]) + pairs() * sizeof(Entry);
}

}  // namespace deltalux
