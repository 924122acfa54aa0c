#include "io/solution_file/references.hpp"

#include <cmath>
#include <cstddef>
#include <cstring>
#include <stdexcept>

#include "hierarchy/leaf_table.hpp"
#include "scene/edit/plan.hpp"

namespace deltalux::io {

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

void checkTopology(const hierarchy::Elements& e) {
  for (std::size_t i = 0; i < e.size(); ++i) {
    const hierarchy::ElementTopology& t = e.topology[i];
    require(
        byteAt(t, offsetof(hierarchy::ElementTopology, kind)) <= static_cast<unsigned>(hierarchy::ElementKind::Distant),
        "element: kind");
    for (const std::size_t flag :
         {offsetof(hierarchy::ElementTopology, front), offsetof(hierarchy::ElementTopology, emitter),
          offsetof(hierarchy::ElementTopology, flat), offsetof(hierarchy::ElementTopology, blocker)})
      require(byteAt(t, flag) <= 1, "element: flag");
    require(!t.parent.valid() || t.parent.index() < i, "element: parent");
    if (t.childCount == 0) continue;
    require(t.firstChild.index() < e.size() && t.childCount <= e.size() - t.firstChild.index(), "element: children");
    for (std::size_t c = 0; c < t.childCount; ++c)
      require(e.at(e.child(hierarchy::ElementId(i), c)).parent == hierarchy::ElementId(i),
              "element: its children know it");
  }
}

void checkDomain(const hierarchy::Elements& e, const Scene& scene, std::size_t i) {
  const hierarchy::ElementTopology& t = e.topology[i];
  const hierarchy::PatchDomain& d = e.domain[i];
  require(d.primitive.index() < scene.primitives.size(), "patch: primitive");
  // What was removed has lost its shape, but not its elements.
  const auto* mesh = std::get_if<Mesh>(&scene::edits::restShape(scene, d.primitive));
  require(d.triangle < (mesh ? mesh->triangles.size() : 1), "patch: triangle");
  if (d.order > 0) {
    require(!t.flat && mesh && d.order <= e.faceOrders.size() && e.faceOrders[d.order - 1].primitive() == d.primitive,
            "patch: order of faces");
    const std::size_t faces = e.faceOrders[d.order - 1].faces();
    require(d.outlineSize >= 2 && d.outline <= faces && d.outlineSize <= faces - d.outline, "patch: faces");
  } else {
    require(d.outline <= e.outlines.size() && d.outlineSize <= e.outlines.size() - d.outline, "patch: outline");
  }
  require(!t.flat || (d.frame < e.frames.size() && d.outlineSize >= 3), "patch: plane");
  require(std::isfinite(d.u0) && std::isfinite(d.u1) && std::isfinite(d.v0) && std::isfinite(d.v1), "patch: rectangle");
}

void checkElements(const hierarchy::Elements& e, const Scene& scene) {
  const std::size_t n = e.size();
  for (const std::size_t size : {e.geometry.size(), e.nodes.size(), e.domain.size(), e.moments.size(), e.light.size(),
                                 e.radiometry.size(), e.slot.size(), e.key.size()})
    require(size == n, "elements: arrays of one length");
  checkTopology(e);
  for (std::size_t i = 0; i < n; ++i) {
    if (e.topology[i].kind == hierarchy::ElementKind::Patch) checkDomain(e, scene, i);
    if (e.topology[i].kind == hierarchy::ElementKind::Cluster) require(e.slot[i] < e.clusters.size(), "cluster: slot");
    require(!e.light[i].valid() || e.light[i].index() < scene.lights.size(), "element: light");
    const bool sends =
        e.topology[i].kind == hierarchy::ElementKind::Point || e.topology[i].kind == hierarchy::ElementKind::Distant;
    require(!sends || e.light[i].valid(), "sender: light");
  }
  for (const hierarchy::ElementId root : {e.sceneRoot, e.lightRoot})
    require(!root.valid() || root.index() < n, "root element");
  for (const hierarchy::ElementId root : e.grown) require(root.index() < n && e.isCluster(root), "root element");
  for (const hierarchy::ElementId a : e.inactive) require(a.index() < n && e.isInputLevel(a), "inactive element");
  for (const hierarchy::ElementId d : e.distant) require(d.index() < n, "distant sender");
}

void checkLink(const hierarchy::Link& l, std::size_t links, const hierarchy::Elements& e) {
  require(byteAt(l, offsetof(hierarchy::Link, state)) <= static_cast<unsigned>(hierarchy::LinkState::Free),
          "link: state");
  if (l.state == hierarchy::LinkState::Free) return require(l.childCount == 0, "free link: children");
  require(byteAt(l, offsetof(hierarchy::Link, visibility)) <= static_cast<unsigned>(hierarchy::Visibility::Sampled),
          "link: visibility");
  require(l.receiver.index() < e.size() && l.sender.index() < e.size(), "link: ends");
  require(!l.parent.valid() || l.parent.index() < links, "link: parent");
  require(l.childCount == 0 || (l.firstChild.index() < links && l.childCount <= links - l.firstChild.index()),
          "link: children");
}

/// From the roots down every link is met once, and knows from where.
void checkLinkTree(const hierarchy::Links& links) {
  std::vector<hierarchy::LinkId> open;
  std::size_t met = 0;
  for (const hierarchy::LinkId root : links.roots) {
    require(root.index() < links.size() && !links[root].parent.valid(), "root link");
    open.push_back(root);
  }
  while (!open.empty()) {
    require(++met <= links.size(), "link: met twice");
    const hierarchy::LinkId id = open.back();
    open.pop_back();
    require(links[id].state != hierarchy::LinkState::Free, "link: free");
    for (std::size_t c = 0; c < links[id].childCount; ++c) {
      const hierarchy::LinkId child = links.child(id, c);
      require(links[child].parent == id, "link: its children know it");
      open.push_back(child);
    }
  }
}

/// Lines are of leaves, end on leaves, and lie on shapes that are there.
void checkLines(const lines::Lines& l, const std::vector<float>& deviation, const hierarchy::Elements& elements,
                const Scene& scene) {
  for (const lines::ExceptionalLine& e : l.exceptions.all)
    require(byteAt(e, offsetof(lines::ExceptionalLine, turned)) <= 1 &&
                byteAt(e, offsetof(lines::ExceptionalLine, rough)) <= 1 &&
                byteAt(e, offsetof(lines::ExceptionalLine, beyond)) <= 1,
            "line: flag");
  validate(l);
  if (l.empty()) return require(deviation.empty(), "deviations: of leaves");
  const hierarchy::LeafTable leaves(elements);
  require(l.of.size() == elements.size(), "lines: of every element");
  require(deviation.size() == leaves.size(), "deviations: of leaves");
  const auto isLeaf = [&](std::uint32_t e) { return leaves.indexOf[e] != hierarchy::LeafTable::kNone; };
  for (std::uint32_t i = 0; i < l.of.size(); ++i) {
    if (l.of[i].count == 0) continue;
    const hierarchy::PatchDomain& d = elements.domain[i];
    require(isLeaf(i), "lines: of leaves");
    const auto* mesh = std::get_if<Mesh>(&scene[d.primitive].shape);
    require(!mesh || d.triangle < mesh->triangles.size(), "lines: of a shape");
  }
  for (const std::uint32_t end : l.end) require(end >= lines::kFirstMark || isLeaf(end), "lines: end on leaves");
  for (const lines::ExceptionalLine& e : l.exceptions.all) require(isLeaf(e.end), "lines: end on leaves");
}

void checkCaustics(const caustics::Caustics& c, const Scene& scene) {
  require(c.ofPrimitive.empty() || c.ofPrimitive.size() == scene.primitives.size(), "caustics: one entry a primitive");
  for (const auto& sides : c.ofPrimitive)
    for (const std::uint32_t s : sides)
      require(s == caustics::Caustics::kNone || s < c.surfaces.size(), "caustics: surface");
  for (const caustics::SurfaceCaustics& s : c.surfaces) {
    require(s.primitive.index() < scene.primitives.size() && !s.charts.all.empty(), "caustics: primitive");
    const auto* mesh = std::get_if<Mesh>(&scene[s.primitive].shape);
    require(s.charts.ofTriangle.size() == (mesh ? mesh->triangles.size() : 0), "caustics: charts of triangles");
    for (const std::uint32_t chart : s.charts.ofTriangle) require(chart < s.charts.all.size(), "caustics: chart");
  }
  validate(c);
}

}  // namespace

void checkTables(const Scene& scene) {
  for (const Primitive& p : scene.primitives) checkTables(p.shape);
  for (const Placement& p : scene.placements) checkTables(p.rest);
}

void checkReferences(const Solution& s) {
  checkElements(s.elements, s.scene);
  for (const hierarchy::Link& l : s.links.all) checkLink(l, s.links.size(), s.elements);
  checkLinkTree(s.links);
  validate(s.particles, s.scene);
  require(s.links.all.empty() || s.sampledScale.size() == s.scene.lights.size(), "scales: one a light");
  checkLines(s.lines, s.deviation, s.elements, s.scene);
  checkCaustics(s.caustics, s.scene);
  for (const LightColumn& c : s.columns.of) checkCaustics(c.caustics, s.scene);
  validate(s.columns, s.scene, hierarchy::LeafTable(s.elements).size());
}

}  // namespace deltalux::io
