#include "render/solution_mesh/side_light.hpp"

#include <algorithm>
#include <optional>

#include "base/parallel.hpp"
#include "hierarchy/tuning.hpp"
#include "scene/light_sampling.hpp"

namespace deltalux::rendering {

namespace {

constexpr std::size_t kReadBlock = 256;          // [task]
constexpr std::uint32_t kNowhere = 0xffffffffu;  // [sentinel]

std::vector<char> tornParts(const SideShape& shape, const IrradianceField& field) {
  std::vector<char> torn;
  torn.reserve(shape.parts.size());
  for (const SideShape::Part& part : shape.parts) torn.push_back(part.leaf.valid() && field.torn(part.leaf));
  return torn;
}

/// Lays out the vertices of a side.
class SideLayout {
 public:
  SideLayout(const SideShape& shape, const Reconstruction& reconstruction, SurfaceMesh& to)
      : shape_(shape), reconstruction_(reconstruction), to_(to) {
    to_.triangles.reserve(shape.triangles.size()), to_.outlines.reserve(shape.outlines.size());
    to_.vertices.reserve(shape.points.size()), places_.reserve(shape.points.size());
    lit_.assign(shape.points.size(), kNowhere);
  }

  SideReading layOut() {
    SideReading reading;
    reading.torn = tornParts(shape_, reconstruction_.field);
    for (std::size_t i = 0; i < shape_.parts.size(); ++i) {
      const SideShape::Part& part = shape_.parts[i];
      if (!part.leaf.valid()) {
        if (dark_.empty()) dark_.assign(shape_.points.size(), kNowhere);
        add(part, dark_);
      } else if (!reading.torn[i]) {
        add(part, lit_);
      } else {
        if (own_.empty()) own_.assign(shape_.points.size(), kNowhere);
        const std::size_t first = to_.vertices.size();
        add(part, own_);
        pullInside(part.leaf, first);
        for (std::uint32_t k = part.triangles; k < part.trianglesEnd; ++k) own_[shape_.triangles[k]] = kNowhere;
        for (std::uint32_t k = part.outlines; k < part.outlinesEnd; ++k) own_[shape_.outlines[k]] = kNowhere;
      }
    }
    reading.places = std::move(places_);
    return reading;
  }

 private:
  void add(const SideShape::Part& part, std::vector<std::uint32_t>& vertexOf) {
    const auto vertexAt = [&](std::uint32_t point) {
      if (vertexOf[point] == kNowhere) {
        vertexOf[point] = static_cast<std::uint32_t>(to_.vertices.size());
        to_.vertices.push_back(shape_.points[point]);
        places_.push_back({part.leaf, placeOf(shape_.points[point].position)});
      }
      return vertexOf[point];
    };
    for (std::uint32_t i = part.triangles; i < part.trianglesEnd; ++i)
      to_.triangles.push_back(vertexAt(shape_.triangles[i]));
    for (std::uint32_t i = part.outlines; i < part.outlinesEnd; ++i)
      to_.outlines.push_back(vertexAt(shape_.outlines[i]));
  }

  Vec3f placeOf(const Vec3f& p) const { return shape_.lag ? Vec3f(*shape_.lag * glm::dvec4(Vec3(p), 1)) : p; }

  void pullInside(hierarchy::ElementId, std::size_t first) {
    Vec3f middle(0.0f);
    for (std::size_t i = first; i < places_.size(); ++i) middle += places_[i].position;
    middle /= static_cast<float>(std::max<std::size_t>(places_.size() - first, 1));
    for (std::size_t i = first; i < places_.size(); ++i)
      places_[i].position = glm::mix(places_[i].position, middle, static_cast<float>(hierarchy::tuning::kTouching));
  }

  const SideShape& shape_;
  const Reconstruction& reconstruction_;
  SurfaceMesh& to_;
  std::vector<SideReading::Place> places_;
  std::vector<std::uint32_t> lit_, dark_, own_;  // by point: its vertex
};

Rgb radianceAlongNormal(const Scene& scene, const scene::LightSampler& lights, const SideShape& shape) {
  const Material& material = scene.materialOf(shape.primitive);
  if (!material.emission || shape.points.empty()) return Rgb(0.0f);
  const Vec3 direction(shape.points.front().normal);
  const double far = 1e3 * bounds(scene[shape.primitive].shape).diagonal();  // spots look brighter from further away
  const LightId light = lights.lightOf(shape.primitive);
  return light.valid() ? lights.emittedRadiance(light, direction, far, shape.front)
                       : scene::seenRadiance(material, direction, far, shape.front);
}

/// Sets what does not depend on the place.
void setLook(SurfaceMesh& side, const SideShape& shape, const Scene& scene, const Reconstruction& reconstruction) {
  side.primitive = shape.primitive, side.front = shape.front;
  const Material& material = scene.materialOf(shape.primitive);
  side.albedo = diffuseReflectance(material, shape.front);
  side.transmittance = diffuseTransmittance(material);
  side.radiance = radianceAlongNormal(scene, reconstruction.lights(), shape);
}

/// Reads the light of a side where it has changed after field number `since`; nullopt: all of it.
void readLight(SurfaceMesh& side, const SideReading& reading, const IrradianceField& field,
               std::optional<std::uint64_t> since) {
  parallelFor(reading.places.size(), kReadBlock, [&](std::size_t i) {
    const SideReading::Place& place = reading.places[i];
    if (!place.leaf.valid() || (since && field.changedIn(place.leaf) <= *since)) return;
    MeshVertex& v = side.vertices[i];
    const PointIrradiance E = field.all({place.leaf, Vec2(v.uv)}, place.position);
    v.direct = E.direct, v.indirect = E.indirect, v.particle = E.particle;
  });
}

}  // namespace

bool SideReading::holds(const SideShape& shape, const IrradianceField& field) const {
  return torn == tornParts(shape, field);
}

SurfaceMesh litSide(const SideShape& shape, const Scene& scene, const Reconstruction& reconstruction,
                    const SurfaceMesh* before, std::uint64_t generation, SideReading& reading) {
  SurfaceMesh side;
  setLook(side, shape, scene, reconstruction);
  reading = SideLayout(shape, reconstruction, side).layOut();
  const bool same = before && sameShape(side, *before);
  if (same) side.vertices = before->vertices;
  readLight(side, reading, reconstruction.field, same ? std::optional(generation) : std::nullopt);
  return side;
}

SurfaceMesh litAgain(const SurfaceMesh& before, const SideReading& reading, const SideShape& shape, const Scene& scene,
                     const Reconstruction& reconstruction, std::uint64_t generation) {
  SurfaceMesh side = before;
  setLook(side, shape, scene, reconstruction);
  readLight(side, reading, reconstruction.field, generation);
  return side;
}

bool isStillLit(const SideShape& shape, const Scene& scene, const Reconstruction& reconstruction,
                const SurfaceMesh& before, std::uint64_t generation) {
  SurfaceMesh now;
  setLook(now, shape, scene, reconstruction);
  return now.albedo == before.albedo && now.transmittance == before.transmittance && now.radiance == before.radiance &&
         std::none_of(shape.parts.begin(), shape.parts.end(), [&](const SideShape::Part& part) {
           return part.leaf.valid() && reconstruction.field.changedIn(part.leaf) > generation;
         });
}

bool sameShape(const SurfaceMesh& a, const SurfaceMesh& b) {
  return a.triangles == b.triangles && a.outlines == b.outlines &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](const MeshVertex& v, const MeshVertex& w) {
                      return v.position == w.position && v.normal == w.normal && v.uv == w.uv;
                    });
}

bool sameLight(const SurfaceMesh& a, const SurfaceMesh& b) {
  return a.albedo == b.albedo && a.transmittance == b.transmittance && a.radiance == b.radiance &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(), b.vertices.end(),
                    [](const MeshVertex& v, const MeshVertex& w) {
                      return v.direct == w.direct && v.indirect == w.indirect && v.particle == w.particle;
                    });
}

}  // namespace deltalux::rendering
