#include "scene/edit/plan.hpp"

namespace deltalux::scene::edits {

namespace {

/// Gives the first light of a kind another emitter and darkens the others; one more where there is none.
template <class Emitter>
void replaceFirst(Plan& result, const Scene& scene, const char* name, const Emitter& emitter, const Emitter& black) {
  bool found = false;
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (!std::holds_alternative<Emitter>(scene.lights[i].emitter)) continue;
    Restore::LightState state = stateOf(scene, LightId(i));
    state.value.emitter = found ? black : emitter;
    found = true;
    result.target.lights.push_back(std::move(state));
  }
  if (found) return;
  const LightId id(scene.lights.size() + result.lights.size());
  result.lights.push_back({name, black, Rgb(1.0f)});
  result.target.lights.push_back({id, {name, emitter, Rgb(1.0f)}, std::nullopt});
}

}  // namespace

Plan plan(const Scene& scene, const SetDaylight& edit) {
  const auto* general = std::get_if<GeneralSky>(&edit.daylight.sky);
  if (general && (general->type < 1 || general->type > 15)) refuse("CIE skies are of the types 1 to 15");
  if (!(edit.daylight.groundReflectance >= 0 && edit.daylight.groundReflectance <= 1))
    refuse("the reflectance of the ground is not from 0 to 1");
  const SunAndSky lights = sunAndSky(edit.daylight, scene.up, scene.luminousEfficacy);
  SunLight noSun = lights.sun;
  noSun.radiance = Rgb(0.0f);
  DomeLight noSky;
  noSky.axis = noSky.up = lights.sky.up, noSky.scale = Rgb(0.0f);
  Plan result;
  replaceFirst(result, scene, "sun", lights.sun, noSun);
  replaceFirst(result, scene, "sky", lights.sky, noSky);
  return result;
}

}  // namespace deltalux::scene::edits
