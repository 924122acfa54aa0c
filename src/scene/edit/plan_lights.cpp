#include <cmath>

#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

namespace {

void requireScale(const Rgb& scale) {
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(scale[c]) || scale[c] < 0) refuse("a light's scale is a number that is not negative");
}

/// One state for every light of the name that is still there.
template <class Change>
Plan changed(const Scene& scene, const std::string& name, const Change& change) {
  Plan result;
  for (const LightId light : lightsNamed(scene, name)) {
    if (isDark(scene[light])) continue;
    Restore::LightState state = stateOf(scene, light);
    change(state);
    result.target.lights.push_back(std::move(state));
  }
  if (result.target.lights.empty()) refuse("the light '" + name + "' was removed");
  return result;
}

/// The scale that counts: the one that waits, while the light is off.
Rgb& scaleOf(Restore::LightState& state) { return state.offScale ? *state.offScale : state.value.scale; }

/// The least rotation from one unit direction to another.
glm::dmat3 leastTurn(const Vec3& from, const Vec3& to) {
  const double cosine = glm::dot(from, to);
  if (cosine < -1 + 1e-12) {
    const Vec3 across = Frame(from).tangent;  // half a turn about any axis across
    return glm::outerProduct(2.0 * across, across) - glm::dmat3(1.0);
  }
  const Vec3 v = glm::cross(from, to);
  const glm::dmat3 cross({0, v.z, -v.y}, {-v.z, 0, v.x}, {v.y, -v.x, 0});
  return glm::dmat3(1.0) + cross + cross * cross / (1 + cosine);
}

void aimArea(Plan& plan, const Scene& scene, const Light& light, const Vec3& direction) {
  const PrimitiveId primitive = std::get<AreaLight>(light.emitter).primitive;
  Material own = scene.materialOf(primitive);
  if (!own.emission || !own.emission->spot)
    refuse("the light '" + light.name + "' shines from a surface without a spot cone: it has no aim",
           "turn the surface's object instead");
  Vec3& axis = own.emission->spot->direction;
  axis = glm::length(axis) * direction;
  Restore::PrimitiveState state = stateOf(scene, primitive);
  state.material = MaterialId(scene.materials.size() + plan.materials.size());
  plan.materials.push_back(std::move(own));
  plan.target.primitives.push_back(state);
}

void aim(Light& light, const Vec3& direction) {
  if (auto* measured = std::get_if<PhotometricLight>(&light.emitter)) {
    measured->frame = leastTurn(-measured->frame[2], direction) * measured->frame;
  } else if (auto* sun = std::get_if<SunLight>(&light.emitter)) {
    sun->direction = -direction;
  } else if (auto* spot = std::get_if<SpotLight>(&light.emitter)) {
    spot->direction = direction;
  } else if (auto* lambert = std::get_if<LambertPointLight>(&light.emitter)) {
    lambert->direction = direction;
  } else {
    refuse("the light '" + light.name + "' has no aim");
  }
}

}  // namespace

Plan plan(const Scene& scene, const ScaleLight& edit) {
  requireScale(Rgb(edit.factor));
  return changed(scene, edit.light, [&](Restore::LightState& s) {
    scaleOf(s) *= edit.factor;
    requireScale(scaleOf(s));
  });
}

Plan plan(const Scene& scene, const ColourLight& edit) {
  requireScale(edit.rgb);
  return changed(scene, edit.light, [&](Restore::LightState& s) { scaleOf(s) = edit.rgb; });
}

Plan plan(const Scene& scene, const SwitchLight& edit) {
  return changed(scene, edit.light, [&](Restore::LightState& s) {
    if (edit.on && s.offScale) s.value.scale = *s.offScale, s.offScale.reset();
    if (!edit.on && !s.offScale) s.offScale = s.value.scale, s.value.scale = Rgb(0.0f);
  });
}

Plan plan(const Scene& scene, const AimLight& edit) {
  const double length = glm::length(edit.direction);
  if (!std::isfinite(length) || !(length > 0)) refuse("an aim is a direction of some length");
  const Vec3 direction = edit.direction / length;
  Plan surfaces;
  Plan result = changed(scene, edit.light, [&](Restore::LightState& s) {
    if (std::holds_alternative<AreaLight>(s.value.emitter))
      aimArea(surfaces, scene, s.value, direction);
    else
      aim(s.value, direction);
  });
  result.materials = std::move(surfaces.materials);
  result.target.primitives = std::move(surfaces.target.primitives);
  return result;
}

Plan plan(const Scene& scene, const MoveLight& edit) {
  if (!std::isfinite(glm::length(edit.offset))) refuse("a move is three finite numbers");
  Mat4 matrix(1.0);
  matrix[3] = glm::dvec4(edit.offset, 1);
  Plan surfaces;
  Plan result = changed(scene, edit.light, [&](Restore::LightState& s) {
    if (const auto* area = std::get_if<AreaLight>(&s.value.emitter))
      planMove(surfaces, scene, area->primitive, matrix);
    else if (std::visit(
                 [](const auto& e) {
                   return requires { e.position; };
                 },
                 s.value.emitter))
      s.value = movedLight(s.value, matrix);
    else
      refuse("the light '" + s.value.name + "' is at infinity: it cannot be moved");
  });
  result.target.primitives = std::move(surfaces.target.primitives);
  return result;
}

}  // namespace deltalux::scene::edits
