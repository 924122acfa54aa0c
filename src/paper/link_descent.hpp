#pragma once
// One descent over marked links of the tree, level by level: each is evaluated (link_evaluator.hpp), and accepted,
// split or collapsed. refine.hpp says what it is for.
//
// Links of a level are evaluated side by side, from elements and links above that stand still; those that keep their
// place in the tree take what they were evaluated to be at once. What changes the tree or its elements follows in the
// order of the level, so the result does not depend on the number of threads.
#include <functional>
#include <span>
#include <vector>

#include "base/paged_array.hpp"
#include "paper/link_evaluator.hpp"
#include "paper/refine.hpp"

namespace deltalux::paper {

/// Why a link is looked at.
enum class LinkMark : char {
  None,
  Way,      // to links between whose ends something has changed, which rarely ask for blockers
  Path,     // on the way to others
  Between,  // what lies between its ends has changed
  Ends,     // so has an end
};

class LinkDescent {
 public:
  using Marks = PagedArray<LinkMark>;  // by link

  /// All must outlive this. `disturbed`: those marked Between, by their ids.
  LinkDescent(hierarchy::Links& links, hierarchy::Elements& elements, const Scene& scene,
              const tracing::RayTracer& tracer, const OracleSettings& settings, Marks marks,
              std::span<const DisturbedLink> disturbed = {})
      : links_(links),
        elements_(elements),
        scene_(scene),
        tracer_(tracer),
        settings_(settings),
        marks_(std::move(marks)),
        disturbed_(disturbed) {}

  std::function<bool()> stop;
  std::function<void(hierarchy::LinkId)> collapsing;  // told of interior links that become active

  RefineReport run();

 private:
  /// Blockers stand in the list of a block of the level above.
  struct Task {
    hierarchy::LinkId link;
    BlockerRange candidates;
    std::uint32_t block = 0;
    LinkMark mark = LinkMark::Path;
  };
  struct Pending {
    Task task;
    Evaluation evaluation;
    std::size_t place;  // of its children among `next`
  };
  /// What becomes of some links of a level.
  struct Block {
    Blockers blockers;
    std::vector<Task> next;        // below links that are finished
    std::vector<Pending> pending;  // links that are not
    RefineReport report;
  };

  void evaluateBlock(const LinkEvaluator&, std::span<const Task>, std::uint32_t index, Block&);
  Evaluation evaluationOf(const LinkEvaluator&, const Task&, const Candidates&) const;
  Evaluation evaluated(const LinkEvaluator&, const hierarchy::Link&, const Task&, const Candidates&) const;
  std::uint32_t raysOf(hierarchy::LinkId) const;
  bool finish(const Task&, const Evaluation&, Block&);
  void commit(const Pending&, bool stopping, std::vector<Task>& next);
  void descend(const Task&, const Evaluation&, std::vector<Task>& next, bool fresh) const;

  hierarchy::Links& links_;
  hierarchy::Elements& elements_;
  const Scene& scene_;
  const tracing::RayTracer& tracer_;
  const OracleSettings& settings_;
  Marks marks_;
  std::span<const DisturbedLink> disturbed_;
  std::vector<Block> above_, level_;
  RefineReport report_;
};

}  // namespace deltalux::paper
