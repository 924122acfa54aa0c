#include "radiosity/refine.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/blockers.hpp"
#include "radiosity/kernel.hpp"
#include "radiosity/visibility.hpp"

namespace deltalux {

namespace {

constexpr int kSomeSamples = 8, kManySamples = 16;
constexpr std::size_t kShortList = 8;  // of blockers: sooner looked through than rays are traced
constexpr float kFineCell = 0.2f;      // radians: sky cells larger than this are split before the surface they light
constexpr float kFinestCell = 0.06f;   // radians: smaller ones are not split

enum class Mark : char {
  None,
  Way,      // to links between whose ends something has changed, which rarely ask for blockers
  Path,     // on the way to others
  Between,  // what lies between its ends has changed
  Ends,     // so has an end
};

using Marks = PagedArray<Mark>;  // by link

enum class Split : std::uint8_t { None, Receiver, Sender, Both };

/// A range of blocker candidates in the arena of a level.
struct ListRef {
  std::uint32_t begin = 0, count = 0;
};

struct Task {
  LinkId link;
  ListRef candidates;  // in the arena of the parent level
  Mark mark = Mark::Path;
};

struct Verdict {
  Link link;  // as judged
  Split split = Split::None;
  ListRef blockers;      // in the arena of the block, then of the level
  bool refined = false;  // as the link was before, it would be refined today
  bool news = false;     // rows that sample it as it was have to be dealt anew
  std::uint16_t rays = 0;
};

class Judge {
 public:
  Judge(const Elements& elements, const Scene& scene, const RayTracer& tracer, const OracleSettings& settings)
      : elements_(elements), scene_(scene), tracer_(tracer), oracle_(elements, settings) {}

  /// `candidates` are the parent's blockers; the link's own are appended to `arena`, when something is to be below it
  /// or they may prove something. Visibility is sampled by `least` rays at least, when it is. `seen`: the ends saw each
  /// other before, or those of the parent do; then rays come first, and proof when none or all pass. `few`: the link
  /// before its ends moved, when few rays sampled it; what they told does where as little comes over it as then.
  Verdict judge(Link link, int least, const ElementId* candidates, std::size_t count, Blockers& arena,
                bool seen = false, const Link* few = nullptr) const {
    Verdict v;
    const Kernel k = kernel(elements_, scene_, link.receiver, link.sender);
    const ElementTopology& r = elements_.at(link.receiver);
    if (k.averted || r.blocker || !sends(link.sender)) {
      link.state = LinkState::Averted;
      link.K = 0;
      v.link = link;
      return v;
    }
    link.K = k.K, link.receiverSpread = k.receiverSpread, link.senderSpread = k.senderSpread;
    if (k.overlapping) {
      shrink(link, candidates, count, v, arena);
      v.split = link.receiver == link.sender ? Split::Both : splitOverlapping(link);
      v.link = link;
      return v;
    }
    if (few) {
      Link same = link;
      same.visibility = few->visibility, same.samples = few->samples, same.sampleMask = few->sampleMask;
      same.V = few->V, same.visibilitySpread = few->visibilitySpread;
      if (wantedSamples(same, oracle_.judge(same)) <= kFewSamples && choose(same) == Split::None) {
        v.link = same;
        return v;
      }
    }
    bool shrunk = false;
    const auto ownBlockers = [&] {
      if (!std::exchange(shrunk, true)) shrink(link, candidates, count, v, arena);
      return v.blockers.count;
    };
    const bool solid = solidEnds(link), unknown = link.visibility == Visibility::Unknown;
    if (unknown && !(seen && (count > kShortList || !solid))) {
      if (ownBlockers() == 0 && solid)
        seeClear(link);
      else if (!seen)
        proveBlocked(link, v, arena);
    }
    if (link.visibility == Visibility::Unknown || link.visibility == Visibility::Sampled) {
      VisibilitySamples samples(elements_, scene_, tracer_, link.receiver, link.sender);
      look(link, least, samples);
      v.rays = static_cast<std::uint16_t>(samples.traced());
    }
    if (unknown && seen && link.visibility == Visibility::Sampled) {
      if (isBlack(link.V))
        ownBlockers(), proveBlocked(link, v, arena);
      else if (solid && allPass(link) && ownBlockers() == 0)
        seeClear(link);
    }
    v.split = choose(link);
    if (v.split != Split::None || link.childCount > 0) ownBlockers();
    v.link = link;
    return v;
  }

  /// A link of which an end has moved, or holds what has.
  Verdict judgeMoved(const Link& before, const ElementId* candidates, std::size_t count, Blockers& arena) const {
    Link link = before;
    link.state = LinkState::Active, link.visibility = Visibility::Unknown, link.samples = 0;
    const bool sampled = before.visibility == Visibility::Sampled;
    const bool few = sampled && before.samples <= kFewSamples && before.childCount == 0;
    return judge(link, before.samples, candidates, count, arena, sampled && !isBlack(before.V),
                 few ? &before : nullptr);
  }

  /// A link on the way to others.
  Verdict pass(const Link& link, const ElementId* candidates, std::size_t count, Blockers& arena) const {
    Verdict v;
    shrink(link, candidates, count, v, arena);
    v.link = link;
    return v;
  }

  /// One whose blockers are the parent's for now.
  Verdict passUnseen(const Link& link, const ElementId* candidates, std::size_t count, Blockers& arena) const {
    Verdict v;
    keep(candidates, count, v, arena);
    v.link = link;
    return v;
  }

  /// A link between whose ends something has moved. Its kernel stands, and so do the samples but for `rays`, by bits.
  Verdict judgeBetween(Link link, std::uint32_t rays, const ElementId* candidates, std::size_t count,
                       Blockers& arena) const {
    if (link.visibility != Visibility::Sampled) {
      link.state = LinkState::Active, link.visibility = Visibility::Unknown, link.samples = 0;
      return judge(link, 0, candidates, count, arena);
    }
    Verdict v;
    VisibilitySamples samples(elements_, scene_, tracer_, link.receiver, link.sender);
    const VisibilityEstimate e = samples.renewed(link, rays);
    const bool same = e.V == link.V && e.mask == link.sampleMask;
    link.V = e.V, link.sampleMask = e.mask, link.visibilitySpread = e.spread;
    if (same) {
      keep(candidates, count, v, arena);
    } else {
      bool shrunk = false;
      const auto ownBlockers = [&] {
        if (!std::exchange(shrunk, true)) shrink(link, candidates, count, v, arena);
        return v.blockers.count;
      };
      if (isBlack(e.V)) ownBlockers(), proveBlocked(link, v, arena);
      if (solidEnds(link) && allPass(link) && ownBlockers() == 0) seeClear(link);
      if (link.visibility == Visibility::Sampled) look(link, link.samples, samples);
      link.state = LinkState::Active;
      v.split = choose(link);
      if (v.split != Split::None || link.childCount > 0) ownBlockers();
    }
    v.rays = static_cast<std::uint16_t>(samples.traced());
    v.link = link;
    return v;
  }

  /// Whether the link, as it stands, would be split.
  bool splits(Link link) const {
    link.state = LinkState::Active;
    return link.receiver == link.sender || choose(link) != Split::None;
  }

  /// Whether more may come over a link, as far as it is open, than `least` times what it may err by.
  bool brings(const Link& link, double least) const {
    return link.carries() && oracle_.most(link) * std::sqrt(openness(link)) > least * oracle_.budget(link.receiver);
  }

  /// Whether an active link, as it stands, would be worth another look.
  bool unsettled(const Link& link) const {
    if (link.state != LinkState::Active || link.visibility == Visibility::Blocked) return false;
    const LinkError e = oracle_.judge(link);
    return e.total() > e.budget || wantedSamples(link, e) > link.samples;
  }

 private:
  void shrink(const Link& link, const ElementId* candidates, std::size_t count, Verdict& v, Blockers& arena) const {
    v.blockers.begin = static_cast<std::uint32_t>(arena.size());
    shrinkBlockers(elements_, scene_, link.receiver, link.sender, candidates, count, arena);
    v.blockers.count = static_cast<std::uint32_t>(arena.size()) - v.blockers.begin;
  }

  static void keep(const ElementId* candidates, std::size_t count, Verdict& v, Blockers& arena) {
    v.blockers = {static_cast<std::uint32_t>(arena.size()), static_cast<std::uint32_t>(count)};
    arena.insert(arena.end(), candidates, candidates + count);
  }

  bool solidEnds(const Link& link) const {
    return !elements_.isCluster(link.receiver) && !elements_.isCluster(link.sender);
  }

  void proveBlocked(Link& link, const Verdict& v, const Blockers& arena) const {
    const ElementId* own = arena.data() + v.blockers.begin;
    if (!provablyBlocked(elements_, scene_, link.receiver, link.sender, own, v.blockers.count)) return;
    link.visibility = Visibility::Blocked;
    link.V = Rgb(0.0f);
    link.visibilitySpread = 0;
    link.samples = 0, link.sampleMask = 0;
  }

  static void seeClear(Link& link) {
    link.visibility = Visibility::Clear;
    link.V = Rgb(1.0f);
    link.visibilitySpread = 0;
    link.samples = 0, link.sampleMask = 0;
  }

  static bool allPass(const Link& link) { return link.V == Rgb(1.0f); }

  bool sends(ElementId sender) const {
    const ElementTopology& s = elements_.at(sender);
    if (s.kind != ElementKind::Patch) return true;
    if (!(elements_.shape(sender).area > 0)) return false;  // removed
    if (s.emitter) return true;
    const ElementLight& l = elements_.radiometry[sender.index()];
    return !isBlack(l.rho) || !isBlack(l.tau);
  }

  int wantedSamples(const Link& link, const LinkError& e) const {
    if (link.visibility != Visibility::Unknown && link.visibility != Visibility::Sampled) return 0;
    const double weight = e.power / std::max(e.budget, 1e-30);
    return weight < 0.5 ? kFewSamples : weight < 2 ? kSomeSamples : kManySamples;
  }

  /// Few rays, and more when the kernel alone does not already demand a split.
  void look(Link& link, int least, VisibilitySamples& samples) const {
    const auto take = [&](int count) {
      if (count <= link.samples) return;
      const VisibilityEstimate e = samples.estimate(static_cast<std::size_t>(count));
      link.V = e.V, link.sampleMask = e.mask, link.visibilitySpread = e.spread, link.samples = e.samples;
      link.visibility = Visibility::Sampled;
    };
    const int wanted = std::max(least, wantedSamples(link, oracle_.judge(link)));
    take(std::min(wanted, kFewSamples));
    const LinkError e = oracle_.judge(link);
    if (wanted > kFewSamples && !(e.receiver + e.sender > e.budget)) take(wanted);
  }

  Split splitOverlapping(const Link& link) const {
    const bool clusterReceiver = elements_.isCluster(link.receiver), clusterSender = elements_.isCluster(link.sender);
    if (clusterReceiver && clusterSender)
      return elements_.shape(link.receiver).radius >= elements_.shape(link.sender).radius ? Split::Receiver
                                                                                          : Split::Sender;
    return clusterReceiver ? Split::Receiver : Split::Sender;
  }

  /// The end to split, or none; an end that is too small to matter leaves the other one.
  Split choose(const Link& link) const {
    const Split split = prefer(link);
    if (split == Split::None) return split;
    const bool receiver = oracle_.divisible(link.receiver), sender = senderDivisible(link.sender);
    if (split == Split::Both) return receiver ? split : Split::None;
    if (split == Split::Receiver) return receiver ? split : worthSplitting(link, sender) ? Split::Sender : Split::None;
    return sender ? split : receiver ? Split::Receiver : Split::None;
  }

  bool senderDivisible(ElementId sender) const {
    if (elements_.isDistant(sender)) return !isSun(sender) && elements_.shape(sender).radius > kFinestCell;
    return oracle_.divisible(sender);
  }

  /// When the receiver is as small as it gets, splitting the sender helps only where the sender's own error counts.
  bool worthSplitting(const Link& link, bool divisible) const {
    const LinkError e = oracle_.judge(link);
    return divisible && e.sender + e.visibility > e.budget;
  }

  Split prefer(const Link& link) const {
    if (link.visibility == Visibility::Blocked) return Split::None;
    LinkError e = oracle_.judge(link);
    const ElementGeometry &r = elements_.shape(link.receiver), &s = elements_.shape(link.sender);
    const bool clusterReceiver = elements_.isCluster(link.receiver), clusterSender = elements_.isCluster(link.sender);
    if (link.visibility == Visibility::Sampled && isBlack(link.V)) {
      // What rays may have missed between them matters on surfaces larger than A_0.
      if (r.area < oracle_.referenceArea(link.receiver)) e.visibility = 0;
    }
    if (!(e.total() > e.budget)) return Split::None;
    if (link.receiver == link.sender) return Split::Both;
    if (elements_.isDistant(link.sender)) {
      if (!isSun(link.sender) && s.radius > kFineCell) return Split::Sender;
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

  bool isSun(ElementId e) const { return std::holds_alternative<SunLight>(scene_[elements_.light[e.index()]].emitter); }

  const Elements& elements_;
  const Scene& scene_;
  const RayTracer& tracer_;
  Oracle oracle_;
};

/// Children of `link` after splitting its end(s), appended contiguously. False when the end cannot be split.
bool splitLink(Links& links, Elements& elements, const Scene& scene, LinkId id, Split split) {
  const ElementId receiver = links[id].receiver, sender = links[id].sender;
  const bool splitReceiver = split != Split::Sender, splitSender = split != Split::Receiver;
  if (splitReceiver && !elements.isCluster(receiver) && !subdivide(elements, scene, receiver)) return false;
  if (splitSender && !elements.isCluster(sender) && !subdivide(elements, scene, sender)) return false;
  const std::size_t rCount = splitReceiver ? elements.at(receiver).childCount : 1;
  const std::size_t sCount = splitSender ? elements.at(sender).childCount : 1;
  if (rCount * sCount == 0 || rCount * sCount > 65535) return false;
  const LinkId first = links.addChildren(id, rCount * sCount);
  for (std::size_t i = 0; i < rCount; ++i)
    for (std::size_t j = 0; j < sCount; ++j)
      links.setEnds(LinkId(first.index() + i * sCount + j), splitReceiver ? elements.child(receiver, i) : receiver,
                    splitSender ? elements.child(sender, j) : sender);
  return true;
}

}  // namespace

void makeRootLinks(Links& links, const Elements& elements) {
  if (!links.roots.empty() || !elements.sceneRoot.valid()) return;
  const auto add = [&](ElementId sender) { links.addRoot(elements.sceneRoot, sender, elements.at(sender).emitter); };
  add(elements.sceneRoot);
  if (elements.lightRoot.valid()) add(elements.lightRoot);
  for (const ElementId e : elements.distant) add(e);
}

void addRootLinks(Links& links, const Elements& elements, ElementId grown) {
  if (links.roots.empty()) return makeRootLinks(links, elements);
  for (const ElementId root : elements.sceneRoots()) {
    links.addRoot(grown, root, false);
    if (root != grown) links.addRoot(root, grown, false);
  }
  if (elements.lightRoot.valid()) links.addRoot(grown, elements.lightRoot, true);
  for (const ElementId e : elements.distant) links.addRoot(grown, e, true);
}

namespace {

/// The links below `id` that carry light.
template <class Visit>
void forEachCarrying(const Links& links, LinkId id, const Visit& visit) {
  if (links[id].carries()) visit(id);
  for (std::size_t c = 0; c < links[id].childCount; ++c) forEachCarrying(links, links.child(id, c), visit);
}

/// Marks the links above a marked one: they are on its path, or on its way.
void markAbove(const Links& links, Marks& marks, LinkId id, Mark as) {
  for (LinkId up = links[id].parent; up.valid(); up = links[up].parent) {
    Mark& mark = marks.at(up.index());
    if (mark >= as && mark != Mark::Between) return;  // so is all above it
    mark = std::max(mark, as);
  }
}

constexpr float kSameTransfer = 0.05f;  // relative difference of kernels that is no news: rows know their own
constexpr float kSameKernel = 2.0f;     // factors within which rays are still well shared out
constexpr float kSameOpenness = 6.0f;
constexpr double kNews = 0.1;  // budgets: what a link may bring for which rows that sample it too little are dealt anew
constexpr double kNewsToRows = 2e-4;  // the same where rows do not sample it at all

/// Whether a second look has found what the first did. Light changes all the while; a move is no reason to refine for
/// it.
bool sameTransfer(const Link& before, const Link& after) {
  return std::abs(before.K - after.K) <= kSameTransfer * before.K && before.V == after.V &&
         before.visibility == after.visibility &&
         (before.state == LinkState::Averted) == (after.state == LinkState::Averted);
}

/// Whether rows that sample `before` may stand, but for terms that meet what moved or lead to it: those are taken anew
/// one by one, and what now is less or more likely to be seen than their number says costs noise only, next to none
/// where the link brings little (kNews).
bool samePlan(const Link& before, const Link& after) {
  // What was proven clear was sampled by no ray, what was proven blocked or averted not at all.
  if (before.visibility == Visibility::Clear && after.visibility != Visibility::Clear) return false;
  if (!after.carries()) return true;
  if (!before.carries() || before.visibility != after.visibility) return false;
  const auto alike = [](float a, float b, float factor) { return a <= factor * b && b <= factor * a; };
  if (!alike(before.K, after.K, kSameKernel)) return false;
  if (before.fromLight) return true;  // every light in sight gets rays
  return alike(openness(before), openness(after), kSameOpenness);
}

/// One descent over marked links, level by level.
class Descent {
 public:
  Descent(Links& links, Elements& elements, const Scene& scene, const RayTracer& tracer, const OracleSettings& settings,
          Marks marks, std::span<const DisturbedLink> disturbed = {})
      : links_(links),
        elements_(elements),
        scene_(scene),
        tracer_(tracer),
        settings_(settings),
        marks_(std::move(marks)),
        disturbed_(disturbed) {}

  /// Told of every link that is freed or made, and of every one over which rows have to be dealt anew.
  std::function<void(LinkId)> renewed = [](LinkId) {}, changed = [](LinkId) {};
  std::function<bool()> stop;

  RefineReport run() {
    Blockers arena = elements_.sceneRoots();
    const ListRef everything{0, static_cast<std::uint32_t>(arena.size())};
    std::vector<Task> tasks;
    for (const LinkId root : links_.roots)
      if (marks_[root.index()] != Mark::None) tasks.push_back({root, everything, marks_[root.index()]});
    while (!tasks.empty()) {
      std::vector<Verdict> verdicts(tasks.size());
      std::vector<Blockers> blocks((tasks.size() + kBlock - 1) / kBlock);
      const Judge judge(elements_, scene_, tracer_, settings_);
      parallelBlocks(tasks.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Task& t = tasks[i];
          verdicts[i] = verdictOf(judge, t, arena.data() + t.candidates.begin, blocks[begin / kBlock]);
        }
      });
      report_.judged += tasks.size();
      Blockers nextArena;
      std::vector<Task> next;
      const bool stopping = stop && stop();
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        const auto base = static_cast<std::uint32_t>(nextArena.size());
        nextArena.insert(nextArena.end(), blocks[b].begin(), blocks[b].end());
        for (std::size_t i = b * kBlock; i < std::min(tasks.size(), (b + 1) * kBlock); ++i) {
          verdicts[i].blockers.begin += base;
          commit(tasks[i], verdicts[i], stopping, next);
        }
      }
      arena = std::move(nextArena);
      tasks = std::move(next);
    }
    return report_;
  }

 private:
  static constexpr std::size_t kBlock = 256;

  Verdict verdictOf(const Judge& judge, const Task& t, const ElementId* candidates, Blockers& arena) const {
    const Link& link = links_[t.link];
    Verdict v = judged(judge, link, t, candidates, arena);
    v.refined =
        t.mark > Mark::Path && link.state == LinkState::Interior && v.split == Split::None && judge.splits(link);
    v.news = !samePlan(link, v.link) && isNews(judge, link, v.link);
    return v;
  }

  Verdict judged(const Judge& judge, const Link& link, const Task& t, const ElementId* candidates,
                 Blockers& arena) const {
    if (t.mark == Mark::Way && link.state == LinkState::Interior)
      return judge.passUnseen(link, candidates, t.candidates.count, arena);
    if (t.mark == Mark::Path && link.state == LinkState::Interior)
      return judge.pass(link, candidates, t.candidates.count, arena);
    if (t.mark == Mark::Between) return judge.judgeBetween(link, raysOf(t.link), candidates, t.candidates.count, arena);
    if (t.mark == Mark::Ends) return judge.judgeMoved(link, candidates, t.candidates.count, arena);
    const Link& above = link.parent.valid() ? links_[link.parent] : link;
    const bool seen = above.visibility == Visibility::Sampled && !isBlack(above.V);
    return judge.judge(link, 0, candidates, t.candidates.count, arena, seen);
  }

  static bool isNews(const Judge& judge, const Link& before, const Link& after) {
    if (!before.carries()) return judge.brings(after, kNewsToRows);
    return before.visibility != after.visibility || judge.brings(before, kNews) || judge.brings(after, kNews);
  }

  std::uint32_t raysOf(LinkId id) const {
    return std::lower_bound(disturbed_.begin(), disturbed_.end(), id,
                            [](const DisturbedLink& d, LinkId link) { return d.link < link; })
        ->rays;
  }

  void commit(const Task& task, Verdict& v, bool stopping, std::vector<Task>& next) {
    const LinkId id = task.link;
    report_.rays += v.rays;
    const bool anew = task.mark > Mark::Path;
    v.link.hidden = links_.hiddenAbove(id);
    if (anew && sameTransfer(links_[id], v.link)) {
      if (links_[id].state == LinkState::Interior) descend(task, v, next, false);
      return;
    }
    // A link collapses for what a move has changed, not for light that has settled since it was refined.
    if (links_[id].state == LinkState::Interior && (!anew || v.split != Split::None || !v.refined)) {
      if (anew) links_.judged(id, v.link);
      descend(task, v, next, false);
      return;
    }
    if (links_[id].state == LinkState::Interior) {
      links_.collapse(id, renewed);
      ++report_.collapsed;
      changed(id);
    } else if (v.news) {
      changed(id);
    }
    links_.judged(id, v.link);
    report_.provenClear += v.link.visibility == Visibility::Clear;
    report_.provenBlocked += v.link.visibility == Visibility::Blocked;
    if (v.split == Split::None) return;
    const bool optional = v.link.receiver != v.link.sender && v.link.K >= 0 && v.link.visibility != Visibility::Unknown;
    if (stopping && optional) {
      report_.stopped = true;
      return;
    }
    // Rows go on to sample over the link: it covers all that they did, and they find their way to leaves themselves.
    if (!splitLink(links_, elements_, scene_, id, v.split)) return;
    ++report_.split;
    report_.created += links_[id].childCount;
    descend(task, v, next, true);
  }

  void descend(const Task& task, const Verdict& v, std::vector<Task>& next, bool fresh) {
    for (std::size_t c = 0; c < links_[task.link].childCount; ++c) {
      const LinkId child = links_.child(task.link, c);
      if (fresh) renewed(child);
      const Mark mark = fresh ? Mark::Path : marks_[child.index()];
      if (mark != Mark::None) next.push_back({child, v.blockers, mark});
    }
  }

  Links& links_;
  Elements& elements_;
  const Scene& scene_;
  const RayTracer& tracer_;
  const OracleSettings& settings_;
  Marks marks_;
  std::span<const DisturbedLink> disturbed_;  // those marked Between, by their ids
  RefineReport report_;
};

}  // namespace

RefineReport refine(Links& links, Elements& elements, const Scene& scene, const RayTracer& tracer,
                    const OracleSettings& settings, const std::function<bool()>& stop) {
  makeRootLinks(links, elements);
  std::vector<char> unsettled(links.size(), 0);
  const Judge judge(elements, scene, tracer, settings);
  parallelFor(links.size(), 4096, [&](std::size_t i) { unsettled[i] = judge.unsettled(links.all[i]); });
  Marks marks(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!unsettled[i]) continue;
    marks.at(i) = Mark::Path;
    markAbove(links, marks, LinkId(i), Mark::Path);
  }
  Descent descent(links, elements, scene, tracer, settings, std::move(marks));
  descent.stop = stop;
  return descent.run();
}

RefineReport rejudge(Links& links, Elements& elements, const Scene& scene, const RayTracer& tracer,
                     const OracleSettings& settings, LinkMarks& marked, std::vector<LinkId>& changed) {
  std::sort(marked.anew.begin(), marked.anew.end(),
            [](const DisturbedLink& a, const DisturbedLink& b) { return a.link < b.link; });
  Marks marks(links.size());
  for (const DisturbedLink& d : marked.anew) marks.at(d.link.index()) = Mark::Between;
  for (const LinkId id : marked.moved) marks.at(id.index()) = Mark::Ends;
  for (const LinkId id : marked.moved) markAbove(links, marks, id, Mark::Path);
  for (const DisturbedLink& d : marked.anew)
    markAbove(links, marks, d.link, links[d.link].visibility == Visibility::Sampled ? Mark::Way : Mark::Path);
  const std::size_t known = marked.changes.size();
  for (const LinkId root : links.roots)
    if (root.index() >= known) marks.at(root.index()) = Mark::Path;
  Descent descent(links, elements, scene, tracer, settings, std::move(marks), marked.anew);
  descent.renewed = [&](LinkId id) {
    if (id.index() < known) marked.changes.at(id.index()) = LinkChange::Changed;
  };
  descent.changed = [&](LinkId id) {
    if (id.index() >= known || marked.changes[id.index()] == LinkChange::Changed) return;
    marked.changes.at(id.index()) = LinkChange::Changed;
    changed.push_back(id);
  };
  const RefineReport report = descent.run();
  for (const LinkId id : marked.lit)
    if (links[id].state == LinkState::Active) descent.changed(id);
  // What has grown is new to all that was there and may see it; its own elements are new themselves.
  const Judge judge(elements, scene, tracer, settings);
  for (const LinkId root : links.roots)
    if (root.index() >= known && links[root].sender == elements.grown.back() &&
        links[root].receiver != links[root].sender)
      forEachCarrying(links, root, [&](LinkId id) {
        if (judge.brings(links[id], kNewsToRows)) changed.push_back(id);
      });
  return report;
}

}  // namespace deltalux
