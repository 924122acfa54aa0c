#include "paper/link_descent.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::paper {

namespace {

constexpr std::size_t kLinkBlock = 64;  // [task]

/// Children of `link` after splitting its end(s), appended contiguously. False when the end cannot be split.
bool splitLink(hierarchy::Links& links, hierarchy::Elements& elements, const Scene& scene, hierarchy::LinkId id,
               Split split) {
  const hierarchy::ElementId receiver = links[id].receiver, sender = links[id].sender;
  const bool splitReceiver = split != Split::Sender, splitSender = split != Split::Receiver;
  if (splitReceiver && !elements.isCluster(receiver) && !hierarchy::subdivide(elements, scene, receiver)) return false;
  if (splitSender && !elements.isCluster(sender) && !hierarchy::subdivide(elements, scene, sender)) return false;
  const std::size_t rCount = splitReceiver ? elements.at(receiver).childCount : 1;
  const std::size_t sCount = splitSender ? elements.at(sender).childCount : 1;
  if (rCount * sCount == 0 || rCount * sCount > 65535) return false;
  const hierarchy::LinkId first = links.addChildren(id, rCount * sCount);
  for (std::size_t i = 0; i < rCount; ++i)
    for (std::size_t j = 0; j < sCount; ++j)
      links.setEnds(hierarchy::LinkId(first.index() + i * sCount + j),
                    splitReceiver ? elements.child(receiver, i) : receiver,
                    splitSender ? elements.child(sender, j) : sender);
  return true;
}

/// Whether a second look has found what the first did.
bool sameTransfer(const hierarchy::Link& before, const hierarchy::Link& after) {
  return before.K == after.K && before.V == after.V && before.visibility == after.visibility &&
         (before.state == hierarchy::LinkState::Averted) == (after.state == hierarchy::LinkState::Averted);
}

void add(const RefineReport& more, RefineReport& report) { report.changed += more.changed, report.rays += more.rays; }

}  // namespace

RefineReport LinkDescent::run() {
  above_.assign(1, {});
  above_[0].blockers = elements_.sceneRoots();
  const BlockerRange everything{0, static_cast<std::uint32_t>(above_[0].blockers.size())};
  std::vector<Task> tasks, next;
  for (const hierarchy::LinkId root : links_.roots)
    if (marks_[root.index()] != LinkMark::None) tasks.push_back({root, everything, 0, marks_[root.index()]});
  while (!tasks.empty()) {
    const std::size_t blocks = (tasks.size() + kLinkBlock - 1) / kLinkBlock;
    if (level_.size() < blocks) level_.resize(blocks);
    const LinkEvaluator evaluator(elements_, scene_, tracer_, settings_);
    parallelBlocks(tasks.size(), kLinkBlock, [&](std::size_t begin, std::size_t end) {
      evaluateBlock(evaluator, std::span(tasks).subspan(begin, end - begin),
                    static_cast<std::uint32_t>(begin / kLinkBlock), level_[begin / kLinkBlock]);
    });
    next.clear();
    const bool stopping = stop && stop();
    for (const Block& block : std::span(level_).first(blocks)) {
      add(block.report, report_);
      auto at = block.next.begin();
      for (const Pending& p : block.pending) {
        const auto place = block.next.begin() + static_cast<std::ptrdiff_t>(p.place);
        next.insert(next.end(), at, place);
        at = place;
        commit(p, stopping, next);
      }
      next.insert(next.end(), at, block.next.end());
    }
    std::swap(above_, level_);
    std::swap(tasks, next);
  }
  return report_;
}

void LinkDescent::evaluateBlock(const LinkEvaluator& evaluator, std::span<const Task> tasks, std::uint32_t index,
                                Block& block) {
  block.blockers.clear(), block.next.clear(), block.pending.clear();
  block.report = {};
  for (Task task : tasks) {
    const hierarchy::ElementId* const candidates = above_[task.block].blockers.data() + task.candidates.begin;
    const Evaluation v = evaluationOf(evaluator, task, {candidates, task.candidates.count, block.blockers});
    block.report.rays += v.rays;
    task.block = index;
    if (!finish(task, v, block)) block.pending.push_back({task, v, block.next.size()});
  }
}

Evaluation LinkDescent::evaluationOf(const LinkEvaluator& evaluator, const Task& t,
                                     const Candidates& candidates) const {
  const hierarchy::Link& link = links_[t.link];
  Evaluation v = evaluated(evaluator, link, t, candidates);
  v.refined = t.mark > LinkMark::Path && link.state == hierarchy::LinkState::Interior && v.split == Split::None &&
              evaluator.splits(link);
  return v;
}

Evaluation LinkDescent::evaluated(const LinkEvaluator& evaluator, const hierarchy::Link& link, const Task& t,
                                  const Candidates& candidates) const {
  const bool interior = link.state == hierarchy::LinkState::Interior;
  if (t.mark == LinkMark::Way && interior) return evaluator.passUnseen(link, candidates);
  if (t.mark == LinkMark::Path && interior) return evaluator.pass(link, candidates);
  if (t.mark == LinkMark::Between) return evaluator.evaluateBetween(link, raysOf(t.link), candidates);
  if (t.mark == LinkMark::Ends) return evaluator.evaluateMoved(link, candidates);
  const hierarchy::Link& above = link.parent.valid() ? links_[link.parent] : link;
  return evaluator.evaluate(link, above.visibility == hierarchy::Visibility::Sampled && !isBlack(above.V), candidates);
}

std::uint32_t LinkDescent::raysOf(hierarchy::LinkId id) const {
  return std::lower_bound(disturbed_.begin(), disturbed_.end(), id,
                          [](const DisturbedLink& d, hierarchy::LinkId link) { return d.link < link; })
      ->rays;
}

/// Takes a evaluation that leaves the tree and its lists as they are; false when it does not. Nothing is written that
/// other links of the level read.
bool LinkDescent::finish(const Task& task, const Evaluation& v, Block& block) {
  const hierarchy::Link& link = links_[task.link];
  const bool disturbed = task.mark > LinkMark::Path, interior = link.state == hierarchy::LinkState::Interior;
  const bool same = disturbed && sameTransfer(link, v.link);
  block.report.changed += disturbed && !same;
  // A link collapses for what a move has changed, not for light that has converged since it was refined. One that shows
  // nothing any more stays refined for when what hides it moves on: until then that costs no more than its place.
  if (interior && (!disturbed || same || v.split != Split::None || !v.refined || v.link.unseen())) {
    if (disturbed && !same) links_.evaluated(task.link, v.link);
    descend(task, v, block.next, false);
    return true;
  }
  if (same) return true;
  if (interior || v.split != Split::None) return false;
  links_.evaluated(task.link, v.link);
  return true;
}

void LinkDescent::commit(const Pending& p, bool stopping, std::vector<Task>& next) {
  const hierarchy::LinkId id = p.task.link;
  const Evaluation& v = p.evaluation;
  if (links_[id].state == hierarchy::LinkState::Interior) {
    if (collapsing) collapsing(id);
    links_.collapse(id);
  }
  links_.evaluated(id, v.link);
  if (v.split == Split::None) return;
  const bool optional =
      v.link.receiver != v.link.sender && v.link.K >= 0 && v.link.visibility != hierarchy::Visibility::Unknown;
  if (stopping && optional) {
    report_.stopped = true;
    return;
  }
  if (!splitLink(links_, elements_, scene_, id, v.split)) return;
  report_.created += links_[id].childCount;
  descend(p.task, v, next, true);
}

void LinkDescent::descend(const Task& task, const Evaluation& v, std::vector<Task>& next, bool fresh) const {
  const hierarchy::Link& link = links_[task.link];
  for (std::size_t c = 0; c < link.childCount; ++c) {
    const hierarchy::LinkId child = links_.child(task.link, c);
    const LinkMark mark = fresh ? LinkMark::Path : marks_[child.index()];
    if (mark != LinkMark::None) next.push_back({child, v.blockers, task.block, mark});
  }
}

}  // namespace deltalux::paper
