#include "gl/background.hpp"

#include <cmath>

#include "gl/shaders.hpp"

namespace deltalux::viewer::gl {

namespace {
constexpr int kSkyWidth = 512, kSkyHeight = 256;  // of the table: 0.7 degrees a texel
constexpr std::size_t kMostSuns = 8;              // as the shader has room for
}  // namespace

Background::Background() : program_("", shaders::kScreenVertex, shaders::kBackgroundFragment, {"colour"}) {}

std::uint64_t Background::update(const Scene& scene) {
  std::vector<Dome> domes;
  suns_.clear();
  for (const Light& light : scene.lights) {
    if (const auto* dome = std::get_if<DomeLight>(&light.emitter)) domes.push_back({*dome, light.scale});
    const auto* sun = std::get_if<SunLight>(&light.emitter);
    if (!sun || suns_.size() == kMostSuns) continue;
    suns_.push_back({glm::vec4(sun->direction, 2 * std::sin(sun->angularRadius / 2)), sun->radiance * light.scale});
  }
  for (const DomeLight& dome : scene.backdrops) domes.push_back({dome, Rgb(1.0f)});
  std::uint64_t uploaded = 0;
  if (domes == domes_ && sky_.get()) return uploaded;
  domes_ = std::move(domes);
  const int width = domes_.empty() ? 1 : kSkyWidth, height = domes_.empty() ? 1 : kSkyHeight;
  std::vector<Rgb> texels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const double azimuth = 2 * kPi * ((x + 0.5) / width - 0.5), polar = kPi * (y + 0.5) / height;
      const Vec3 w(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth), std::cos(polar));
      Rgb L(0.0f);
      for (const Dome& dome : domes_) L += dome.scale * skyRadiance(dome.light, w);
      texels.push_back(L);
    }
  sky_.assign(kRgb32F, width, height, texels.data(), uploaded);
  sky_.setFilter(GL_LINEAR, GL_LINEAR);
  sky_.setWrap(GL_REPEAT, GL_CLAMP_TO_EDGE);
  return uploaded;
}

void Background::draw(const Eye& eye, int width, int height) {
  if (dark()) return;
  program_.use();
  const double w = eye.parallel ? 0 : eye.halfWidth, h = eye.parallel ? 0 : eye.halfHeight;
  const glm::vec3 corner(eye.forward - w * eye.right + h * eye.up);
  const glm::vec3 across(2 * w / width * eye.right), down(-2 * h / height * eye.up);
  glUniform3fv(program_.at("corner"), 1, &corner[0]);
  glUniform3fv(program_.at("across"), 1, &across[0]);
  glUniform3fv(program_.at("down"), 1, &down[0]);
  glUniform1i(program_.at("sky"), 0);
  glUniform1i(program_.at("suns"), static_cast<GLint>(suns_.size()));
  for (std::size_t i = 0; i < suns_.size(); ++i) {
    const std::string place = "[" + std::to_string(i) + "]";
    glUniform4fv(program_.at(("sunDirection" + place).c_str()), 1, &suns_[i].directionAndChord[0]);
    glUniform3fv(program_.at(("sunRadiance" + place).c_str()), 1, &suns_[i].radiance[0]);
  }
  bindTexture(0, GL_TEXTURE_2D, sky_.name());
  const GLenum colour = GL_COLOR_ATTACHMENT0;
  glDrawBuffers(1, &colour);
  glDepthMask(GL_FALSE);
  glBindVertexArray(none_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

}  // namespace deltalux::viewer::gl
