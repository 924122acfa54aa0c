#include "radiosity/refine.hpp"

#include <algorithm>
#include <span>
#include <utility>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"
#include "radiosity/link_judge.hpp"
#include "radiosity/link_news.hpp"
#include "radiosity/links_below.hpp"

namespace deltalux {

namespace {

enum class Mark : char {
  None,
  Way,      // to links between whose ends something has changed, which rarely ask for blockers
  Path,     // on the way to others
  Between,  // what lies between its ends has changed
  Ends,     // so has an end
};

using Marks = PagedArray<Mark>;  // by link

struct Task {
  LinkId link;
  BlockerRange candidates;  // in the arena of the parent level
  Mark mark = Mark::Path;
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
  /// What has grown since the marks were made, if anything: all below the receivers of its links are told of it.
  ElementId grown;

  RefineReport run() {
    Blockers arena = elements_.sceneRoots();
    const BlockerRange everything{0, static_cast<std::uint32_t>(arena.size())};
    std::vector<Task> tasks;
    for (const LinkId root : links_.roots)
      if (marks_[root.index()] != Mark::None) tasks.push_back({root, everything, marks_[root.index()]});
    while (!tasks.empty()) {
      std::vector<Verdict> verdicts(tasks.size());
      std::vector<Blockers> blocks((tasks.size() + kBlock - 1) / kBlock);
      const LinkJudge judge(elements_, scene_, tracer_, settings_);
      parallelBlocks(tasks.size(), kBlock, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
          const Task& t = tasks[i];
          verdicts[i] =
              verdictOf(judge, t, {arena.data() + t.candidates.begin, t.candidates.count, blocks[begin / kBlock]});
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

  Verdict verdictOf(const LinkJudge& judge, const Task& t, const Candidates& candidates) const {
    const Link& link = links_[t.link];
    Verdict v = judged(judge, link, t, candidates);
    if (v.split == Split::None && tooWide(judge, v.link)) {
      const std::uint16_t rays = v.rays;
      v = judge.pass(v.link, candidates);
      v.split = Split::Receiver, v.rays = rays;
    }
    v.refined =
        t.mark > Mark::Path && link.state == LinkState::Interior && v.split == Split::None && judge.splits(link);
    v.news = !samePlan(link, v.link) && isNews(judge, link, v.link);
    return v;
  }

  Verdict judged(const LinkJudge& judge, const Link& link, const Task& t, const Candidates& candidates) const {
    const bool interior = link.state == LinkState::Interior;
    if (t.mark == Mark::Way && interior) return judge.passUnseen(link, candidates);
    if (t.mark == Mark::Path && interior) return judge.pass(link, candidates);
    if (t.mark == Mark::Between) return judge.judgeBetween(link, raysOf(t.link), candidates);
    if (t.mark == Mark::Ends) return judge.judgeMoved(link, candidates);
    const Link& above = link.parent.valid() ? links_[link.parent] : link;
    return judge.judge(link, above.visibility == Visibility::Sampled && !isBlack(above.V), candidates);
  }

  /// Whether a link from what has grown is better taken apart, although light asks for no more: all leaves below its
  /// receiver would look for rays to what has grown, and walls may hide it from most.
  bool tooWide(const LinkJudge& judge, const Link& link) const {
    if (!grown.valid() || !link.carries() || !elements_.isCluster(link.receiver)) return false;
    return holds(elements_, grown, link.sender) && !holds(elements_, grown, link.receiver) &&
           judge.brings(link, kNewsToRows);
  }

  static bool isNews(const LinkJudge& judge, const Link& before, const Link& after) {
    if (!before.carries()) return !hiddenAsBefore(before, after) && judge.brings(after, kNewsToRows);
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
    v.link.hidden = hiddenAsBefore(links_[id], v.link) ? Link::kHidden : links_.hiddenAbove(id);
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
  const LinkJudge judge(elements, scene, tracer, settings);
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
  if (std::any_of(links.roots.begin(), links.roots.end(), [&](LinkId root) { return root.index() >= known; }))
    descent.grown = elements.grown.back();
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
  const LinkJudge judge(elements, scene, tracer, settings);
  for (const LinkId root : links.roots)
    if (root.index() >= known && links[root].sender == elements.grown.back() &&
        links[root].receiver != links[root].sender)
      forEachCarrying(links, root, [&](LinkId id) {
        if (judge.brings(links[id], kNewsToRows)) changed.push_back(id);
      });
  return report;
}

}  // namespace deltalux
