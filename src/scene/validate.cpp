#include <cmath>
#include <deltalux/scene.hpp>
#include <stdexcept>

namespace deltalux {

namespace {

template <class... Ts>
struct Overloaded : Ts... {
  using Ts::operator()...;
};
template <class... Ts>
Overloaded(Ts...) -> Overloaded<Ts...>;  // Clang 14 does not yet deduce aggregates

void require(bool holds, const std::string& what) {
  if (!holds) throw std::logic_error("scene: " + what);
}

bool finite(double x) { return std::isfinite(x); }
template <int n, class T>
bool finite(const glm::vec<n, T>& v) {
  for (int i = 0; i < n; ++i) {
    if (!std::isfinite(v[i])) return false;
  }
  return true;
}
bool unit(const Vec3& v) { return std::abs(glm::length(v) - 1) < 1e-6; }
bool nonNegative(const Rgb& c) { return finite(c) && c.r >= 0 && c.g >= 0 && c.b >= 0; }
bool fraction(const Rgb& c) { return nonNegative(c) && maxChannel(c) <= 1.0f + 1e-5f; }

void checkTriangles(const std::vector<std::array<std::uint32_t, 3>>& triangles, std::size_t vertexCount,
                    const std::string& where) {
  for (const auto& triangle : triangles) {
    for (const std::uint32_t corner : triangle) require(corner < vertexCount, where + ": triangle corner out of range");
  }
}

void checkShape(const Shape& shape, const std::string& where) {
  const auto radius = [&](double r, bool zeroAllowed) {
    require(finite(r) && (r > 0 || (zeroAllowed && r == 0)), where + ": radius");
  };
  const auto axis = [&](const Vec3& p0, const Vec3& p1) {
    require(finite(p0) && finite(p1) && p0 != p1, where + ": axis");
  };
  std::visit(Overloaded{
                 [&](const Polygon& s) {
                   require(s.vertices.size() >= 3 && !s.triangles.empty(), where + ": polygon without triangles");
                   for (const Vec3& v : s.vertices) require(finite(v), where + ": vertex");
                   require(unit(s.normal) && finite(s.area) && s.area > 0, where + ": polygon's plane");
                   checkTriangles(s.triangles, s.vertices.size(), where);
                 },
                 [&](const Sphere& s) { radius(s.radius, false), require(finite(s.center), where + ": centre"); },
                 [&](const Cylinder& s) { radius(s.radius, false), axis(s.p0, s.p1); },
                 [&](const Cone& s) {
                   radius(s.radius0, true), radius(s.radius1, true), axis(s.p0, s.p1);
                   require(s.radius0 > 0 || s.radius1 > 0, where + ": cone without area");
                 },
                 [&](const Ring& s) {
                   radius(s.innerRadius, true), radius(s.outerRadius, false);
                   require(s.innerRadius < s.outerRadius && unit(s.normal) && finite(s.center), where + ": ring");
                 },
                 [&](const Mesh& s) {
                   for (const Vec3& v : s.positions) require(finite(v), where + ": vertex");
                   require(s.normals.empty() || s.normals.size() == s.positions.size(), where + ": mesh normals");
                   require(s.texcoords.empty() || s.texcoords.size() == s.positions.size(), where + ": texcoords");
                   checkTriangles(s.triangles, s.positions.size(), where);
                 },
             },
             shape);
}

void checkLobe(const SpecularLobe& lobe, const std::string& where) {
  require(fraction(lobe.reflectance), where + ": lobe's reflectance");
  require(finite(lobe.roughness) && lobe.roughness >= 0, where + ": roughness");
}

void checkMaterial(const Scene& scene, const Material& material, const std::string& where) {
  std::visit(Overloaded{
                 [&](const Opaque& s) {
                   require(fraction(s.diffuse), where + ": diffuse reflectance");
                   require(fraction(s.diffuse + s.specular.reflectance) || s.diffuseTexture.valid(),
                           where + ": reflects more than it receives");
                   checkLobe(s.specular, where);
                   require(!s.diffuseTexture.valid() || s.diffuseTexture.index() < scene.textures.size(),
                           where + ": texture");
                 },
                 [&](const Mirror& s) { require(fraction(s.reflectance), where + ": reflectance"); },
                 [&](const ThinGlass& s) {
                   require(fraction(s.transmissivity) && finite(s.ior) && s.ior > 0, where + ": glass");
                 },
                 [&](const Dielectric& s) {
                   require(fraction(s.transmission) && finite(s.ior) && s.ior > 0, where + ": dielectric");
                 },
                 [&](const Trans& s) {
                   require(fraction(s.diffuseReflectance + s.diffuseTransmittance + s.reflection.reflectance +
                                    s.transmission.reflectance),
                           where + ": reflects and transmits more than it receives");
                   require(nonNegative(s.diffuseReflectance) && nonNegative(s.diffuseTransmittance),
                           where + ": diffuse parts");
                   checkLobe(s.reflection, where), checkLobe(s.transmission, where);
                 },
             },
             material.surface);
  if (!material.emission) return;
  require(nonNegative(material.emission->radiance), where + ": emitted radiance");
  if (!material.emission->spot) return;
  const SpotCone& cone = *material.emission->spot;
  require(finite(cone.fullAngle) && cone.fullAngle > 0 && finite(cone.direction) && cone.direction != Vec3(0),
          where + ": spot cone");
}

void checkDome(const DomeLight& l, const std::string& where) {
  require(unit(l.axis) && unit(l.up) && nonNegative(l.scale) && l.halfAngle > 0 && l.halfAngle <= kPi,
          where + ": dome");
  if (const auto* sky = std::get_if<CieSky>(&l.distribution)) {
    require(sky->type >= 1 && sky->type <= 15 && unit(sky->sunDirection), where + ": CIE sky");
  }
}

void checkLight(const Scene& scene, const Light& light, const std::string& where) {
  const auto sender = [&](const Vec3& position, const Rgb& intensity) {
    require(finite(position) && nonNegative(intensity), where + ": position or intensity");
  };
  std::visit(Overloaded{
                 [&](const AreaLight& l) {
                   require(l.primitive.index() < scene.primitives.size(), where + ": primitive out of range");
                   require(sendsLight(scene.materialOf(l.primitive)), where + ": its primitive sends no light");
                 },
                 [&](const PointLight& l) { sender(l.position, l.intensity); },
                 [&](const SpotLight& l) {
                   sender(l.position, l.intensity), require(unit(l.direction), where + ": direction");
                   require(l.cosInner >= l.cosOuter, where + ": cone");
                 },
                 [&](const LambertPointLight& l) {
                   sender(l.position, l.intensity), require(unit(l.direction), where + ": direction");
                 },
                 [&](const PhotometricLight& l) {
                   sender(l.position, l.scale), require(l.photometry != nullptr, where + ": no photometry");
                   const Photometry& p = *l.photometry;
                   require(p.candela.size() == p.verticals.size() * p.horizontals.size() && !p.candela.empty(),
                           where + ": photometry's table");
                 },
                 [&](const SunLight& l) {
                   require(unit(l.direction) && nonNegative(l.radiance) && finite(l.angularRadius) &&
                               l.angularRadius > 0 && l.angularRadius <= kPi,
                           where + ": sun");
                 },
                 [&](const DomeLight& l) { checkDome(l, where); },
             },
             light.emitter);
  require(nonNegative(light.scale), where + ": scale");
}

void checkObjects(const Scene& scene) {
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    ObjectId object(i);
    for (std::size_t steps = 0; object.valid(); ++steps) {
      require(object.index() < scene.objects.size(), "object " + scene.objects[i].name + ": parent out of range");
      require(steps <= scene.objects.size(), "object " + scene.objects[i].name + ": is its own ancestor");
      object = scene[object].parent;
    }
  }
}

}  // namespace

void validate(const Scene& scene) {
  require(finite(scene.metresPerUnit) && scene.metresPerUnit > 0, "metres per unit");
  require(finite(scene.origin), "origin");
  require(finite(scene.luminousEfficacy) && scene.luminousEfficacy > 0, "luminous efficacy");
  require(unit(scene.up), "up direction");
  checkObjects(scene);
  for (const Texture& texture : scene.textures) {
    require(texture.width > 0 && texture.height > 0 &&
                texture.texels.size() == static_cast<std::size_t>(texture.width) * texture.height,
            "texture " + texture.name + ": size");
  }
  for (const Material& material : scene.materials) checkMaterial(scene, material, "material " + material.name);
  for (std::size_t i = 0; i < scene.primitives.size(); ++i) {
    const Primitive& primitive = scene.primitives[i];
    const std::string where = "primitive " + std::to_string(i);
    require(primitive.material.index() < scene.materials.size(), where + ": material out of range");
    require(!primitive.object.valid() || primitive.object.index() < scene.objects.size(), where + ": object");
    checkShape(primitive.shape, where);
  }
  for (const Light& light : scene.lights) checkLight(scene, light, "light " + light.name);
  for (const DomeLight& dome : scene.backdrops) checkDome(dome, "backdrop");
  for (std::size_t i = 0; i < scene.placements.size(); ++i) {
    const Placement& p = scene.placements[i];
    require(p.primitive.index() < scene.primitives.size(), "placement: primitive out of range");
    require(i == 0 || scene.placements[i - 1].primitive < p.primitive, "placements: ascending");
    checkShape(p.rest, "rest shape of primitive " + std::to_string(p.primitive.value));
    require((area(scene[p.primitive].shape) > 0) == p.present, "placement: removed things have no extent");
  }
  for (const SwitchedOff& s : scene.switchedOff)
    require(s.light.index() < scene.lights.size() && isBlack(scene[s.light].scale) && nonNegative(s.scale),
            "a light that is switched off");
  for (const View& view : scene.views) {
    require(finite(view.position) && finite(view.direction) && finite(view.up), "view " + view.name);
    require(glm::length(glm::cross(view.direction, view.up)) > 0, "view " + view.name + ": up is along its direction");
    require(finite(view.horizontal) && view.horizontal > 0 && finite(view.vertical) && view.vertical > 0,
            "view " + view.name + ": angles");
  }
}

}  // namespace deltalux
