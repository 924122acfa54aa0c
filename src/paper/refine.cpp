#include "paper/refine.hpp"

#include <algorithm>
#include <utility>

#include "base/parallel.hpp"
#include "paper/link_descent.hpp"
#include "paper/link_news.hpp"

namespace deltalux::paper {

void makeRootLinks(hierarchy::Links& links, const hierarchy::Elements& elements) {
  if (!links.roots.empty() || !elements.sceneRoot.valid()) return;
  const auto add = [&](hierarchy::ElementId sender) {
    links.addRoot(elements.sceneRoot, sender, elements.at(sender).emitter);
  };
  add(elements.sceneRoot);
  if (elements.lightRoot.valid()) add(elements.lightRoot);
  for (const hierarchy::ElementId e : elements.distant) add(e);
}

void addRootLinks(hierarchy::Links& links, const hierarchy::Elements& elements, hierarchy::ElementId grown) {
  if (links.roots.empty()) return makeRootLinks(links, elements);
  for (const hierarchy::ElementId root : elements.sceneRoots()) {
    links.addRoot(grown, root, false);
    if (root != grown) links.addRoot(root, grown, false);
  }
  if (elements.lightRoot.valid()) links.addRoot(grown, elements.lightRoot, true);
  for (const hierarchy::ElementId e : elements.distant) links.addRoot(grown, e, true);
}

namespace {

/// The links below `id` that carry light.
template <class Visit>
void forEachCarrying(const hierarchy::Links& links, hierarchy::LinkId id, const Visit& visit) {
  if (links[id].carries()) visit(id);
  for (std::size_t c = 0; c < links[id].childCount; ++c) forEachCarrying(links, links.child(id, c), visit);
}

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
  std::vector<char> unsettled(links.size(), 0);
  const LinkJudge judge(elements, scene, tracer, settings);
  parallelFor(links.size(), 4096, [&](std::size_t i) { unsettled[i] = judge.unsettled(links.all[i]); });
  LinkDescent::Marks marks(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (!unsettled[i]) continue;
    marks.at(i) = LinkMark::Path;
    markAbove(links, marks, hierarchy::LinkId(i), LinkMark::Path);
  }
  LinkDescent descent(links, elements, scene, tracer, settings, std::move(marks));
  descent.stop = stop;
  return descent.run();
}

RefineReport rejudge(hierarchy::Links& links, hierarchy::Elements& elements, const Scene& scene,
                     const tracing::RayTracer& tracer, const OracleSettings& settings, LinkMarks& marked,
                     std::vector<hierarchy::LinkId>& changed) {
  std::sort(marked.anew.begin(), marked.anew.end(),
            [](const DisturbedLink& a, const DisturbedLink& b) { return a.link < b.link; });
  LinkDescent::Marks marks(links.size());
  for (const DisturbedLink& d : marked.anew) marks.at(d.link.index()) = LinkMark::Between;
  for (const hierarchy::LinkId id : marked.moved) marks.at(id.index()) = LinkMark::Ends;
  for (const hierarchy::LinkId id : marked.moved) markAbove(links, marks, id, LinkMark::Path);
  for (const DisturbedLink& d : marked.anew)
    markAbove(links, marks, d.link,
              links[d.link].visibility == hierarchy::Visibility::Sampled ? LinkMark::Way : LinkMark::Path);
  const std::size_t known = marked.changes.size();
  for (const hierarchy::LinkId root : links.roots)
    if (root.index() >= known) marks.at(root.index()) = LinkMark::Path;
  LinkDescent descent(links, elements, scene, tracer, settings, std::move(marks), marked.anew);
  if (std::any_of(links.roots.begin(), links.roots.end(),
                  [&](hierarchy::LinkId root) { return root.index() >= known; }))
    descent.grown = elements.grown.back();
  descent.renewed = [&](hierarchy::LinkId id) {
    if (id.index() < known) marked.changes.at(id.index()) = LinkChange::Changed;
  };
  descent.changed = [&](hierarchy::LinkId id) {
    if (id.index() >= known || marked.changes[id.index()] == LinkChange::Changed) return;
    marked.changes.at(id.index()) = LinkChange::Changed;
    changed.push_back(id);
  };
  const RefineReport report = descent.run();
  // Split or averted by now, they have rows over them still, of where the lights were.
  for (const hierarchy::LinkId id : marked.lit)
    if (links[id].state != hierarchy::LinkState::Free) descent.changed(id);
  // What has grown is new to all that was there and may see it; its own elements are new themselves.
  const LinkJudge judge(elements, scene, tracer, settings);
  for (const hierarchy::LinkId root : links.roots)
    if (root.index() >= known && links[root].sender == elements.grown.back() &&
        links[root].receiver != links[root].sender)
      forEachCarrying(links, root, [&](hierarchy::LinkId id) {
        if (judge.brings(links[id], kNewsToRows)) changed.push_back(id);
      });
  return report;
}

}  // namespace deltalux::paper
