#include "gl/renderer.hpp"

#include <chrono>
#include <cmath>
#include <stdexcept>

#include "camera.hpp"
#include "gl/background.hpp"
#include "gl/draw_state.hpp"
#include "gl/line_pass.hpp"
#include "gl/screen_pass.hpp"
#include "gl/surface_passes.hpp"

namespace deltalux::viewer::gl {

namespace {
/// A snapshot on the graphics card. Two are kept: what is now, and what it is compared with.
struct Store {
  MeshStore surfaces;
  CausticStore caustics;

  std::uint64_t update(const std::shared_ptr<const SolutionMesh>& mesh) {
    return surfaces.update(mesh) + caustics.update(mesh);
  }
};

double millisecondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

void requireVersion() {
  const int version = epoxy_gl_version();
  if (version < 33 || !epoxy_is_desktop_gl())
    throw std::runtime_error("the viewer needs OpenGL 3.3; here is " + std::to_string(version / 10) + "." +
                             std::to_string(version % 10));
}

/// Columns from here on show the other snapshot.
int wipeColumn(const Frame& f) {
  return f.other ? static_cast<int>(std::lround(std::clamp(f.wipe, 0.0, 1.0) * f.width)) : f.width;
}
}  // namespace

struct Renderer::State {
  Targets targets;
  Store now, other;
  SurfacePasses passes;
  Background background;
  Layers layers;
  ScreenPass screen;
  LinePass lines;

  std::shared_ptr<const Scene> scene;
  std::vector<char> goesOn;  // by primitive: a mirror, gloss or glass
  bool anyGoesOn = false;
  int wipe = 0;
  double luminousEfficacy = kLuminousEfficacy;
  std::vector<std::uint32_t> primitives;  // as read back
  bool primitivesRead = true;

  struct Part {
    Store* store;
    DrawList list;
    Eye eye;
    int from, to;  // columns
  };
  std::vector<Part> partsOf(const Frame&, DrawReport&);
  SurfaceView viewOf(const Part&, const Frame&) const;
  void readScene(const SolutionMesh&);
  void drawScene(const Frame&, std::vector<Part>&, DrawReport&);
  void askCache(const Frame&, RenderCache*, DrawReport&);
  void choosePicture(const Frame&, DrawReport&);
  void outlineSelection(const Frame&, const std::vector<Part>&);
  void drawOverlays(const Frame&, std::vector<Part>&, DrawReport&);
  void show(GLuint framebuffer) const;
  const std::vector<std::uint32_t>& readPrimitives();
  template <class Draw>
  void forParts(const Frame&, std::vector<Part>&, const Draw&);
};

void Renderer::State::readScene(const SolutionMesh& mesh) {
  if (scene == mesh.scene) return;
  scene = mesh.scene;
  luminousEfficacy = scene->luminousEfficacy;
  goesOn.assign(scene->primitives.size(), 0);
  for (std::size_t p = 0; p < goesOn.size(); ++p) {
    const Material& m = scene->materialOf(PrimitiveId(p));
    goesOn[p] = isSpecular(m) || passesStraight(m);
  }
  anyGoesOn = std::find(goesOn.begin(), goesOn.end(), 1) != goesOn.end();
}

std::vector<Renderer::State::Part> Renderer::State::partsOf(const Frame& f, DrawReport& report) {
  std::vector<Part> parts;
  const Eye eye = eyeOf(f.camera);
  const bool wholePanes = f.settings.falseColour.quantity == Quantity::Illuminance;
  const auto add = [&](Store& store, const std::shared_ptr<const SolutionMesh>& mesh, const Ahead* ahead, int from,
                       int to) {
    if (from >= to) return;
    report.uploadedBytes += store.update(mesh);
    parts.push_back({&store, drawListOf(store.surfaces, eye, f.settings.section, ahead, wholePanes), eye, from, to});
  };
  add(now, f.mesh, f.ahead ? &*f.ahead : nullptr, 0, wipe);
  if (f.other) add(other, f.other, nullptr, wipe, f.width);
  // The same depths for both, so that lines fit both.
  DepthRange depths = parts.front().list.depths;
  for (const Part& part : parts) {
    depths.nearest = std::min(depths.nearest, part.list.depths.nearest);
    depths.farthest = std::max(depths.farthest, part.list.depths.farthest);
  }
  for (Part& part : parts) part.list.depths = depths;
  return parts;
}

SurfaceView Renderer::State::viewOf(const Part& part, const Frame& f) const {
  return {part.store->surfaces,
          part.store->caustics,
          part.list,
          part.eye,
          toClip(part.eye, part.list.depths),
          f.ahead ? f.ahead->matrix : glm::mat4(1.0f),
          f.settings.section,
          f.settings.falseColour.quantity == Quantity::Illuminance};
}

/// draw(view) for the columns of each part.
template <class Draw>
void Renderer::State::forParts(const Frame& f, std::vector<Part>& parts, const Draw& draw) {
  glEnable(GL_SCISSOR_TEST);
  for (const Part& part : parts) {
    glScissor(part.from, 0, part.to - part.from, f.height);
    cutAtSection(f.settings.section.has_value());
    draw(viewOf(part, f));
    cutAtSection(false);
  }
  glDisable(GL_SCISSOR_TEST);
}

void Renderer::State::drawScene(const Frame& f, std::vector<Part>& parts, DrawReport& report) {
  const bool illuminance = f.settings.falseColour.quantity == Quantity::Illuminance;
  const auto bindScene = [&] { glBindFramebuffer(GL_FRAMEBUFFER, targets.scene.name()); };
  bindScene();
  glViewport(0, 0, f.width, f.height);
  const GLenum all[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glDrawBuffers(illuminance ? 3 : 2, all);
  const float black[4] = {}, far = 1;
  const GLuint nothing[4] = {};
  glClearBufferfv(GL_COLOR, 0, black);
  glClearBufferuiv(GL_COLOR, 1, nothing);
  if (illuminance) glClearBufferfv(GL_COLOR, 2, black);
  glClearBufferfv(GL_DEPTH, 0, &far);

  bool anyPane = false;
  forParts(f, parts, [&](const SurfaceView& v) {
    passes.drawOpaque(v, report.uploadedBytes);
    for (const auto* groups : {&v.list.opaque, &v.list.panes, &v.list.behind})
      for (const DrawList::Group& group : *groups) report.triangles += group.runs.triangles;
    anyPane = anyPane || !v.list.panes.empty();
  });
  report.uploadedBytes += background.update(*scene);
  background.draw(parts.front().eye, f.width, f.height);
  forParts(f, parts, [&](const SurfaceView& v) {
    passes.addOtherSides(v);
    passes.addCaustics(v, report.uploadedBytes);
  });
  if (!anyPane) return;
  forParts(f, parts, [&](const SurfaceView& v) { passes.drawPanes(v, report.uploadedBytes); });
  targets.copyDepthForPanes();
  glBindFramebuffer(GL_FRAMEBUFFER, targets.panes.name());
  forParts(f, parts, [&](const SurfaceView& v) { passes.drawPanePrimitives(v); });
}

void Renderer::State::askCache(const Frame& f, RenderCache* cache, DrawReport& report) {
  layers.dropCache();
  if (!cache || !f.settings.cache) return;
  std::vector<std::uint32_t> wanted(static_cast<std::size_t>(f.width) * static_cast<std::size_t>(f.height), 0);
  if (anyGoesOn) {
    wanted = readPrimitives();
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const bool left = static_cast<int>(i % static_cast<std::size_t>(f.width)) < wipe;
      if (wanted[i] != 0 && !(left && goesOn[wanted[i] - 1])) wanted[i] = 0;
    }
  }
  const auto start = std::chrono::steady_clock::now();
  const CacheFrame& frame = cache->frame(f.camera, f.width, f.height, wanted);
  report.cacheMilliseconds = millisecondsSince(start);
  report.cacheWanted = frame.wanted, report.cacheHeld = frame.held;
  report.uploadedBytes += layers.setCache(frame);
}

void Renderer::State::choosePicture(const Frame& f, DrawReport& report) {
  const Picture* p = f.picture.get();
  // A section is no part of pictures.
  if (p && f.settings.picture && !f.ahead && !f.settings.section && p->version == f.mesh->version &&
      sameView(p->view, f.camera) && p->image.width == f.width && p->image.height == f.height)
    report.uploadedBytes += layers.setPicture(f.picture);
  else
    layers.dropPicture();
}

/// Looks at the pixels where the selection may be, and no others.
void Renderer::State::outlineSelection(const Frame& f, const std::vector<Part>& parts) {
  glm::vec2 lower(static_cast<float>(f.width), static_cast<float>(f.height)), upper(0.0f);
  for (const Part& part : parts) {
    const std::vector<MeshStore::Side>& sides = part.store->surfaces.sides();
    const glm::mat4 clip(toClip(part.eye, part.list.depths));
    for (const PrimitiveId p : f.selection)
      for (const std::size_t i : {SolutionMesh::side(p, true), SolutionMesh::side(p, false)}) {
        if (i >= sides.size() || sides[i].indices == 0) continue;
        const Extent& e = sides[i].extent;
        const ScreenBox box = screenBox(part.list.isAhead(i) ? moved(e, f.ahead->matrix) : e, clip, f.width, f.height);
        lower = glm::min(lower, box.lower), upper = glm::max(upper, box.upper);
      }
  }
  constexpr float kMargin = 3;  // pixels, of the outline
  const glm::ivec2 from(glm::max(lower - kMargin, glm::vec2(0.0f))), to(upper + kMargin);
  if (from.x >= to.x || from.y >= to.y) return;
  glEnable(GL_SCISSOR_TEST);
  glScissor(from.x, from.y, to.x - from.x, to.y - from.y);
  screen.outline(targets);
  glDisable(GL_SCISSOR_TEST);
}

void Renderer::State::drawOverlays(const Frame& f, std::vector<Part>& parts, DrawReport& report) {
  glBindFramebuffer(GL_FRAMEBUFFER, targets.screen.name());
  const Overlays& overlays = f.settings.overlays;
  if (overlays.textureRegions || overlays.mesh)
    forParts(f, parts, [&](const SurfaceView& v) {
      if (overlays.textureRegions) passes.tintCaustics(v, report.uploadedBytes);
      if (overlays.mesh) report.uploadedBytes += lines.drawOutlines(v);
    });
  if (!f.lines.empty()) report.uploadedBytes += lines.drawLines(viewOf(parts.front(), f), f.lines);
}

void Renderer::State::show(GLuint framebuffer) const {
  glBindFramebuffer(GL_READ_FRAMEBUFFER, targets.screen.get());
  glReadBuffer(GL_COLOR_ATTACHMENT0);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
  const int w = targets.width, h = targets.height;
  glBlitFramebuffer(0, 0, w, h, 0, h, w, 0, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

const std::vector<std::uint32_t>& Renderer::State::readPrimitives() {
  if (primitivesRead) return primitives;
  GLint framebuffer = 0;
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &framebuffer);
  primitives =
      readTarget<std::uint32_t>(targets.panes.name(), GL_COLOR_ATTACHMENT1, kR32Ui, targets.width, targets.height);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(framebuffer));
  primitivesRead = true;
  return primitives;
}

Renderer::Renderer() {
  requireVersion();
  state_ = std::make_unique<State>();
}
Renderer::~Renderer() = default;

DrawReport Renderer::draw(const Frame& f, RenderCache* cache) {
  DrawReport report;
  if (!f.mesh || f.width <= 0 || f.height <= 0) return report;
  const auto start = std::chrono::steady_clock::now();
  State& s = *state_;
  const DrawState state;
  s.wipe = wipeColumn(f);
  s.targets.resize(f.width, f.height, f.settings.falseColour.quantity == Quantity::Illuminance);
  s.readScene(*f.mesh);
  std::vector<State::Part> parts = s.partsOf(f, report);
  s.drawScene(f, parts, report);
  s.primitivesRead = false;
  s.askCache(f, cache, report);
  s.choosePicture(f, report);
  report.uploadedBytes += s.screen.select(f.selection, s.scene->primitives.size());
  report.uploadedBytes += s.screen.draw(s.targets, s.layers, f.settings, s.luminousEfficacy, s.wipe);
  s.outlineSelection(f, parts);
  s.drawOverlays(f, parts, report);
  s.show(state.framebuffer());
  if (f.settings.overlays.statistics) glFinish();
  report.milliseconds = millisecondsSince(start);
  return report;
}

DisplayImage Renderer::screenshot() const {
  State& s = *state_;
  const DrawState state;
  DisplayImage image{s.targets.width, s.targets.height, {}};
  if (s.targets.width == 0) return image;
  using Texel = std::array<std::uint8_t, 4>;
  for (const Texel& t :
       readTarget<Texel>(s.targets.screen.name(), GL_COLOR_ATTACHMENT0, kRgba8, image.width, image.height))
    image.pixels.push_back({t[0], t[1], t[2]});
  return image;
}

Image Renderer::radiance() const {
  State& s = *state_;
  const DrawState state;
  Image image;
  image.width = s.targets.width, image.height = s.targets.height;
  image.luminousEfficacy = s.luminousEfficacy;
  if (s.targets.width == 0) return image;
  for (const glm::vec4& texel : s.screen.readRadiance(s.targets, s.layers, s.wipe)) image.pixels.emplace_back(texel);
  return image;
}

const std::vector<std::uint32_t>& Renderer::surfaces() const { return state_->readPrimitives(); }

std::vector<char> Renderer::specularPixels() const {
  std::vector<char> specular;
  for (const std::uint32_t p : surfaces()) specular.push_back(p != 0 && state_->goesOn[p - 1]);
  return specular;
}

}  // namespace deltalux::viewer::gl
