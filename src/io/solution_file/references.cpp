#include "io/solution_file/references.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "scene/edit/plan.hpp"

namespace deltalux {

namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

/// Enumerators and bools read from bytes may be none: they are looked at as bytes.
template <class Record>
unsigned byteAt(const Record& record, std::size_t offset) {
  unsigned char byte = 0;
  std::memcpy(&byte, reinterpret_cast<const unsigned char*>(&record) + offset, 1);
  return byte;
}

void checkTables(const Shape& shape) {
  if (const auto* p = std::get_if<Polygon>(&shape))
    require(p->outline.size() == p->vertices.size() && p->cumulativeArea.size() == p->triangles.size(),
            "polygon: its tables");
  if (const auto* m = std::get_if<Mesh>(&shape))
    require(m->triangles.empty() == m->positions.empty() && m->cumulativeArea.size() == m->triangles.size(),
            "mesh: its tables");
}

void checkTopology(const Elements& e) {
  for (std::size_t i = 0; i < e.size(); ++i) {
    const ElementTopology& t = e.topology[i];
    require(byteAt(t, offsetof(ElementTopology, kind)) <= static_cast<unsigned>(ElementKind::Distant), "element: kind");
    for (const std::size_t flag : {offsetof(ElementTopology, front), offsetof(ElementTopology, emitter),
                                   offsetof(ElementTopology, flat), offsetof(ElementTopology, blocker)})
      require(byteAt(t, flag) <= 1, "element: flag");
    require(!t.parent.valid() || t.parent.index() < i, "element: parent");
    if (t.childCount == 0) continue;
    require(t.firstChild.index() < e.size() && t.childCount <= e.size() - t.firstChild.index(), "element: children");
    for (std::size_t c = 0; c < t.childCount; ++c)
      require(e.at(e.child(ElementId(i), c)).parent == ElementId(i), "element: its children know it");
  }
}

void checkDomain(const Elements& e, const Scene& scene, std::size_t i) {
  const ElementTopology& t = e.topology[i];
  const PatchDomain& d = e.domain[i];
  require(d.primitive.index() < scene.primitives.size(), "patch: primitive");
  // What was removed has lost its shape, but not its elements.
  const auto* mesh = std::get_if<Mesh>(&edits::restShape(scene, d.primitive));
  require(d.triangle < (mesh ? mesh->triangles.size() : 1), "patch: triangle");
  require(d.outline <= e.outlines.size() && d.outlineSize <= e.outlines.size() - d.outline, "patch: outline");
  require(!t.flat || (d.frame < e.frames.size() && d.outlineSize >= 3), "patch: plane");
  require(std::isfinite(d.u0) && std::isfinite(d.u1) && std::isfinite(d.v0) && std::isfinite(d.v1), "patch: rectangle");
}

void checkElements(const Elements& e, const Scene& scene) {
  const std::size_t n = e.size();
  for (const std::size_t size : {e.geometry.size(), e.nodes.size(), e.domain.size(), e.moments.size(), e.light.size(),
                                 e.radiometry.size(), e.slot.size(), e.key.size()})
    require(size == n, "elements: arrays of one length");
  checkTopology(e);
  for (std::size_t i = 0; i < n; ++i) {
    if (e.topology[i].kind == ElementKind::Patch) checkDomain(e, scene, i);
    if (e.topology[i].kind == ElementKind::Cluster) require(e.slot[i] < e.clusters.size(), "cluster: slot");
    require(!e.light[i].valid() || e.light[i].index() < scene.lights.size(), "element: light");
    const bool sends = e.topology[i].kind == ElementKind::Point || e.topology[i].kind == ElementKind::Distant;
    require(!sends || e.light[i].valid(), "sender: light");
  }
  for (const ElementId root : {e.sceneRoot, e.lightRoot}) require(!root.valid() || root.index() < n, "root element");
  for (const ElementId root : e.grown) require(root.index() < n && e.isCluster(root), "root element");
  for (const ElementId a : e.asleep) require(a.index() < n && e.isInputLevel(a), "sleeping element");
  for (const ElementId d : e.distant) require(d.index() < n, "distant sender");
}

void checkLink(const Link& l, std::size_t links, const Elements& e) {
  require(byteAt(l, offsetof(Link, state)) <= static_cast<unsigned>(LinkState::Free), "link: state");
  if (l.state == LinkState::Free) return require(l.childCount == 0, "free link: children");
  require(byteAt(l, offsetof(Link, visibility)) <= static_cast<unsigned>(Visibility::Sampled), "link: visibility");
  require(l.receiver.index() < e.size() && l.sender.index() < e.size(), "link: ends");
  require(!l.parent.valid() || l.parent.index() < links, "link: parent");
  require(l.childCount == 0 || (l.firstChild.index() < links && l.childCount <= links - l.firstChild.index()),
          "link: children");
}

/// From the roots down every link is met once, and knows from where.
void checkLinkTree(const Links& links) {
  std::vector<LinkId> open;
  std::size_t met = 0;
  for (const LinkId root : links.roots) {
    require(root.index() < links.size() && !links[root].parent.valid(), "root link");
    open.push_back(root);
  }
  while (!open.empty()) {
    require(++met <= links.size(), "link: met twice");
    const LinkId id = open.back();
    open.pop_back();
    require(links[id].state != LinkState::Free, "link: free");
    for (std::size_t c = 0; c < links[id].childCount; ++c) {
      const LinkId child = links.child(id, c);
      require(links[child].parent == id, "link: its children know it");
      open.push_back(child);
    }
  }
}

void checkCaustics(const Caustics& c, const Scene& scene) {
  require(c.ofPrimitive.empty() || c.ofPrimitive.size() == scene.primitives.size(), "caustics: one entry a primitive");
  for (const auto& sides : c.ofPrimitive)
    for (const std::uint32_t s : sides) require(s == Caustics::kNone || s < c.surfaces.size(), "caustics: surface");
  for (const SurfaceCaustics& s : c.surfaces) {
    require(s.primitive.index() < scene.primitives.size() && !s.charts.all.empty(), "caustics: primitive");
    const auto* mesh = std::get_if<Mesh>(&scene[s.primitive].shape);
    require(s.charts.ofTriangle.size() == (mesh ? mesh->triangles.size() : 0), "caustics: charts of triangles");
    for (const std::uint32_t chart : s.charts.ofTriangle) require(chart < s.charts.all.size(), "caustics: chart");
  }
  validate(c);
}

}  // namespace

void checkReferences(const Solution& s) {
  for (const Primitive& p : s.scene.primitives) checkTables(p.shape);
  for (const Placement& p : s.scene.placements) checkTables(p.rest);
  checkElements(s.elements, s.scene);
  for (const Link& l : s.links.all) checkLink(l, s.links.size(), s.elements);
  checkLinkTree(s.links);
  validate(s.particles, s.scene);
  s.transfers.validate(s.elements, s.links);
  require(s.transfers.empty() || s.sampledScale.size() == s.scene.lights.size(), "scales: one a light");
  checkCaustics(s.caustics, s.scene);
}

}  // namespace deltalux
