#pragma once
// What input-level elements and clusters take from the scene: planes, extents, reflectances, emission. The builder sets
// them once, an edit again.
#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

/// The plane of a polygon or of a mesh's triangle; nothing for other shapes and for what is no more.
std::optional<PlaneFrame> planeOf(const Shape&, std::uint32_t triangle);
/// The outline of a surface that has a plane, in that.
std::vector<Vec2> outlineOf(const Shape&);
/// Gives a patch of a polygon or of a mesh's triangle, its domain set, its plane and outline.
void addPlane(Elements&, const Scene&, ElementId input);
/// rho, tau and whether it only blocks, from the material, of an input-level patch and all below it.
void setReflectance(Elements&, const Scene&, ElementId input);
/// Makes patches of sides that light no longer reaches inactive, as if they had no elements, or active again.
void setInactive(Elements&, const Scene&, std::span<const ElementId> inputs, bool inactive);
/// B of an emitter patch and all below it, of a point or of a distant element, from the light's present emission.
void setEmission(Elements&, const Scene&, ElementId emitter);
void shapePointLight(Elements&, const Scene&, ElementId point);
/// Extent of a cluster from its children: box, area, and four surface points at even steps of area.
void shapeCluster(Elements&, ElementId cluster);
/// The clusters above elements that have changed.
void shapeAbove(Elements&, std::span<const ElementId> changed);

/// Input-level patches of these primitives, emitters among them.
std::vector<ElementId> elementsOf(const Elements&, std::span<const PrimitiveId>);
/// Points, distant elements and input-level emitters of these lights.
std::vector<ElementId> elementsOf(const Elements&, std::span<const LightId>);
/// Brings elements of the scene and light trees, and all below and above them, to the scene's present shapes. A
/// primitive that is no more keeps its elements, without area.
void reshape(Elements&, const Scene&, std::span<const ElementId> inputs);

}  // namespace deltalux::hierarchy
