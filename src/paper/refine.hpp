#pragma once
// Refinement: descends the link tree from its roots (one self-link of the whole scene, and one link from every light),
// level by level, with the blocker lists handed from parent to child; accepts links whose error is within the budget
// and splits an end of the others [GD01 2.1; SIL95 III.B; HW91].
//
// How it goes down, level by level, on how many threads ever: link_descent.hpp. Links accepted earlier are evaluated
// again with today's radiosities: refining an already refined tree with a smaller error continues it (multigridding).
// Cost: one kernel, one shaft and at most kMaxSamples rays a link.
#include <functional>

#include "hierarchy/link.hpp"
#include "paper/line_space.hpp"
#include "paper/oracle.hpp"
#include "tracing/ray_tracer.hpp"

namespace deltalux::paper {

struct RefineReport {
  std::uint64_t created = 0, rays = 0;
  std::uint64_t changed = 0;  // of those that were there: carry light otherwise
  bool stopped = false;       // ended early; the tree is consistent, some links err by more than their budget
};

/// Makes the root links of `elements` if there are none yet.
void makeRootLinks(hierarchy::Links&, const hierarchy::Elements&);
/// Makes the root links between what has grown and everything, itself included.
void addRootLinks(hierarchy::Links&, const hierarchy::Elements&, hierarchy::ElementId grown);

/// Evaluates the marked links again after a move: active ones whose ends or visibility changed, interior ones that may
/// no longer need to be refined, which collapse (`collapsing` is told each of them before it does); and refines root
/// links that were made since the marks were.
RefineReport evaluateAgain(hierarchy::Links&, hierarchy::Elements&, const Scene&, const tracing::RayTracer&,
                           const OracleSettings&, LinkMarks& marks, std::function<void(hierarchy::LinkId)> collapsing);

/// `stop` is asked between levels; true ends refinement with a consistent tree.
RefineReport refine(hierarchy::Links&, hierarchy::Elements&, const Scene&, const tracing::RayTracer&,
                    const OracleSettings&, const std::function<bool()>& stop = {});

}  // namespace deltalux::paper
