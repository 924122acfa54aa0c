#include "lines/surface_responses.hpp"

#include <algorithm>

#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

SurfaceResponse responseOf(const Material& material, bool front, bool speculars) {
  const scene::Bsdf all = scene::makeBsdf(material, front);
  SurfaceResponse r;
  r.specular = scene::withoutPassage(scene::specularPart(all));
  r.pane = all.pane.has_value();
  r.body = std::get_if<Dielectric>(&material.surface);
  r.passage = all.passage;
  if (r.pane) {
    // Passage and reflection depend on the angle.
    r.specular = scene::specularPart(all);
    r.specular.paneReflects = speculars;
    r.ends = 0;
    return r;
  }
  if (r.body) {
    r.ends = 0;
    return r;
  }
  const float diffuse = gray(all.diffuseReflection + all.diffuseTransmission);
  const float specular = speculars ? gray(all.reflection.reflectance + all.transmission.reflectance) : 0.0f;
  const float passes = gray(all.passage), sum = diffuse + specular + passes;
  // A surface that sends nothing on ends every line: it shows what it gets.
  r.ends = sum > 0 ? diffuse / sum : 1.0f;
  if (diffuse > 0) r.ends = std::max(r.ends, tuning::kLeastEnding);
  r.passes = sum > 0 ? (1 - r.ends) * passes / std::max(passes + specular, 1e-30f) : 0.0f;
  return r;
}

}  // namespace

SurfaceResponses::SurfaceResponses(const Scene& scene, bool speculars) : scene_(scene), speculars_(speculars) {
  for (const Material& m : scene.materials)
    for (const bool front : {false, true}) all_.push_back(responseOf(m, front, speculars));
}

std::vector<char> SurfaceResponses::plain() const {
  std::vector<char> plain(all_.size() / 2);
  for (std::size_t m = 0; m < plain.size(); ++m) plain[m] = all_[2 * m].ends >= 1 && all_[2 * m + 1].ends >= 1;
  return plain;
}

}  // namespace deltalux::lines
