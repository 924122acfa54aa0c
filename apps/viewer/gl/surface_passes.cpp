#include "gl/surface_passes.hpp"

#include "gl/shaders.hpp"

namespace deltalux::viewer::gl {

namespace {
enum Part : unsigned {
  kSection = 1,
  kTextured = 2,
  kIlluminance = 4,
  kOtherSide = 8,
  kCaustic = 16,
  kPane = 32,
  kFlatColour = 64,
};
constexpr int kSidesUnit = 0, kImageUnit = 1, kPassesUnit = 2, kTintUnit = 3;

Program surfaceProgram(unsigned parts) {
  static constexpr std::pair<Part, const char*> names[] = {
      {kSection, "SECTION"}, {kTextured, "TEXTURED"}, {kIlluminance, "ILLUMINANCE"}, {kOtherSide, "OTHER_SIDE"},
      {kCaustic, "CAUSTIC"}, {kPane, "PANE"},         {kFlatColour, "FLAT"},
  };
  std::string defines;
  for (const auto& [part, name] : names)
    if (parts & part) defines += std::string("#define ") + name + "\n";
  std::vector<std::string> outputs{"colour"};
  if (!(parts & kPane)) outputs.push_back("primitiveOut");
  if (parts & kIlluminance) outputs.push_back("irradianceOut");
  return Program(defines, shaders::kSurfaceVertex, shaders::kSurfaceFragment, outputs,
                 parts & kPane ? "transmitted" : nullptr);
}

void addTo(const SurfaceView& v, bool irradianceToo) {
  const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_NONE, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(v.illuminance && irradianceToo ? 3 : 1, both);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE);
  glDepthMask(GL_FALSE);
}

void blendNoMore() {
  glDisable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ZERO);  // a second source is refused with more targets than one, even where it is off
  glDepthMask(GL_TRUE);
}

void drawAll(const std::vector<DrawList::Group>& groups, bool ahead) {
  for (const DrawList::Group& group : groups)
    if (group.ahead == ahead) group.runs.draw();
}
}  // namespace

NearerBySome::NearerBySome() {
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(-1.0f, -4.0f);
}
NearerBySome::~NearerBySome() { glDisable(GL_POLYGON_OFFSET_FILL); }

const Program& SurfacePasses::use(unsigned parts, const SurfaceView& v, bool ahead) {
  if (v.section) parts |= kSection;
  auto place = programs_.find(parts);
  if (place == programs_.end()) place = programs_.emplace(parts, surfaceProgram(parts)).first;
  const Program& program = place->second;
  program.use();
  const glm::mat4 model = ahead ? v.ahead : glm::mat4(1.0f);
  const glm::mat4 toClip(v.toClip * glm::dmat4(model));
  glUniformMatrix4fv(program.at("toClip"), 1, GL_FALSE, &toClip[0][0]);
  glUniformMatrix4fv(program.at("model"), 1, GL_FALSE, &model[0][0]);
  if (v.section) {
    const glm::vec3 lower(v.section->lower), upper(v.section->upper);
    glUniform3fv(program.at("sectionLower"), 1, &lower[0]);
    glUniform3fv(program.at("sectionUpper"), 1, &upper[0]);
  }
  const glm::vec4 eye = v.eye.parallel ? glm::vec4(-v.eye.forward, 0.0f) : glm::vec4(v.eye.position, 1.0f);
  glUniform4fv(program.at("eye"), 1, &eye[0]);
  glUniform1i(program.at("sides"), kSidesUnit);
  glUniform1i(program.at("image"), kImageUnit);
  glUniform1i(program.at("passes"), kPassesUnit);
  glUniform1i(program.at("tint"), kTintUnit);
  bindTexture(kPassesUnit, GL_TEXTURE_2D, v.mesh.paneTable());
  bindTexture(kSidesUnit, GL_TEXTURE_BUFFER, v.mesh.sideTable());
  return program;
}

void SurfacePasses::drawOpaque(const SurfaceView& v, std::uint64_t& uploaded) {
  const GLenum targets[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(v.illuminance ? 3 : 2, targets);
  for (const DrawList::Group& group : v.list.opaque) {
    const bool textured = group.texture.valid();
    use((textured ? kTextured : 0u) | (v.illuminance ? kIlluminance : 0u), v, group.ahead);
    if (textured)
      bindTexture(kImageUnit, GL_TEXTURE_2D, textures_.texture(*v.mesh.mesh()->scene, group.texture, uploaded));
    glBindVertexArray(v.mesh.triangles());
    group.runs.draw();
  }
}

void SurfacePasses::addOtherSides(const SurfaceView& v) {
  if (v.list.behind.empty()) return;
  const NearerBySome nearer;
  addTo(v, false);
  glCullFace(GL_FRONT);
  glBindVertexArray(v.mesh.triangles());
  for (const bool ahead : {false, true}) {
    use(kOtherSide, v, ahead);
    drawAll(v.list.behind, ahead);
  }
  glCullFace(GL_BACK);
  blendNoMore();
}

void SurfacePasses::drawCaustic(CausticStore::Shown& shown, unsigned parts, const SurfaceView& v,
                                std::uint64_t& uploaded) {
  const bool textured = shown.material.valid() && !(parts & (kOtherSide | kFlatColour));
  if (textured) {
    parts |= kTextured;
    bindTexture(kTintUnit, GL_TEXTURE_2D, textures_.texture(*v.mesh.mesh()->scene, shown.material, uploaded));
  }
  use(parts | kCaustic, v, v.list.isAhead(shown.side));
  bindTexture(kImageUnit, GL_TEXTURE_2D, shown.texels.name());
  glBindVertexArray(shown.array.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(shown.indices), GL_UNSIGNED_INT, nullptr);
}

void SurfacePasses::addCaustics(const SurfaceView& v, std::uint64_t& uploaded) {
  const NearerBySome nearer;
  addTo(v, true);
  const Visibility visibility(v.eye, v.section);
  const auto seen = [&](const CausticStore::Shown& shown) {
    return v.list.isAhead(shown.side) || visibility.sees(shown.extent);
  };
  v.caustics.forEach([&](CausticStore::Shown& shown) {
    if (seen(shown)) drawCaustic(shown, v.illuminance ? kIlluminance : 0u, v, uploaded);
  });
  addTo(v, false);
  glCullFace(GL_FRONT);
  v.caustics.forEach([&](CausticStore::Shown& shown) {
    if (v.mesh.sides()[shown.side ^ 1].passesOther && seen(shown)) drawCaustic(shown, kOtherSide, v, uploaded);
  });
  glCullFace(GL_BACK);
  blendNoMore();
}

void SurfacePasses::drawPanes(const SurfaceView& v, std::uint64_t& uploaded) {
  const GLenum colour = GL_COLOR_ATTACHMENT0;
  glDrawBuffers(1, &colour);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_SRC1_COLOR);
  glDepthMask(GL_FALSE);
  for (const DrawList::Group& group : v.list.panes) {
    const bool textured = group.texture.valid();
    use(kPane | (textured ? kTextured : 0u), v, group.ahead);
    if (textured)
      bindTexture(kImageUnit, GL_TEXTURE_2D, textures_.texture(*v.mesh.mesh()->scene, group.texture, uploaded));
    glBindVertexArray(v.mesh.triangles());
    group.runs.draw();
  }
  blendNoMore();
}

void SurfacePasses::drawPanePrimitives(const SurfaceView& v) {
  const GLenum primitives[] = {GL_NONE, GL_COLOR_ATTACHMENT1};
  glDrawBuffers(2, primitives);
  glBindVertexArray(v.mesh.triangles());
  for (const bool ahead : {false, true}) {
    use(kFlatColour, v, ahead);
    drawAll(v.list.panes, ahead);
  }
}

void SurfacePasses::tintCaustics(const SurfaceView& v, std::uint64_t& uploaded) {
  const NearerBySome nearer;
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  float hue = 0;
  v.caustics.forEach([&](CausticStore::Shown& shown) {
    hue = glm::fract(hue + 0.618034f);  // golden ratio: neighbours in the list differ most
    const glm::vec3 c =
        glm::clamp(glm::abs(glm::fract(hue + glm::vec3(0, 2, 1) / 3.0f) * 6.0f - 3.0f) - 1.0f, 0.0f, 1.0f);
    const Program& program = use(kCaustic | kFlatColour, v, v.list.isAhead(shown.side));
    glUniform4f(program.at("flatColour"), c.r, c.g, c.b, 0.35f);
    drawCaustic(shown, kFlatColour, v, uploaded);
  });
  blendNoMore();
}

}  // namespace deltalux::viewer::gl
