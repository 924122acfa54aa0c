#include "gl/line_pass.hpp"

#include "gl/shaders.hpp"

namespace deltalux::viewer::gl {

namespace {
constexpr double kNearer = 2e-3;  // share of its distance by which a line is drawn nearer than it is

struct LineVertex {
  Vec3f position;
  glm::vec4 colour;
};

/// In clip coordinates: what a point's depth changes by when it comes nearer by a share of its distance.
float depthOfShare(const SurfaceView& v, double share) {
  const DepthRange& r = v.list.depths;
  if (v.eye.parallel) return static_cast<float>(2 * share);
  return static_cast<float>(2 * r.farthest * r.nearest / (r.farthest - r.nearest) * share);
}
}  // namespace

void LinePass::use(const SurfaceView& v, bool section) {
  Program& program = section ? cut_ : plain_;
  if (!program)
    program = Program(section ? "#define SECTION\n" : "", shaders::kLineVertex, shaders::kLineFragment, {"colour"});
  program.use();
  const glm::mat4 toClip(v.toClip);
  glUniformMatrix4fv(program.at("toClip"), 1, GL_FALSE, &toClip[0][0]);
  glUniform1f(program.at("nearer"), depthOfShare(v, kNearer));
  if (!section) return;
  const glm::vec3 lower(v.section->lower), upper(v.section->upper);
  glUniform3fv(program.at("sectionLower"), 1, &lower[0]);
  glUniform3fv(program.at("sectionUpper"), 1, &upper[0]);
}

std::uint64_t LinePass::drawOutlines(const SurfaceView& v) {
  std::uint64_t uploaded = 0;
  const std::uint32_t indices = v.mesh.outlines(uploaded);
  if (indices == 0) return uploaded;
  use(v, v.section.has_value());
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glBindVertexArray(v.mesh.lines());
  glVertexAttrib4f(1, 0.1f, 0.3f, 0.6f, 0.5f);
  glDrawElements(GL_LINES, static_cast<GLsizei>(indices), GL_UNSIGNED_INT, nullptr);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return uploaded;
}

std::uint64_t LinePass::drawLines(const SurfaceView& v, const std::vector<Line>& lines) {
  std::uint64_t uploaded = 0;
  if (lines.empty()) return uploaded;
  std::vector<LineVertex> vertices;  // those that are hidden by what stands before them first
  GLsizei hideable = 0;
  for (const bool onTop : {false, true}) {
    for (const Line& line : lines)
      if (line.onTop == onTop) {
        vertices.push_back({line.from, line.colour});
        vertices.push_back({line.to, line.colour});
      }
    if (!onTop) hideable = static_cast<GLsizei>(vertices.size());
  }
  vertices_.assign(vertices.data(), vertices.size() * sizeof(LineVertex), uploaded);
  glBindVertexArray(array_.name());
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(LineVertex), nullptr);
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(LineVertex),
                        reinterpret_cast<const void*>(offsetof(LineVertex, colour)));
  glEnableVertexAttribArray(0);
  glEnableVertexAttribArray(1);
  use(v, false);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glDepthMask(GL_FALSE);
  glEnable(GL_DEPTH_CLAMP);  // depths are fitted to the surfaces: those of lines may lie outside
  glDrawArrays(GL_LINES, 0, hideable);
  glDisable(GL_DEPTH_TEST);
  glDrawArrays(GL_LINES, hideable, static_cast<GLsizei>(vertices.size()) - hideable);
  glDisable(GL_DEPTH_CLAMP);
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
  glDepthMask(GL_TRUE);
  return uploaded;
}

}  // namespace deltalux::viewer::gl
