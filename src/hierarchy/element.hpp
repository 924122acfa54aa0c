#pragma once
// The element hierarchy (HRC) [GD01 2.1]: clusters above, input-level surfaces in the middle, quadtree patches below,
// and the senders that are not surfaces. Cluster and surface are one element with a kind; elements are indices into
// arrays that only grow, and the children of one element are contiguous.
//
// Each side of a surface that light can reach is an element of its own; a side that cannot be reached has none.
// Area emitters have two elements: the surface in the scene tree, which receives and reflects, and the emitter in the
// light tree, which only sends. So the sender of a link tells direct from indirect light.
#include <deltalux/scene.hpp>
#include <span>
#include <vector>

#include "hierarchy/contact_lines.hpp"
#include "hierarchy/directional.hpp"
#include "hierarchy/face_order.hpp"
#include "hierarchy/side_table.hpp"

namespace deltalux::hierarchy {

using ElementId = Id<struct ElementTag>;

enum class ElementKind : std::uint8_t {
  Cluster,  // children are clusters and input-level elements
  Patch,    // one side of a surface or a part of it, receiving or emitting
  Point,    // a point light of any distribution: sends only
  Distant,  // the sun, or a cell of a sky dome: sends only
  Away,     // part of a patch that is folded, or is not split any more: takes no part in anything (fold.hpp)
};

struct ElementTopology {
  ElementId parent, firstChild;
  std::uint16_t childCount = 0;
  ElementKind kind = ElementKind::Cluster;
  bool front = true;       // Patch: which side of the primitive
  bool emitter = false;    // lives in the light tree
  bool flat = false;       // Patch: planar with an outline
  bool blocker = false;    // Patch: takes no diffuse light (glass); here for shafts and specular links
  std::uint8_t depth = 0;  // Patch, Distant: subdivisions below the input level
};

/// World-space extent. For Distant elements `center` is the unit direction towards the source, `area` its solid angle
/// and the box a far box in that direction, so that shafts treat it as any other.
struct ElementGeometry {
  Vec3f center{0.0f};
  float area = 0.0f;
  Vec3f normal{0.0f};   // Patch: mean normal of this side, unit (zero when it averages out)
  float radius = 0.0f;  // of a sphere about `center` that holds the element
  Vec3f lower{0.0f}, upper{0.0f};
  float normalCone = -1.0f;   // cosine of the half angle about `normal` that holds all normals: 1 flat, -1 anything
  float meanFreePath = 0.0f;  // mean distance to what is seen from here: the local scale of the scene
  float exposed = 1.0f;       // leaf: share of the area that light can reach, and that irradiance is the mean of

  float litArea() const { return exposed * area; }
};

/// Up to four area-weighted quadrature nodes of a patch, or representative surface points of a cluster.
struct ElementNodes {
  Vec3f position[4];
  Vec3f normal[4];
  float weight[4] = {0, 0, 0, 0};  // sum to 1
};

/// Where a patch lies on its primitive: the rectangle [u0,u1] x [v0,v1] of its parameters and, when flat, its outline.
/// A patch of many faces of a fine mesh is a range of their order, with the unit square over its area for parameters.
struct PatchDomain {
  PrimitiveId primitive;
  std::uint32_t triangle = 0;                  // mesh triangle, with its own (u,v): p0 + u (p1 - p0) + v (p2 - p0)
  std::uint32_t frame = 0;                     // flat: index of its plane
  std::uint32_t outline = 0, outlineSize = 0;  // flat: range in the outline pool, (u,v); many faces: of their order
  float u0 = 0, v0 = 0, u1 = 1, v1 = 1;
  std::uint32_t order = 0;    // many faces: one more than the index of their mesh's order
  std::uint64_t address = 1;  // path of quadrants from the input level: two bits a level below a leading 1
};

/// Plane of a flat input-level surface; the normal is the primitive's front.
struct PlaneFrame {
  Vec3 origin{0}, edgeU{1, 0, 0}, edgeV{0, 1, 0}, normal{0, 0, 1};

  Vec3 at(const Vec2& uv) const { return origin + uv.x * edgeU + uv.y * edgeV; }
};

/// Radiometry of one element. One writer per field: B and tolerance by push-pull, *Gathered by gather, direct and
/// indirect by push-pull from those, or at leaves by lines; particle by deposit, rho and tau by the builder.
struct ElementLight {
  Rgb B{0.0f};                                       // radiosity; for senders only: emission in their transfer's unit
  Rgb directGathered{0.0f}, indirectGathered{0.0f};  // over this element's own links
  Rgb direct{0.0f}, indirect{0.0f};                  // E of all levels, pushed to the leaves and averaged upwards
  Rgb particle{0.0f};                                // E of deposited particles
  Rgb rho{0.0f};                                     // diffuse reflectance of this side
  Rgb tau{0.0f};                                     // diffuse transmittance to the other side
  float tolerance = 0.0f;                            // gray irradiance that errors are measured against
  float typical = 0.0f;                              // first estimate of it (builder); bounds later ones
};

/// What a cluster sends and receives as functions of direction.
struct ClusterLight {
  DirectionalRgb intensity;                         // radiant intensity I(w) of all that it holds [W/sr]
  DirectionalRgb directGathered, indirectGathered;  // irradiance by receiving normal, over this cluster's own links
};

class Elements {
 public:
  std::vector<ElementTopology> topology;
  std::vector<ElementGeometry> geometry;
  std::vector<ElementNodes> nodes;
  std::vector<PatchDomain> domain;
  std::vector<NormalMoments> moments;  // patches: over their normals
  std::vector<LightId> light;          // emitters, points and distant senders
  std::vector<ElementLight> radiometry;
  std::vector<std::uint32_t> slot;  // clusters: index into `clusters`
  std::vector<ClusterLight> clusters;
  std::vector<std::uint64_t> key;  // stable: what the element is, not where it is stored
  std::vector<Vec2> outlines;
  std::vector<PlaneFrame> frames;
  std::vector<FaceOrder> faceOrders;  // of fine meshes, where patches hold many of their faces

  ElementId sceneRoot;              // receivers and reflecting senders; invalid in an empty scene
  std::vector<ElementId> grown;     // more such roots, of sides that edits brought into the light
  ElementId lightRoot;              // area emitters and points; invalid when there are none
  std::vector<ElementId> distant;   // suns and dome roots
  std::vector<ElementId> inactive;  // input-level patches that edits have left in the dark: blockers for now; ascending
  Box sceneBox;                     // of all surfaces; the far boxes of distant elements are measured from it
  // These follow from the others:
  std::vector<ElementId> inputs;     // all of the input level: patches, points and distant roots
  SideTable<ElementId> sides;        // the lowest patch of a scene tree that holds all of a side
  ContactLines contacts;             // where patches are split besides in their middle
  std::vector<std::uint8_t> folded;  // by element: parts that it would have again, of patches that are folded

  std::size_t size() const { return topology.size(); }
  /// Appends `count` contiguous elements as the children of `parent` (none: invalid); returns the first.
  ElementId addChildren(ElementId parent, ElementKind kind, std::size_t count);

  ClusterLight& cluster(ElementId e) { return clusters[slot[e.index()]]; }
  const ClusterLight& cluster(ElementId e) const { return clusters[slot[e.index()]]; }
  const ElementTopology& at(ElementId e) const { return topology[e.index()]; }
  const ElementGeometry& shape(ElementId e) const { return geometry[e.index()]; }
  bool isCluster(ElementId e) const { return at(e).kind == ElementKind::Cluster; }
  bool isPatch(ElementId e) const { return at(e).kind == ElementKind::Patch; }
  bool isDistant(ElementId e) const { return at(e).kind == ElementKind::Distant; }
  bool isPoint(ElementId e) const { return at(e).kind == ElementKind::Point; }
  bool isLeaf(ElementId e) const { return at(e).childCount == 0; }
  /// Takes diffuse light: a patch, of surfaces that are not lamps or glass.
  bool receives(ElementId e) const { return isPatch(e) && !at(e).emitter && !at(e).blocker; }
  bool isReceivingLeaf(ElementId e) const { return receives(e) && isLeaf(e); }
  /// Lists `inputs` and `sides` anew.
  void listInputs();
  /// Lists the sides of inputs from this one on.
  void listSides(std::size_t firstInput);
  /// Of patches that hold many faces.
  bool hasFaces(ElementId e) const { return domain[e.index()].order > 0; }
  FaceRange facesOf(ElementId e) const { return {domain[e.index()].outline, domain[e.index()].outlineSize}; }
  const FaceOrder& orderOf(ElementId e) const { return faceOrders[domain[e.index()].order - 1]; }
  /// A patch now holds all of the sides in it.
  void holdSides(ElementId patch);

  /// Of a patch: the side of its input-level surface; of many faces the first.
  Side sideOf(ElementId e) const {
    const PatchDomain& d = domain[e.index()];
    return {d.primitive, d.triangle, at(e).front};
  }
  /// The lowest element that holds all of a side: of the input level, but on fine meshes; invalid when light does not
  /// reach it, when it is glass, or was removed.
  ElementId side(PrimitiveId primitive, std::uint32_t triangle, bool front) const {
    const ElementId e = sides.at({primitive, triangle, front});
    return e.valid() && receives(e) ? e : ElementId();
  }
  bool isInputLevel(ElementId e) const { return isPatch(e) && at(e).depth == 0; }
  ElementId child(ElementId e, std::size_t i) const {
    return ElementId(at(e).firstChild.value + static_cast<std::uint32_t>(i));
  }
  Box box(ElementId e) const { return {Vec3(shape(e).lower), Vec3(shape(e).upper)}; }
  std::span<const Vec2> outline(ElementId e) const {
    const PatchDomain& d = domain[e.index()];
    return {outlines.data() + d.outline, d.outlineSize};
  }
  /// sceneRoot and what has grown since.
  std::vector<ElementId> sceneRoots() const;
  std::size_t memoryBytes() const;
};

/// Recounts the hierarchy: parents and children agree, child areas sum to the parent's, boxes hold their children, node
/// weights sum to one. Throws std::logic_error with the first violation.
void validate(const Elements&);

}  // namespace deltalux::hierarchy
