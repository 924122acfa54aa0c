#include "paper/refine.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
#include "paper/link_descent.hpp"

namespace deltalux::paper {

void makeRootLinks(hierarchy::Links& links, const hierarchy::Elements& elements) {
  if (!links.roots.empty() || !elements.sceneRoot.valid()) return;
  const auto add = [&](hierarchy::ElementId sender) { links.addRoot(elements.sceneRoot, sender); };
  add(elements.sceneRoot);
  if (elements.lightRoot.valid()) add(elements.lightRoot);
  for (const hierarchy::ElementId e : elements.distant) add(e);
}

void addRootLinks(hierarchy::Links& links, const hierarchy::Elements& elements, hierarchy::ElementId grown) {
  if (links.roots.empty()) return makeRootLinks(links, elements);
  for (const hierarchy::ElementId root : elements.sceneRoots()) {
    links.addRoot(grown, root);
    if (root != grown) links.addRoot(root, grown);
  }
  if (elements.lightRoot.valid()) links.addRoot(grown, elements.lightRoot);
  for (const hierarchy::ElementId e : elements.distant) links.addRoot(grown, e);
}

namespace {

/// Marks the links above a marked one: they are on its path, or on its way.
void markAbove(const hierarchy::Links& links, LinkDescent::Marks& marks, hierarchy::LinkId id, LinkMark as) {
  for (hierarchy::LinkId up = links[id].parent; up.valid(); up = links[up].parent) {
    LinkMark& mark = marks.at(up.index());
    if (mark >= as && mark != LinkMark::Between) return;  // so is all above it
    mark = std::max(mark, as);
  }
}

}  // namespace

RefineReport refine(hierarchy::Links& links, hierarchy::Elements& elements, const Scene& scene,
                    const tracing::RayTracer& tracer, const OracleSettings& settings,
                    const std::function<bool()>& stop) {
  makeRootLinks(links, elements);
  std::vector<char> unrefined(links.size(), 0);
  const LinkEvaluator evaluator(elements, scene, tracer, settings);
  parallelFor(links.size(), 4096, [&](std::size_t i) { unrefined[i] = evaluator.unrefined(links.all[i]); });
  LinkDescent::Marks marks(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!unrefined[i]) continue;
    marks.at(i) = LinkMark::Path;
    markAbove(links, marks, hierarchy::LinkId(i), LinkMark::Path);
  }
  LinkDescent descent(links, elements, scene, tracer, settings, std::move(marks));
  descent.stop = stop;
  return descent.run();
}

RefineReport evaluateAgain(hierarchy::Links& links, hierarchy::Elements& elements, const Scene& scene,
                           const tracing::RayTracer& tracer, const OracleSettings& settings, LinkMarks& marked,
                           std::function<void(hierarchy::LinkId)> collapsing) {
  std::sort(marked.between.begin(), marked.between.end(),
            [](const DisturbedLink& a, const DisturbedLink& b) { return a.link < b.link; });
  LinkDescent::Marks marks(links.size());
  for (const DisturbedLink& d : marked.between) marks.at(d.link.index()) = LinkMark::Between;
  for (const hierarchy::LinkId id : marked.moved) marks.at(id.index()) = LinkMark::Ends;
  for (const hierarchy::LinkId id : marked.moved) markAbove(links, marks, id, LinkMark::Path);
  for (const DisturbedLink& d : marked.between)
    markAbove(links, marks, d.link,
              links[d.link].visibility == hierarchy::Visibility::Sampled ? LinkMark::Way : LinkMark::Path);
  for (const hierarchy::LinkId root : marked.made) marks.at(root.index()) = LinkMark::Path;
  LinkDescent descent(links, elements, scene, tracer, settings, std::move(marks), marked.between);
  descent.collapsing = std::move(collapsing);
  return descent.run();
}

}  // namespace deltalux::paper
