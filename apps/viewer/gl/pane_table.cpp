#include "gl/pane_table.hpp"

namespace deltalux::viewer::gl {

namespace {
constexpr int kAngles = 64;  // cosines from 0 to 1

Rgb passesAt(const Material& m, double cosine) {
  if (const auto* body = std::get_if<Dielectric>(&m.surface))
    return Rgb(static_cast<float>(1 - fresnelDielectric(cosine, double(body->ior))));
  return straightTransmittance(m, std::max(cosine, 1e-3));
}
}  // namespace

bool isSeenThrough(const Material& m) { return passesStraight(m) || std::holds_alternative<Dielectric>(m.surface); }

void PaneTable::update(const Scene& scene, std::uint64_t& uploaded) {
  rows_.assign(scene.materials.size(), 0);
  std::vector<glm::vec4> texels(kAngles, glm::vec4(0.0f));
  for (std::size_t m = 0; m < scene.materials.size(); ++m) {
    if (!isSeenThrough(scene.materials[m])) continue;
    rows_[m] = static_cast<int>(texels.size()) / kAngles;
    for (int i = 0; i < kAngles; ++i)
      texels.emplace_back(passesAt(scene.materials[m], static_cast<double>(i) / (kAngles - 1)), 1.0f);
  }
  if (texels == texels_) return;
  texels_ = std::move(texels);
  texture_.assign(kRgba32F, kAngles, static_cast<int>(texels_.size()) / kAngles, texels_.data(), uploaded);
  texture_.setFilter(GL_LINEAR, GL_LINEAR);
}

}  // namespace deltalux::viewer::gl
