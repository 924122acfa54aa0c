// Rays of rows: between which points of leaf and sender each passes, what it brings, and what a row remembers of it.
#include <algorithm>
#include <array>
#include <cmath>

#include "base/random.hpp"
#include "paper/visibility.hpp"
#include "radiosity/indirect_sampler.hpp"

namespace deltalux::radiosity {

namespace {

constexpr int kFacingTries = 16;            // more points of a flat sender when some face away
constexpr int kTries = 2;                   // pairs of points with a curved one, of which one is picked
constexpr float kBlocked = 0x1.fffffep-1f;  // of a ray: furthest place of what blocks it

}  // namespace

/// Where rays of a leaf start: at a point that is given, or anywhere on it.
struct IndirectSampler::Place {
  const IndirectSampler& sampler;
  hierarchy::ElementId leaf;
  const hierarchy::PatchPoint* given;

  hierarchy::PatchPoint operator()(double a, double b) const {
    return given ? *given : hierarchy::samplePatch(sampler.elements_, sampler.scene_, leaf, a, b);
  }
};

/// All rays between the two draw by it.
paper::SampleKey IndirectSampler::rayKey(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
  const LeafGroup group = groupOf(elements_, leaf);
  return {combineKeys(group.key, elements_.key[sender.index()]), group.place};
}

bool IndirectSampler::isClosePatch(hierarchy::ElementId leaf, hierarchy::ElementId sender) const {
  return elements_.isPatch(sender) && areClose(elements_, leaf, sender);  // also when it has been split since
}

paper::SenderSample IndirectSampler::along(const ClosePair& pair, hierarchy::ElementId sender) const {
  paper::SenderSample s;
  s.leaf = sender, s.weight = pair.weight / elements_.shape(sender).area;
  s.ray = tracing::segment(pair.from.position, pair.from.normal, pair.to.position, pair.to.normal);
  return s;
}

/// To a flat sender where the kernel between the whole leaf and the whole sender does not tell that of the parts that
/// see each other: from a curved leaf, or where one of the two is covered in part, since what is not covered is closer
/// to what it sees than the whole is.
paper::SenderSample IndirectSampler::shootMeasuring(hierarchy::ElementId leaf, hierarchy::ElementId sender,
                                                    int index) const {
  const Place place{*this, leaf, nullptr};
  const paper::SampleKey key = rayKey(leaf, sender);
  paper::SenderSample s;
  if (isClosePatch(leaf, sender)) {
    if (const auto pair = sampleClosePair(elements_, scene_, place, sender, key, index)) s = along(*pair, sender);
  } else {
    s = shootMeasured(sender, key, index, place);
  }
  s.measures = true;
  return s;
}

/// From a sender close by to the leaf: where the sender is curved, or the smaller of the two, so that few points of the
/// leaf see much of it. Each candidate has a point of the sender of its own: parts of it may lie behind the leaf.
paper::SenderSample IndirectSampler::shootBack(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index,
                                               bool measures) const {
  const auto from = [&](double a, double b) { return hierarchy::samplePatch(elements_, scene_, sender, a, b); };
  const auto pair = sampleClosePair(elements_, scene_, from, leaf, rayKey(leaf, sender), index);
  if (!pair) return {};
  paper::SenderSample s;
  s.leaf = sender, s.weight = pair->weight / elements_.shape(leaf).area;
  s.ray = tracing::segment(pair->to.position, pair->to.normal, pair->from.position, pair->from.normal);
  s.measures = measures;
  return s;
}

paper::SenderSample IndirectSampler::shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index,
                                           bool measures) const {
  if (!(elements_.shape(sender).area > 0)) return {};  // removed
  const bool curved = !exact(sender);
  const bool back = (curved && elements_.at(leaf).flat) || elements_.shape(sender).area < elements_.shape(leaf).area;
  if (back && isClosePatch(leaf, sender)) return shootBack(leaf, sender, index, measures);
  if (!curved && measures) return shootMeasuring(leaf, sender, index);
  return shoot(leaf, sender, index, nullptr);
}

paper::SenderSample IndirectSampler::shoot(hierarchy::ElementId leaf, hierarchy::ElementId sender, int index,
                                           const hierarchy::PatchPoint* at) const {
  const paper::SampleKey key = rayKey(leaf, sender);
  const Place place{*this, leaf, at};
  if (isClosePatch(leaf, sender)) {
    if (const auto pair = sampleClosePair(elements_, scene_, place, sender, key, index)) return along(*pair, sender);
    if (!exact(sender)) return {};
  }
  if (!exact(sender)) return shootMeasured(sender, key, index, place);
  for (int tries = 0; tries < kFacingTries; ++tries) {
    const auto u = paper::stratified4(key.with(tries), index);
    const paper::SenderSample s = paper::sampleLeafOf(elements_, scene_, place(u[2], u[3]), sender, u[0], u[1]);
    if (s.weight > 0) return s;
  }
  return {};
}

/// Of a few pairs of points one in proportion to its kernel; their mean is its weight [TCE05].
paper::SenderSample IndirectSampler::shootMeasured(hierarchy::ElementId sender, paper::SampleKey key, int index,
                                                   const Place& place) const {
  std::array<paper::SenderSample, kTries> samples;
  double total = 0;
  for (int i = 0; i < kTries; ++i) {
    const auto u = paper::stratified4(key.with(static_cast<std::uint64_t>(i)), index);
    paper::SenderSample& s = samples[static_cast<std::size_t>(i)];
    s = paper::sampleLeafOf(elements_, scene_, place(u[2], u[3]), sender, u[0], u[1]);
    total += s.weight;
  }
  const double u = paper::stratified4(key.with(kTries), index)[0];
  paper::SenderSample* picked = paper::pickByWeight(std::span<paper::SenderSample>(samples), total, u);
  if (!picked) return {};
  picked->weight = total / kTries;
  return *picked;
}

IndirectSampler::Found IndirectSampler::find(const Dealt& d, const paper::SenderSample& s,
                                             std::uint64_t& traced) const {
  if (known(d.term)) return {Rgb(d.term.K)};
  if (!s.leaf.valid()) return {Rgb(0.0f)};
  const bool isKnown = exact(d.term.sender) && !s.measures;
  const float K = isKnown ? d.term.K : elements_.shape(d.term.sender).area * static_cast<float>(s.weight);
  if (d.term.open >= 1.0f) return {Rgb(d.gain * K), &s.ray};
  ++traced;
  const tracing::Passing p = tracer_.passing(s.ray);
  if (!tracing::endsAtOne(scene_, p)) return {d.gain * K * p.share, &s.ray};
  return {Rgb(0.0f), &s.ray, std::min(p.t / s.ray.tFar, kBlocked), p.blocker};
}

void IndirectSampler::remember(hierarchy::ElementId leaf, std::size_t term, const Found& f, TransferRow& row) const {
  const hierarchy::ElementGeometry& g = elements_.shape(leaf);
  const Vec3f from = 0.5f * (g.lower + g.upper);
  row.rays.resize(row.terms.size());
  const Vec3f d = f.ray ? f.seen * (tracing::at(*f.ray, f.ray->tFar) - from) : Vec3f(0.0f);
  row.rays[term] = f.ray ? rayCode(d, f.seen < 1) : rayCode({}, 0, true);
  if (f.ray && !f.blocker.valid()) return row.reach.add(g, from + d);
  row.reach.objects.add(scene_, elements_.domain[row.terms[term].sender.index()].primitive);
  if (f.blocker.valid()) row.reach.objects.add(scene_, f.blocker);
}

void IndirectSampler::append(hierarchy::ElementId leaf, const Dealt& d, TransferRow& row, std::uint64_t& traced) const {
  const bool measured = measures(leaf, d.term.sender);
  const paper::SenderSample s = known(d.term) ? paper::SenderSample{} : shoot(leaf, d.term.sender, d.index, measured);
  const Found found = find(d, s, traced);
  const bool some = !isBlack(found.T);
  row.terms.push_back(
      {d.term.link, d.term.sender, d.gain, static_cast<std::uint16_t>(d.index), some, d.term.open >= 1.0f, measured});
  remember(leaf, row.terms.size() - 1, found, row);
  if (some) row.transfers.push_back({d.term.sender, found.T});
}

}  // namespace deltalux::radiosity
