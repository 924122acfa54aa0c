#include "particles/transfer.hpp"

#include <algorithm>

#include "base/parallel.hpp"

namespace deltalux {

namespace {

constexpr std::uint32_t kNone = RadixNode::kNone;
constexpr double kMostGain = 1;  // E of a patch if all surfaces had B = 1: no more is possible, but for noise

bool receives(const ElementTopology& t) { return t.kind == ElementKind::Patch && !t.emitter && !t.blocker; }

}  // namespace

ParticleTransfer::ParticleTransfer(const Particles& p, const Elements& elements, const Scene& scene)
    : lights_(scene.lights.size()) {
  rowOf_.assign(elements.size(), kNone);
  begin_.push_back(0);
  if (p.impactSlots() == 0) return;
  const SideLocator locator(elements, scene);
  std::vector<Landing> landings(p.impactSlots());
  std::vector<float> weights(p.impactSlots(), 0.0f);
  constexpr std::size_t kBlock = 1024;
  std::vector<double> lost((p.paths() + kBlock - 1) / kBlock, 0.0);
  parallelFor(p.paths(), kBlock, [&](std::size_t path) {
    if (p.range[path].impacts == 0) return;
    const SenderCell& cell = p.senderCells[p.sender[path]];
    const float scale = p.links[p.link[path]].scale;
    std::uint32_t sender = kNone;
    if (cell.kind == SenderKind::Side) {
      const ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
      if (side.valid())
        sender = static_cast<std::uint32_t>(lights_) + locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.value;
    } else {
      sender = cell.light.value;
    }
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
      const ElementId side = locator.side(p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0);
      const float weight = scale * p.nominal[p.sender[path]] * gray(p.throughput[i]);
      if (!side.valid()) {
        lost[path / kBlock] += weight;
        continue;
      }
      landings[i] = {locator.leafAt(side, Vec2(p.uv[i])).value, sender, scale * p.throughput[i]};
      weights[i] = weight;
    }
  });
  for (const double l : lost) lost_ += l;

  const std::vector<ElementId> level = chooseLevels(elements, landings, weights);
  for (Landing& l : landings)
    if (l.row != kNone) l.row = level[l.row].value;
  build(elements, landings);
  for (std::size_t i = elements.size(); i-- > 0;) {
    if (!receives(elements.topology[i]) || elements.topology[i].childCount > 0) rowOf_[i] = kNone;
  }
}

std::vector<ElementId> ParticleTransfer::chooseLevels(const Elements& elements, const std::vector<Landing>& landings,
                                                      const std::vector<float>& weights) const {
  std::vector<double> sum(elements.size(), 0.0), squares(elements.size(), 0.0), least(elements.size(), 0.0);
  for (std::size_t i = 0; i < landings.size(); ++i) {
    if (landings[i].row == kNone) continue;
    sum[landings[i].row] += weights[i];
    squares[landings[i].row] += double(weights[i]) * weights[i];
  }
  std::vector<double> gain(elements.size(), 0.0);
  for (const Landing& l : landings)
    if (l.row != kNone && l.sender != kNone && l.sender >= lights_) gain[l.row] += maxChannel(l.flux);
  std::vector<char> whole(elements.size(), 1);  // its particles are spread over all of it
  std::vector<char> tooMuch(elements.size(), 0);
  for (std::size_t i = elements.size(); i-- > 0;) {
    const ElementTopology& t = elements.topology[i];
    if (!receives(t)) continue;
    double parts = 0;
    for (std::size_t c = 0; c < t.childCount; ++c) {
      const std::size_t child = t.firstChild.index() + c;
      sum[i] += sum[child], squares[i] += squares[child], gain[i] += gain[child], parts += least[child];
      tooMuch[i] |= tooMuch[child];
    }
    const double A = std::max<double>(elements.geometry[i].area, 1e-30);
    const double J = (2 * squares[i] - sum[i] * sum[i]) / A;  // [Rudemo82 (2.8)]
    whole[i] = t.childCount == 0 || tooMuch[i] || J <= parts;
    least[i] = whole[i] ? J : parts;
    tooMuch[i] = gain[i] > kMostGain * A;
  }
  // From above: once a patch is whole, so is everything in it.
  std::vector<ElementId> level(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementTopology& t = elements.topology[i];
    if (!receives(t)) continue;
    const bool covered = t.depth > 0 && level[t.parent.index()].valid();
    if (covered)
      level[i] = level[t.parent.index()];
    else if (whole[i])
      level[i] = ElementId(i);
  }
  return level;
}

void ParticleTransfer::build(const Elements& elements, std::vector<Landing>& landings) {
  std::vector<std::uint32_t> count(elements.size(), 0);
  for (const Landing& l : landings)
    if (l.row != kNone) ++count[l.row];
  std::vector<std::uint32_t> rowElement, first;
  std::vector<std::uint32_t> row(elements.size(), kNone);
  std::uint32_t total = 0;
  for (std::size_t e = 0; e < elements.size(); ++e) {
    if (count[e] == 0) continue;
    row[e] = static_cast<std::uint32_t>(rowElement.size());
    rowElement.push_back(static_cast<std::uint32_t>(e));
    first.push_back(total);
    total += count[e];
    count[e] = first.back();
  }
  first.push_back(total);
  std::vector<std::uint32_t> order(total);
  for (std::size_t i = 0; i < landings.size(); ++i)
    if (landings[i].row != kNone) order[count[landings[i].row]++] = static_cast<std::uint32_t>(i);

  // Per row: one entry a sender, senders ascending, summed in the order of the particles.
  std::vector<std::vector<Entry>> rows(rowElement.size());
  parallelFor(rowElement.size(), 16, [&](std::size_t r) {
    const auto begin = order.begin() + first[r], end = order.begin() + first[r + 1];
    std::stable_sort(begin, end,
                     [&](std::uint32_t a, std::uint32_t b) { return landings[a].sender < landings[b].sender; });
    const double A = elements.geometry[rowElement[r]].area;
    for (auto i = begin; i != end;) {
      const std::uint32_t sender = landings[*i].sender;
      RgbSum flux(0.0);
      for (; i != end && landings[*i].sender == sender; ++i) flux += RgbSum(landings[*i].flux);
      if (sender != kNone) rows[r].push_back({sender, Rgb(flux / A)});
    }
    // Not even the whole surface was enough to spread it on.
    double all = 0;
    for (const Entry& e : rows[r])
      if (e.sender >= lights_) all += maxChannel(e.T);
    if (all > kMostGain)
      for (Entry& e : rows[r])
        if (e.sender >= lights_) e.T *= static_cast<float>(kMostGain / all);
  });
  std::size_t size = 0;
  for (const auto& r : rows) begin_.push_back(static_cast<std::uint32_t>(size += r.size()));
  entries_.reserve(size);
  for (const auto& r : rows) entries_.insert(entries_.end(), r.begin(), r.end());

  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ElementTopology& t = elements.topology[e];
    if (!receives(t)) continue;
    rowOf_[e] = row[e] != kNone || t.depth == 0 ? row[e] : rowOf_[t.parent.index()];
  }
}

void ParticleTransfer::apply(Elements& elements, const Scene& scene) const {
  std::vector<Rgb> power(lights_ + elements.size(), Rgb(0.0f));
  for (std::size_t l = 0; l < lights_; ++l) power[l] = scene.lights[l].scale;
  for (std::size_t e = 0; e < elements.size(); ++e) power[lights_ + e] = elements.radiometry[e].B;
  std::vector<Rgb> E(begin_.size() - 1);
  parallelFor(E.size(), 64, [&](std::size_t r) {
    RgbSum sum(0.0);
    for (std::uint32_t k = begin_[r]; k < begin_[r + 1]; ++k) sum += RgbSum(entries_[k].T * power[entries_[k].sender]);
    E[r] = Rgb(sum);
  });
  for (std::size_t e = 0; e < elements.size(); ++e) {
    const ElementTopology& t = elements.topology[e];
    if (receives(t) && t.childCount == 0)
      elements.radiometry[e].particle = rowOf_[e] == kNone ? Rgb(0.0f) : E[rowOf_[e]];
  }
}

std::size_t ParticleTransfer::memoryBytes() const {
  return rowOf_.capacity() * 4 + begin_.capacity() * 4 + entries_.capacity() * sizeof(Entry);
}

std::vector<Impact> impacts(const Particles& p, const Elements& elements, const Scene& scene) {
  const SideLocator locator(elements, scene);
  std::vector<std::uint32_t> first(p.paths() + 1, 0);
  for (std::size_t path = 0; path < p.paths(); ++path) first[path + 1] = first[path] + p.range[path].impacts;
  std::vector<Impact> result(first.back());
  parallelFor(p.paths(), 1024, [&](std::size_t path) {
    if (p.range[path].impacts == 0) return;
    const SenderCell& cell = p.senderCells[p.sender[path]];
    Rgb power(0.0f);
    if (cell.kind == SenderKind::Side) {
      const ElementId side = locator.side(cell.primitive, p.originTriangle[path], cell.front);
      if (side.valid()) power = elements.radiometry[locator.locate(side, Vec3(p.verticesOf(path)[0])).leaf.index()].B;
    } else {
      power = scene[cell.light].scale;
    }
    power *= p.links[p.link[path]].scale;
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
      result[first[path] + i - p.firstImpact(path)] = {
          p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0, p.uv[i], power * p.throughput[i]};
  });
  return result;
}

}  // namespace deltalux
