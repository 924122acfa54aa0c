#include "scene_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace deltalux::cli {

namespace {
std::string text(const Rgb& c) { return fmt::format("{:.4g} {:.4g} {:.4g}", c.r, c.g, c.b); }
std::string placeText(const Scene& scene, const Vec3& p) {
  if (scene.origin == Vec3(0)) return fmt::format("{:.6g} {:.6g} {:.6g}", p.x, p.y, p.z);
  const Vec3 v = p + scene.origin;  // of many digits the last ones matter
  return fmt::format("{:.12g} {:.12g} {:.12g}", v.x, v.y, v.z);
}
std::string text(const Vec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z); }

template <class... Cases>
struct Overloaded : Cases... {
  using Cases::operator()...;
};
template <class... Cases>
Overloaded(Cases...) -> Overloaded<Cases...>;

std::string shapeName(const Shape& shape) {
  return std::visit(Overloaded{[](const Polygon&) { return "polygon"; },
                               [](const Sphere& s) { return s.inward ? "bubble" : "sphere"; },
                               [](const Cylinder& c) { return c.inward ? "tube" : "cylinder"; },
                               [](const Cone& c) { return c.inward ? "cup" : "cone"; },
                               [](const Ring&) { return "ring"; }, [](const Mesh&) { return "mesh"; }},
                    shape);
}

std::string lobeText(const char* name, const SpecularLobe& lobe) {
  if (isBlack(lobe.reflectance)) return "";
  return fmt::format(", {} {} roughness {:.3g}", name, text(lobe.reflectance), lobe.roughness);
}

std::string surfaceText(const Surface& surface) {
  return std::visit(
      Overloaded{[](const Opaque& m) {
                   return fmt::format("opaque, diffuse {}{}{}", text(m.diffuse),
                                      m.diffuseTexture.valid() ? " x texture" : "", lobeText("specular", m.specular));
                 },
                 [](const Mirror& m) { return fmt::format("mirror {}", text(m.reflectance)); },
                 [](const ThinGlass& m) {
                   return fmt::format("thin glass, transmissivity {}, ior {:.4g}", text(m.transmissivity), m.ior);
                 },
                 [](const Dielectric& m) {
                   return fmt::format("dielectric, transmission {} per unit, ior {:.4g}", text(m.transmission), m.ior);
                 },
                 [](const Trans& m) {
                   return fmt::format("trans, diffuse {} through {}{}{}", text(m.diffuseReflectance),
                                      text(m.diffuseTransmittance), lobeText("specular", m.reflection),
                                      lobeText("specular through", m.transmission));
                 }},
      surface);
}

std::string emissionText(const std::optional<Emission>& emission) {
  if (!emission) return "";
  return fmt::format(
      ", emits {} W/(sr m2){}{}{}", text(emission->radiance), emission->bothSides ? " on both sides" : "",
      emission->seenOnly ? ", seen only" : "",
      emission->spot ? fmt::format(" within {:.4g} degrees", emission->spot->fullAngle * 180 / kPi) : "");
}

std::string lightText(const Scene& scene, const Light& light) {
  const std::string kind = std::visit(
      Overloaded{[&](const AreaLight& a) {
                   const Primitive& primitive = scene[a.primitive];
                   return fmt::format("area, {} of {:.4g} square units, material {}", shapeName(primitive.shape),
                                      area(primitive.shape), scene[primitive.material].name);
                 },
                 [&](const PointLight& l) {
                   return fmt::format("point at {}, {} W/sr", placeText(scene, l.position), text(l.intensity));
                 },
                 [&](const SpotLight& l) {
                   return fmt::format("spot at {} towards {}, {} W/sr", placeText(scene, l.position), text(l.direction),
                                      text(l.intensity));
                 },
                 [&](const LambertPointLight& l) {
                   return fmt::format("Lambertian point at {}, {} W/sr", placeText(scene, l.position),
                                      text(l.intensity));
                 },
                 [&](const PhotometricLight& l) {
                   const auto& candela = l.photometry->candela;
                   return fmt::format("measured at {} aimed at {}, up to {:.4g} cd", placeText(scene, l.position),
                                      text(-l.frame[2]),
                                      candela.empty() ? 0.0 : *std::max_element(candela.begin(), candela.end()));
                 },
                 [](const SunLight& l) {
                   return fmt::format("sun from {}, {} W/(sr m2), {:.4g} W/m2 across the beam", text(l.direction),
                                      text(l.radiance), solidAngle(l) * gray(glm::dvec3(l.radiance)));
                 },
                 [](const DomeLight& l) {
                   return fmt::format("dome of half angle {:.4g} degrees about {}, scale {}", l.halfAngle * 180 / kPi,
                                      text(l.axis), text(l.scale));
                 }},
      light.emitter);
  return light.scale == Rgb(1.0f) ? kind : fmt::format("{}, scaled by {}", kind, text(light.scale));
}

std::string countsText(const std::map<std::string, std::size_t>& counts) {
  std::size_t total = 0;
  std::string parts;
  for (const auto& [name, count] : counts) {
    total += count;
    parts += fmt::format("{}{} {}", parts.empty() ? "" : ", ", count, name);
  }
  return parts.empty() ? "none" : fmt::format("{} ({})", total, parts);
}

std::map<std::string, std::size_t> primitiveCounts(const Scene& scene) {
  std::map<std::string, std::size_t> counts;
  for (const Primitive& primitive : scene.primitives) ++counts[shapeName(primitive.shape)];
  return counts;
}

std::string section(const std::string& title, const std::vector<std::string>& lines) {
  std::string result = fmt::format("\n{} ({})\n", title, lines.size());
  for (const std::string& line : lines) result += "  " + line + "\n";
  return result;
}

/// Objects that stand at the top of the tree of names, with what is below them.
std::vector<std::string> objectLines(const Scene& scene) {
  const auto rootOf = [&](ObjectId id) {
    while (scene[id].parent.valid()) id = scene[id].parent;
    return id.index();
  };
  std::vector<std::size_t> parts(scene.objects.size()), primitives(scene.objects.size());
  for (std::size_t i = 0; i < scene.objects.size(); ++i) ++parts[rootOf(ObjectId(i))];
  for (const Primitive& primitive : scene.primitives)
    if (primitive.object.valid()) ++primitives[rootOf(primitive.object)];

  std::vector<std::string> lines;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].parent.valid()) continue;
    const std::string below = parts[i] > 1 ? fmt::format(" in {} named parts", parts[i] - 1) : "";
    lines.push_back(fmt::format("{}: {} primitive{}{}", scene.objects[i].name, primitives[i],
                                primitives[i] == 1 ? "" : "s", below));
  }
  return lines;
}

std::vector<std::string> materialLines(const Scene& scene) {
  std::vector<std::string> lines;
  for (const Material& m : scene.materials)
    lines.push_back(fmt::format("{}: {}{}", m.name, surfaceText(m.surface), emissionText(m.emission)));
  return lines;
}

std::vector<std::string> lightLines(const Scene& scene) {
  std::vector<std::string> lines;
  for (const Light& light : scene.lights) lines.push_back(fmt::format("{}: {}", light.name, lightText(scene, light)));
  return lines;
}

std::vector<std::string> backdropLines(const Scene& scene) {
  std::vector<std::string> lines;
  for (const DomeLight& dome : scene.backdrops) lines.push_back(lightText(scene, {"", dome, Rgb(1.0f)}));
  return lines;
}

std::vector<std::string> viewLines(const Scene& scene) {
  std::vector<std::string> lines;
  for (const View& v : scene.views)
    lines.push_back(fmt::format("{}: from {} towards {}, {:.4g} x {:.4g}", v.name, placeText(scene, v.position),
                                text(v.direction), v.horizontal, v.vertical));
  return lines;
}
}  // namespace

std::string summarize(const ImportedScene& imported) {
  const Scene& scene = imported.scene;
  const Box box = bounds(scene);
  std::string result;
  if (!imported.report.surfaces.empty())
    result += fmt::format("surfaces read  {}\n", countsText(imported.report.surfaces));
  result += fmt::format("primitives     {}\n", countsText(primitiveCounts(scene)));
  result += fmt::format("ignored        {}\n", countsText(imported.report.ignored));
  result += fmt::format("unit           {:.6g} m, up is {}\n", scene.metresPerUnit, text(scene.up));
  if (!box.empty())
    result += fmt::format("bounds         {} to {}\n", placeText(scene, box.lower), placeText(scene, box.upper));
  if (scene.origin != Vec3(0))
    result += fmt::format("origin         {:.12g} {:.12g} {:.12g}\n", scene.origin.x, scene.origin.y, scene.origin.z);
  result += fmt::format("photometry     {:.4g} lm/W\n", scene.luminousEfficacy);
  result += section("Objects at the top", objectLines(scene));
  result += section("Materials", materialLines(scene));
  result += section("Lights", lightLines(scene));
  if (!scene.backdrops.empty()) result += section("Seen at infinity only", backdropLines(scene));
  result += section("Views", viewLines(scene));
  return result;
}

}  // namespace deltalux::cli
