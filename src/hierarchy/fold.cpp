#include "hierarchy/fold.hpp"

#include <algorithm>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "hierarchy/input_level.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::hierarchy {

namespace {

constexpr std::uint32_t kNone = Id<void>::kNone;
constexpr std::size_t kFewElements = 256;  // of a task [task]

/// Gives an input its plane again, of the same outline; false where that has other corners.
bool placePlane(Elements& elements, const Scene& scene, ElementId input) {
  const PatchDomain& d = elements.domain[input.index()];
  const auto plane = planeOf(scene[d.primitive].shape, d.triangle);
  if (plane.has_value() != elements.at(input).flat) return false;
  if (!plane) return true;
  elements.frames[d.frame] = *plane;
  const std::vector<Vec2> outline = outlineOf(scene[d.primitive].shape);
  if (outline.size() != d.outlineSize) return false;
  std::ranges::copy(outline, elements.outlines.begin() + d.outline);
  return true;
}

bool sameInput(const Elements& a, ElementId i, const Elements& b, ElementId j) {
  const PatchDomain &x = a.domain[i.index()], &y = b.domain[j.index()];
  const ElementGeometry &g = a.shape(i), &h = b.shape(j);
  return x.primitive == y.primitive && x.triangle == y.triangle && a.at(i).front == b.at(j).front &&
         g.center == h.center && g.area == h.area && g.radius == h.radius && g.lower == h.lower && g.upper == h.upper &&
         g.normal == h.normal;
}

/// Appends the parts that a folded patch had to a patch of other elements, folded as well, but not away yet.
void appendParts(Elements& to, ElementId whole, const Elements& from, ElementId old) {
  const std::uint8_t count = from.folded[old.index()];
  const ElementId first = to.addChildren(whole, ElementKind::Patch, count);
  to.topology[whole.index()].childCount = 0;
  to.folded.resize(to.size(), 0), to.folded[whole.index()] = count;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::size_t c = first.index() + i, b = from.at(old).firstChild.index() + i;
    ElementTopology& t = to.topology[c];
    const ElementId parent = t.parent;
    t = from.topology[b];
    t.parent = parent, t.firstChild = {}, t.childCount = 0, t.kind = ElementKind::Patch;
    to.geometry[c] = from.geometry[b], to.nodes[c] = from.nodes[b], to.moments[c] = from.moments[b];
    to.light[c] = to.light[whole.index()], to.key[c] = from.key[b];
    PatchDomain& d = to.domain[c];
    const PatchDomain &whole_ = to.domain[whole.index()], &was = from.domain[b];
    d = was;
    if (was.order > 0) {
      d.order = whole_.order;
      continue;
    }
    const auto outline = from.outline(ElementId(b));
    d.outline = static_cast<std::uint32_t>(to.outlines.size());
    to.outlines.insert(to.outlines.end(), outline.begin(), outline.end());
    if (from.domain[old.index()].order == 0) {
      d.frame = whole_.frame;
    } else if (t.flat) {  // a single face
      d.frame = static_cast<std::uint32_t>(to.frames.size());
      to.frames.push_back(from.frames[was.frame]);
    }
  }
}

}  // namespace

void fold(Elements& elements) {
  elements.folded.assign(elements.size(), 0);
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementId e(i);
    if (!elements.receives(e)) continue;
    ElementTopology& t = elements.topology[i];
    elements.folded[i] = static_cast<std::uint8_t>(t.childCount), t.childCount = 0;
    if (t.depth > 0) {
      t.kind = ElementKind::Away;
      continue;
    }
    if (elements.folded[i] > 0 && elements.hasFaces(e)) elements.holdSides(e);
    elements.geometry[i].exposed = 1;
    ElementLight& r = elements.radiometry[i];
    const ElementLight built{.rho = r.rho, .tau = r.tau};
    r = built;
  }
}

void inherit(Elements& elements, ElementId part, ElementId whole) {
  ElementGeometry& g = elements.geometry[part.index()];
  g.meanFreePath = elements.shape(whole).meanFreePath, g.exposed = 1;
  ElementLight& r = elements.radiometry[part.index()];
  r = elements.radiometry[whole.index()];
  r.directGathered = r.indirectGathered = r.particle = Rgb(0.0f);
}

bool unfold(Elements& elements, ElementId e) {
  if (e.index() >= elements.folded.size() || elements.folded[e.index()] == 0) return false;
  ElementTopology& t = elements.topology[e.index()];
  t.childCount = elements.folded[e.index()], elements.folded[e.index()] = 0;
  for (std::size_t i = 0; i < t.childCount; ++i) {
    const ElementId c = elements.child(e, i);
    elements.topology[c.index()].kind = ElementKind::Patch;
    inherit(elements, c, e);
    if (elements.hasFaces(e)) elements.holdSides(c);
  }
  return true;
}

void forgetFolded(Elements& elements) { elements.folded.clear(); }

std::size_t awayIn(const Elements& elements) {
  return static_cast<std::size_t>(
      std::ranges::count(elements.topology, ElementKind::Away, [](const ElementTopology& t) { return t.kind; }));
}

bool bringTo(Elements& elements, const Scene& scene, std::span<const PrimitiveId> moved) {
  const std::vector<ElementId> inputs = elementsOf(elements, moved);
  const auto inPlace = [&](ElementId e) {
    return !elements.hasFaces(e) && area(scene[elements.domain[e.index()].primitive].shape) > 0;
  };
  if (!std::ranges::all_of(inputs, inPlace)) return false;
  for (const ElementId e : inputs) {
    if (!placePlane(elements, scene, e)) return false;
    elements.folded[e.index()] = 0;
  }
  parallelFor(inputs.size(), kFewElements, [&](std::size_t i) { shapePatch(elements, scene, inputs[i]); });
  shapeAbove(elements, inputs);
  const Box box = bounds(scene);
  if (box.lower == elements.sceneBox.lower && box.upper == elements.sceneBox.upper) return true;
  elements.sceneBox = box;
  for (std::uint32_t e = 0; e < elements.size(); ++e)
    if (elements.isDistant(ElementId(e))) shapeDistant(elements, scene, ElementId(e));
  return true;
}

std::vector<std::uint32_t> carryOver(Elements& to, const Scene& scene, const Elements& from,
                                     const std::vector<char>& stays) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> byKey;  // ascending
  for (const ElementId e : from.inputs)
    if (from.receives(e)) byKey.emplace_back(from.key[e.index()], e.value);
  std::ranges::sort(byKey);
  const std::size_t inputs = to.size();
  std::vector<std::uint32_t> was(inputs, kNone);
  std::vector<ElementId> level;
  for (const ElementId e : to.inputs) {
    if (!to.receives(e) || !stays[to.domain[e.index()].primitive.index()]) continue;
    const auto at = std::ranges::lower_bound(byKey, std::pair(to.key[e.index()], std::uint32_t(0)));
    if (at == byKey.end() || at->first != to.key[e.index()] || !sameInput(to, e, from, ElementId(at->second))) continue;
    was[e.index()] = at->second, level.push_back(e);
  }
  to.folded.assign(to.size(), 0);
  while (!level.empty()) {
    std::vector<char> same(level.size(), 0);
    parallelFor(level.size(), kFewElements, [&](std::size_t i) {
      const ElementId old(was[level[i].index()]);
      same[i] = from.folded[old.index()] > 0 &&
                splitsAlike(to, scene, level[i], from, from.at(old).firstChild, from.folded[old.index()]);
    });
    std::vector<ElementId> parts;
    for (std::size_t i = 0; i < level.size(); ++i) {
      if (!same[i]) continue;
      const ElementId old(was[level[i].index()]);
      appendParts(to, level[i], from, old);
      was.resize(to.size(), kNone);
      for (std::uint32_t c = 0; c < to.folded[level[i].index()]; ++c) {
        const ElementId part(to.at(level[i]).firstChild.index() + c);
        was[part.index()] = from.at(old).firstChild.value + c, parts.push_back(part);
      }
    }
    level = std::move(parts);
  }
  for (std::size_t i = inputs; i < to.size(); ++i) to.topology[i].kind = ElementKind::Away;
  return was;
}

std::vector<std::uint32_t> numbersWithoutAway(const Elements& all) {
  std::vector<std::uint32_t> now(all.size(), kNone);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < all.size(); ++i)
    if (all.topology[i].kind != ElementKind::Away) now[i] = count++;
  return now;
}

Elements compacted(const Elements& all) {
  DELTALUX_CHECK(all.folded.empty(), "elements that are whole");
  const std::vector<std::uint32_t> now = numbersWithoutAway(all);
  const std::size_t count = all.size() - awayIn(all);
  Elements few = all;
  const auto keep = [&](auto& values) {
    for (std::size_t i = 0; i < all.size(); ++i)
      if (now[i] != kNone) values[now[i]] = values[i];
    values.resize(count);
  };
  keep(few.topology), keep(few.geometry), keep(few.nodes), keep(few.domain), keep(few.moments), keep(few.light);
  keep(few.radiometry), keep(few.slot), keep(few.key);
  const auto rename = [&](ElementId& e) {
    if (e.valid()) e = ElementId(now[e.index()]);
  };
  for (ElementTopology& t : few.topology) {
    rename(t.parent);
    if (t.childCount > 0)
      rename(t.firstChild);
    else
      t.firstChild = {};
  }
  rename(few.sceneRoot), rename(few.lightRoot);
  for (std::vector<ElementId>* list : {&few.grown, &few.distant, &few.inactive})
    for (ElementId& e : *list) rename(e);
  few.outlines.clear();
  for (std::size_t i = 0; i < count; ++i) {
    PatchDomain& d = few.domain[i];
    if (d.order > 0) continue;
    const auto first = all.outlines.begin() + d.outline;
    d.outline = static_cast<std::uint32_t>(few.outlines.size());
    few.outlines.insert(few.outlines.end(), first, first + d.outlineSize);
  }
  few.listInputs();
  return few;
}

}  // namespace deltalux::hierarchy
