#include "gl/screen_pass.hpp"

#include <cmath>

#include "false_colour.hpp"
#include "gl/shaders.hpp"

namespace deltalux::viewer::gl {

namespace {
constexpr int kRampColours = 1024;

int scaleOf(const FalseColour& f) {
  if (hasBands(f)) return 2;
  return f.logarithmic ? 1 : 0;
}
std::string partOf(const DrawSettings& settings) {
  switch (settings.falseColour.quantity) {
    case Quantity::Illuminance:
      return "ILLUMINANCE";
    case Quantity::Luminance:
      return "LUMINANCE";
    case Quantity::Radiance:
      break;
  }
  return settings.tone.toneOperator == ToneOperator::Reinhard ? "TONE\n#define REINHARD" : "TONE";
}

void drawScreen(VertexArray& none) {
  glDisable(GL_DEPTH_TEST);
  glBindVertexArray(none.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glEnable(GL_DEPTH_TEST);
}
}  // namespace

ScreenPass::ScreenPass() {
  std::vector<glm::vec3> colours;
  for (int i = 0; i < kRampColours; ++i) colours.push_back(rampColour(static_cast<double>(i) / (kRampColours - 1)));
  std::uint64_t uploaded = 0;
  ramp_.assign(kRgb32F, kRampColours, 1, colours.data(), uploaded);
  ramp_.setFilter(GL_LINEAR, GL_LINEAR);
}

const Program& ScreenPass::use(const std::string& parts, Targets& t, Layers& layers, int wipe) {
  std::string defines = parts.empty() ? "" : "#define " + parts + "\n";
  if (layers.hasCache()) defines += "#define CACHE\n";
  if (layers.hasPicture()) defines += "#define PICTURE\n";
  Program& program = programs_[defines];
  if (!program) program = Program(defines, shaders::kScreenVertex, shaders::kScreenFragment, {"colour"});
  program.use();
  const auto bind = [&](int unit, const char* name, GLuint texture) {
    glUniform1i(program.at(name), unit);
    bindTexture(unit, GL_TEXTURE_2D, texture);
  };
  bind(0, "radiance", t.radiance.name());
  bind(1, "primitives", t.primitives.name());
  if (layers.hasCache()) bind(2, "cache", layers.cache());
  if (layers.hasPicture()) bind(3, "picture", layers.picture());
  glUniform1i(program.at("wipe"), wipe);
  return program;
}

std::uint64_t ScreenPass::draw(Targets& t, Layers& layers, const DrawSettings& settings, double luminousEfficacy,
                               int wipe) {
  std::uint64_t uploaded = 0;
  const FalseColour& f = settings.falseColour;
  if (f.quantity != Quantity::Radiance) {
    const std::vector<double> values = scaleLevels(f);
    const std::vector<float> levels(values.begin(), values.end());
    if (levels != levelValues_ && !levels.empty())
      levels_.assign(kR32F, static_cast<int>(levels.size()), 1, levels.data(), uploaded);
    levelValues_ = levels;
  }
  glBindFramebuffer(GL_FRAMEBUFFER, t.screen.name());
  const Program& show = use(partOf(settings), t, layers, wipe);
  const auto bind = [&](int unit, const char* name, GLuint texture) {
    glUniform1i(show.at(name), unit);
    bindTexture(unit, GL_TEXTURE_2D, texture);
  };
  bind(4, "irradiance", t.irradiance.name());
  bind(5, "levels", levels_.name());
  bind(6, "ramp", ramp_.name());
  const auto set = [&](const char* name, double v) { glUniform1f(show.at(name), static_cast<float>(v)); };
  const auto setInt = [&](const char* name, int v) { glUniform1i(show.at(name), v); };
  set("exposure", std::exp2(settings.tone.ev));
  set("efficacy", luminousEfficacy);
  set("top", f.top);
  set("decades", f.decades);
  setInt("scale", scaleOf(f));
  setInt("levelCount", static_cast<int>(levelValues_.size()));
  setInt("isolines", f.isolines);
  drawScreen(none_);
  return uploaded;
}

std::vector<glm::vec4> ScreenPass::readRadiance(Targets& t, Layers& layers, int wipe) {
  composed_.resize(kRgba32F, t.width, t.height);
  glBindFramebuffer(GL_FRAMEBUFFER, t.scratch.name());
  glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, composed_.name(), 0);
  glViewport(0, 0, t.width, t.height);
  use("", t, layers, wipe);
  drawScreen(none_);
  return readTarget<glm::vec4>(t.scratch.name(), GL_COLOR_ATTACHMENT0, kRgba32F, t.width, t.height);
}

std::uint64_t ScreenPass::select(const std::vector<PrimitiveId>& chosen, std::size_t primitives) {
  std::uint64_t uploaded = 0;
  std::vector<float> selection;
  if (!chosen.empty()) selection.assign(primitives + 1, 0.0f);
  for (const PrimitiveId p : chosen)
    if (p.index() < primitives) selection[p.index() + 1] = 1.0f;
  if (selection == selection_) return uploaded;
  selection_ = std::move(selection);
  if (!selection_.empty()) selected_.assign(GL_R32F, selection_.data(), selection_.size() * sizeof(float), uploaded);
  return uploaded;
}

void ScreenPass::outline(Targets& t) {
  if (selection_.empty()) return;
  glBindFramebuffer(GL_FRAMEBUFFER, t.screen.name());
  Layers noLayers;
  const Program& program = use("OUTLINE", t, noLayers, t.width);
  glUniform1i(program.at("selected"), 4);
  bindTexture(4, GL_TEXTURE_BUFFER, selected_.name());
  drawScreen(none_);
}

}  // namespace deltalux::viewer::gl
