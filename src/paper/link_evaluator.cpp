#include "paper/link_evaluator.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "base/sky_side.hpp"
#include "base/tuning.hpp"
#include "paper/kernel.hpp"

namespace deltalux::paper {

namespace {

bool open(const hierarchy::Link& l) {
  return l.visibility == hierarchy::Visibility::Unknown || l.visibility == hierarchy::Visibility::Sampled;
}
bool allPass(const hierarchy::Link& l) { return l.V == Rgb(1.0f); }

/// What is proven takes no samples.
void prove(hierarchy::Link& link, hierarchy::Visibility v) {
  link.visibility = v;
  link.V = Rgb(v == hierarchy::Visibility::Clear ? 1.0f : 0.0f);
  link.visibilitySpread = 0, link.samples = 0, link.sampleMask = 0;
}

hierarchy::Link forgotten(hierarchy::Link link) {
  link.state = hierarchy::LinkState::Active, link.visibility = hierarchy::Visibility::Unknown, link.samples = 0;
  return link;
}

}  // namespace

/// The link's own blockers, drawn up when they are first asked for.
class LinkEvaluator::OwnBlockers {
 public:
  OwnBlockers(const LinkEvaluator& evaluator, const hierarchy::Link& link, const Candidates& candidates, Evaluation& v)
      : evaluator_(evaluator),
        receiver_(link.receiver),
        sender_(link.sender),
        candidates_(candidates),
        range_(v.blockers) {}

  std::span<const hierarchy::ElementId> list() {
    if (!std::exchange(drawnUp_, true)) {
      Blockers& own = candidates_.own;
      range_.begin = static_cast<std::uint32_t>(own.size());
      shrinkBlockers(evaluator_.elements_, evaluator_.scene_, receiver_, sender_, candidates_.parents,
                     candidates_.count, own);
      range_.count = static_cast<std::uint32_t>(own.size()) - range_.begin;
    }
    return {candidates_.own.data() + range_.begin, range_.count};
  }

 private:
  const LinkEvaluator& evaluator_;
  hierarchy::ElementId receiver_, sender_;
  const Candidates& candidates_;
  BlockerRange& range_;
  bool drawnUp_ = false;
};

bool LinkEvaluator::couple(hierarchy::Link& link, const Candidates& candidates, Evaluation& v) const {
  const Kernel k = kernel(elements_, scene_, link.receiver, link.sender);
  if (k.averted || elements_.at(link.receiver).blocker || !sends(link.sender)) {
    link.state = hierarchy::LinkState::Averted, link.K = 0;
    return false;
  }
  link.K = k.K, link.receiverSpread = k.receiverSpread, link.senderSpread = k.senderSpread;
  if (!k.overlapping) return true;
  OwnBlockers(*this, link, candidates, v).list();
  v.split = link.receiver == link.sender ? Split::Both : splitOverlapping(link);
  return false;
}

void LinkEvaluator::see(hierarchy::Link& link, int least, bool saw, const Candidates& candidates, Evaluation& v) const {
  OwnBlockers blockers(*this, link, candidates, v);
  const bool solid = solidEnds(link), unknown = link.visibility == hierarchy::Visibility::Unknown;
  if (unknown && !(saw && (candidates.count > deltalux::tuning::kFewRays || !solid))) {
    if (blockers.list().empty() && solid)
      prove(link, hierarchy::Visibility::Clear);
    else if (!saw)
      proveBlocked(link, blockers);
  }
  if (open(link)) {
    VisibilitySamples samples(elements_, scene_, tracer_, link.receiver, link.sender);
    look(link, least, samples);
    v.rays = static_cast<std::uint16_t>(samples.traced());
  }
  if (unknown && saw && link.visibility == hierarchy::Visibility::Sampled) {
    if (isBlack(link.V))
      proveBlocked(link, blockers);
    else if (solid && allPass(link) && blockers.list().empty())
      prove(link, hierarchy::Visibility::Clear);
  }
  v.split = choose(link);
  if (v.split != Split::None || link.childCount > 0) blockers.list();
}

Evaluation LinkEvaluator::evaluate(const hierarchy::Link& before, bool parentSaw, const Candidates& candidates) const {
  Evaluation v;
  v.link = before;
  if (couple(v.link, candidates, v)) see(v.link, 0, parentSaw, candidates, v);
  return v;
}

Evaluation LinkEvaluator::evaluateMoved(const hierarchy::Link& before, const Candidates& candidates) const {
  Evaluation v;
  v.link = forgotten(before);
  if (!couple(v.link, candidates, v)) return v;
  const bool saw = before.visibility == hierarchy::Visibility::Sampled && !isBlack(before.V);
  see(v.link, before.samples, saw, candidates, v);
  return v;
}

Evaluation LinkEvaluator::evaluateBetween(const hierarchy::Link& before, std::uint32_t rays,
                                          const Candidates& candidates) const {
  if (before.visibility != hierarchy::Visibility::Sampled) return evaluate(forgotten(before), false, candidates);
  VisibilitySamples samples(elements_, scene_, tracer_, before.receiver, before.sender);
  const VisibilityEstimate e = samples.renewed(before, rays);
  Evaluation v;
  v.link = before;
  hierarchy::Link& link = v.link;
  link.V = e.V, link.sampleMask = e.mask, link.visibilitySpread = e.spread;
  if (e.V == before.V && e.mask == before.sampleMask) {
    v = passUnseen(link, candidates);
  } else {
    OwnBlockers blockers(*this, link, candidates, v);
    if (isBlack(e.V)) proveBlocked(link, blockers);
    if (solidEnds(link) && allPass(link) && blockers.list().empty()) prove(link, hierarchy::Visibility::Clear);
    if (link.visibility == hierarchy::Visibility::Sampled) look(link, link.samples, samples);
    link.state = hierarchy::LinkState::Active;
    v.split = choose(link);
    if (v.split != Split::None || link.childCount > 0) blockers.list();
  }
  v.rays = static_cast<std::uint16_t>(samples.traced());
  return v;
}

Evaluation LinkEvaluator::pass(const hierarchy::Link& link, const Candidates& candidates) const {
  if (candidates.count <= deltalux::tuning::kPilots) return passUnseen(link, candidates);
  Evaluation v;
  v.link = link;
  OwnBlockers(*this, link, candidates, v).list();
  return v;
}

Evaluation LinkEvaluator::passUnseen(const hierarchy::Link& link, const Candidates& candidates) const {
  Evaluation v;
  v.link = link;
  v.blockers = {static_cast<std::uint32_t>(candidates.own.size()), static_cast<std::uint32_t>(candidates.count)};
  candidates.own.insert(candidates.own.end(), candidates.parents, candidates.parents + candidates.count);
  return v;
}

bool LinkEvaluator::splits(hierarchy::Link link) const {
  link.state = hierarchy::LinkState::Active;
  return link.receiver == link.sender || choose(link) != Split::None;
}

bool LinkEvaluator::unrefined(const hierarchy::Link& link) const {
  if (link.state != hierarchy::LinkState::Active || link.visibility == hierarchy::Visibility::Blocked) return false;
  const LinkError e = oracle_.evaluate(link);
  return e.total() > e.budget || wantedSamples(link, e) > link.samples;
}

bool LinkEvaluator::solidEnds(const hierarchy::Link& link) const {
  return !elements_.isCluster(link.receiver) && !elements_.isCluster(link.sender);
}

void LinkEvaluator::proveBlocked(hierarchy::Link& link, OwnBlockers& blockers) const {
  const std::span<const hierarchy::ElementId> own = blockers.list();
  if (provablyBlocked(elements_, scene_, link.receiver, link.sender, own.data(), own.size()))
    prove(link, hierarchy::Visibility::Blocked);
}

bool LinkEvaluator::sends(hierarchy::ElementId sender) const {
  const hierarchy::ElementTopology& s = elements_.at(sender);
  if (s.kind != hierarchy::ElementKind::Patch) return true;
  if (!(elements_.shape(sender).area > 0)) return false;  // removed
  if (s.emitter) return true;
  const hierarchy::ElementLight& l = elements_.radiometry[sender.index()];
  return !isBlack(l.rho) || !isBlack(l.tau);
}

int LinkEvaluator::wantedSamples(const hierarchy::Link& link, const LinkError& e) const {
  if (!open(link)) return 0;
  const double weight = e.power / std::max(e.budget, 1e-30);
  return deltalux::tuning::kFewRays << (weight < 0.5 ? 0 : weight < 2 ? 1 : 2);
}

/// Few rays, and more when the kernel alone does not already demand a split.
void LinkEvaluator::look(hierarchy::Link& link, int least, VisibilitySamples& samples) const {
  const auto take = [&](int count) {
    if (count <= link.samples) return;
    const VisibilityEstimate e = samples.estimate(static_cast<std::size_t>(count));
    link.V = e.V, link.sampleMask = e.mask, link.visibilitySpread = e.spread, link.samples = e.samples;
    link.visibility = hierarchy::Visibility::Sampled;
  };
  const int wanted = std::max(least, wantedSamples(link, oracle_.evaluate(link)));
  take(std::min(wanted, deltalux::tuning::kFewRays));
  const LinkError e = oracle_.evaluate(link);
  if (wanted > deltalux::tuning::kFewRays && !(e.receiver + e.sender > e.budget)) take(wanted);
}

Split LinkEvaluator::splitOverlapping(const hierarchy::Link& link) const {
  const bool clusterReceiver = elements_.isCluster(link.receiver), clusterSender = elements_.isCluster(link.sender);
  if (clusterReceiver && clusterSender)
    return elements_.shape(link.receiver).radius >= elements_.shape(link.sender).radius ? Split::Receiver
                                                                                        : Split::Sender;
  return clusterReceiver ? Split::Receiver : Split::Sender;
}

/// The end to split, or none; an end that is too small to matter leaves the other one.
Split LinkEvaluator::choose(const hierarchy::Link& link) const {
  const Split split = prefer(link);
  if (split == Split::None) return split;
  const bool receiver = oracle_.divisible(link.receiver), sender = senderDivisible(link.sender);
  if (split == Split::Both) return receiver ? split : Split::None;
  if (split == Split::Receiver) return receiver ? split : worthSplitting(link, sender) ? Split::Sender : Split::None;
  return sender ? split : receiver ? Split::Receiver : Split::None;
}

bool LinkEvaluator::senderDivisible(hierarchy::ElementId sender) const {
  if (elements_.isDistant(sender)) return !isSun(sender) && elements_.at(sender).depth < kSkyHalvings / 2;
  return oracle_.divisible(sender);
}

/// When the receiver is as small as it gets, splitting the sender helps only where the sender's own error counts.
bool LinkEvaluator::worthSplitting(const hierarchy::Link& link, bool divisible) const {
  const LinkError e = oracle_.evaluate(link);
  return divisible && e.sender + e.visibility > e.budget;
}

Split LinkEvaluator::prefer(const hierarchy::Link& link) const {
  if (link.visibility == hierarchy::Visibility::Blocked) return Split::None;
  LinkError e = oracle_.evaluate(link);
  const hierarchy::ElementGeometry &r = elements_.shape(link.receiver), &s = elements_.shape(link.sender);
  const bool clusterReceiver = elements_.isCluster(link.receiver), clusterSender = elements_.isCluster(link.sender);
  if (link.visibility == hierarchy::Visibility::Sampled && isBlack(link.V)) {
    // What rays may have missed between them matters where either is larger than A_0.
    if (std::max(r.area, s.area) < oracle_.referenceArea(link.receiver)) e.visibility = 0;
  }
  if (!(e.total() > e.budget)) return Split::None;
  if (link.receiver == link.sender) return Split::Both;
  if (elements_.isDistant(link.sender)) {
    if (senderDivisible(link.sender)) return Split::Sender;
    return Split::Receiver;
  }
  if (elements_.isPoint(link.sender)) return Split::Receiver;
  if (clusterReceiver != clusterSender) {
    if (clusterSender)
      return e.receiver > e.sender + e.visibility && r.radius > s.radius ? Split::Receiver : Split::Sender;
    return e.sender > e.receiver + e.visibility && s.radius > r.radius ? Split::Sender : Split::Receiver;
  }
  if (clusterReceiver) return r.radius >= s.radius ? Split::Receiver : Split::Sender;
  // Partial visibility is told apart best by the end that is larger.
  (r.area >= s.area ? e.receiver : e.sender) += e.visibility;
  return e.receiver >= e.sender ? Split::Receiver : Split::Sender;
}

bool LinkEvaluator::isSun(hierarchy::ElementId e) const {
  return std::holds_alternative<SunLight>(scene_[elements_.light[e.index()]].emitter);
}

}  // namespace deltalux::paper
