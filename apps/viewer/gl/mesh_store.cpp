#include "gl/mesh_store.hpp"

#include <algorithm>

namespace deltalux::viewer::gl {

namespace {
constexpr double kRoom = 1.25;    // of the buffers, relative to what the first snapshot fills
constexpr float kFlat = 1e-6f;    // cosine off 1 up to which triangles count as parallel
constexpr std::size_t kRows = 3;  // of the table, by side

Extent extentOf(const SurfaceMesh& s) {
  Extent e;
  if (s.vertices.empty()) return e;
  e.lower = e.upper = s.vertices[0].position;
  for (const MeshVertex& v : s.vertices)
    e.lower = glm::min(e.lower, v.position), e.upper = glm::max(e.upper, v.position);
  glm::vec3 normal(0.0f);
  for (std::size_t t = 0; t + 2 < s.triangles.size(); t += 3) {
    const glm::vec3 a = s.vertices[s.triangles[t]].position;
    const glm::dvec3 n = glm::cross(glm::dvec3(s.vertices[s.triangles[t + 1]].position - a),
                                    glm::dvec3(s.vertices[s.triangles[t + 2]].position - a));
    const double length = glm::length(n);
    if (!(length > 0)) continue;
    const glm::vec3 unit(n / length);
    if (normal == glm::vec3(0.0f)) normal = unit;
    if (glm::dot(normal, unit) < 1 - kFlat) return e;
  }
  e.normal = normal;
  e.offset = glm::dot(normal, s.vertices[0].position);
  for (const MeshVertex& v : s.vertices) e.offset = std::min(e.offset, glm::dot(normal, v.position));
  return e;
}
}  // namespace

TextureId textureOf(const Scene& scene, PrimitiveId p) {
  const auto* opaque = std::get_if<Opaque>(&scene.materialOf(p).surface);
  const auto* mesh = std::get_if<Mesh>(&scene[p].shape);
  return opaque && mesh && !mesh->texcoords.empty() ? opaque->diffuseTexture : TextureId();
}

std::uint64_t MeshStore::update(std::shared_ptr<const SolutionMesh> now) {
  std::uint64_t uploaded = 0;
  if (now == mesh_) return uploaded;
  const std::shared_ptr<const SolutionMesh> before = std::exchange(mesh_, std::move(now));
  if (!before || before->surfaces.size() != mesh_->surfaces.size()) {
    rebuild(uploaded);
    return uploaded;
  }
  SideList shapes, lights;
  for (std::size_t i = 0; i < mesh_->surfaces.size(); ++i) {
    const SurfaceMesh *was = before->surfaces[i].get(), *is = mesh_->surfaces[i].get();
    if (was == is) continue;
    if (!was || !is || was->shapeVersion != is->shapeVersion || was->vertices.size() != is->vertices.size())
      shapes.push_back(i);
    else if (was->lightVersion != is->lightVersion)
      lights.push_back(i);
  }
  for (const std::size_t i : shapes) {
    const SurfaceMesh* s = mesh_->surfaces[i].get();
    Side& side = sides_[i];
    const std::size_t vertices = s ? s->vertices.size() : 0, indices = s ? s->triangles.size() : 0;
    if ((vertices > side.vertexRoom_ || indices > side.indexRoom_) && !moveToEnd(side, vertices, indices)) {
      rebuild(uploaded);
      return uploaded;
    }
    writeShape(i, uploaded);
  }
  for (const std::size_t i : lights) writeLight(i, uploaded);
  if (before->scene != mesh_->scene) {
    panes_.update(*mesh_->scene, uploaded);
    readMaterials();
  }
  if (!shapes.empty()) outlinesFit_ = false;
  if (!shapes.empty() || before->scene != mesh_->scene) sortOrder();
  updateTable(uploaded);
  return uploaded;
}

bool MeshStore::moveToEnd(Side& side, std::size_t vertices, std::size_t indices) {
  if (verticesUsed_ + vertices > vertexRoom_ || indicesUsed_ + indices > indexRoom_) return false;
  side.firstVertex_ = static_cast<std::uint32_t>(std::exchange(verticesUsed_, verticesUsed_ + vertices));
  side.firstIndex = static_cast<std::uint32_t>(std::exchange(indicesUsed_, indicesUsed_ + indices));
  side.vertexRoom_ = static_cast<std::uint32_t>(vertices), side.indexRoom_ = static_cast<std::uint32_t>(indices);
  return true;
}

void MeshStore::rebuild(std::uint64_t& uploaded) {
  sides_.assign(mesh_->surfaces.size(), {});
  outlinesFit_ = false;
  panes_.update(*mesh_->scene, uploaded);
  readMaterials();
  std::size_t vertices = 0, indices = 0;
  for (const auto& s : mesh_->surfaces)
    if (s) vertices += s->vertices.size(), indices += s->triangles.size();
  vertexRoom_ = static_cast<std::size_t>(kRoom * static_cast<double>(vertices)) + 1024;
  indexRoom_ = static_cast<std::size_t>(kRoom * static_cast<double>(indices)) + 3072;
  verticesUsed_ = indicesUsed_ = 0;
  vertices_.assign(nullptr, vertexRoom_ * sizeof(Vertex), uploaded);
  irradiance_.assign(nullptr, vertexRoom_ * sizeof(Rgb), uploaded);
  indices_.assign(nullptr, indexRoom_ * sizeof(std::uint32_t), uploaded);
  SideList all;
  for (std::size_t i = 0; i < sides_.size(); ++i)
    if (mesh_->surfaces[i]) all.push_back(i);
  // Those that are drawn together lie together, so that they are drawn by few calls.
  std::stable_sort(all.begin(), all.end(), [&](std::size_t a, std::size_t b) {
    return std::pair(sides_[a].seenThrough, sides_[a].texture) < std::pair(sides_[b].seenThrough, sides_[b].texture);
  });
  for (const std::size_t i : all) {
    moveToEnd(sides_[i], mesh_->surfaces[i]->vertices.size(), mesh_->surfaces[i]->triangles.size());
    writeShape(i, uploaded);
  }
  sortOrder();
  updateTable(uploaded);

  glBindVertexArray(triangles_.name());
  const auto offset = [](std::size_t bytes) { return reinterpret_cast<const void*>(bytes); };
  constexpr auto stride = static_cast<GLsizei>(sizeof(Vertex));
  glBindBuffer(GL_ARRAY_BUFFER, vertices_.name());
  for (const GLuint array : {triangles_.name(), lines_.name()}) {
    glBindVertexArray(array);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, stride, offset(offsetof(Vertex, position)));
    glEnableVertexAttribArray(0);
  }
  glBindVertexArray(triangles_.name());
  glVertexAttribIPointer(1, 1, GL_UNSIGNED_INT, stride, offset(offsetof(Vertex, side)));
  glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, stride, offset(offsetof(Vertex, uv)));
  glBindBuffer(GL_ARRAY_BUFFER, irradiance_.name());
  glVertexAttribPointer(3, 3, GL_FLOAT, GL_FALSE, sizeof(Rgb), nullptr);
  for (const GLuint attribute : {1u, 2u, 3u}) glEnableVertexAttribArray(attribute);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
  glBindVertexArray(0);
}

void MeshStore::writeShape(std::size_t i, std::uint64_t& uploaded) {
  Side& side = sides_[i];
  const SurfaceMesh* s = mesh_->surfaces[i].get();
  side.extent = s ? extentOf(*s) : Extent{};
  side.indices = s ? static_cast<std::uint32_t>(s->triangles.size()) : 0;
  if (!s) return;
  std::vector<Vertex> vertices;
  vertices.reserve(s->vertices.size());
  for (const MeshVertex& v : s->vertices) vertices.push_back({v.position, static_cast<std::uint32_t>(i), v.uv});
  std::vector<std::uint32_t> indices(s->triangles);
  for (std::uint32_t& index : indices) index += side.firstVertex_;
  vertices_.write(side.firstVertex_ * sizeof(Vertex), vertices.data(), vertices.size() * sizeof(Vertex), uploaded);
  indices_.write(side.firstIndex * sizeof(std::uint32_t), indices.data(), indices.size() * sizeof(std::uint32_t),
                 uploaded);
  writeLight(i, uploaded);
}

void MeshStore::writeLight(std::size_t i, std::uint64_t& uploaded) {
  const SurfaceMesh& s = *mesh_->surfaces[i];
  std::vector<Rgb> E;
  E.reserve(s.vertices.size());
  for (const MeshVertex& v : s.vertices) E.push_back(v.direct + v.indirect + v.particle);
  irradiance_.write(sides_[i].firstVertex_ * sizeof(Rgb), E.data(), E.size() * sizeof(Rgb), uploaded);
}

void MeshStore::readMaterials() {
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const PrimitiveId p(i / 2);
    sides_[i].seenThrough = isSeenThrough(mesh_->scene->materialOf(p));
    sides_[i].texture = textureOf(*mesh_->scene, p);
  }
}

void MeshStore::sortOrder() {
  order_.clear();
  for (std::size_t i = 0; i < sides_.size(); ++i)
    if (sides_[i].indices > 0) order_.push_back(static_cast<std::uint32_t>(i));
  std::sort(order_.begin(), order_.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(sides_[a].texture, sides_[a].firstIndex) < std::pair(sides_[b].texture, sides_[b].firstIndex);
  });
}

void MeshStore::updateTable(std::uint64_t& uploaded) {
  std::vector<glm::vec4> rows(kRows * sides_.size(), glm::vec4(0.0f));
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    const SurfaceMesh* s = mesh_->surfaces[i].get();
    if (!s) continue;
    const auto row = static_cast<float>(panes_.row((*mesh_->scene)[PrimitiveId(i / 2)].material));
    constexpr auto pi = static_cast<float>(kPi);
    rows[kRows * i] = glm::vec4(s->albedo / pi, 0.0f);
    rows[kRows * i + 1] = glm::vec4(s->radiance, row);
    rows[kRows * i + 2] = glm::vec4(s->transmittance / pi, 0.0f);
    sides_[i].passesOther = !isBlack(s->transmittance);
  }
  if (rows.size() != tableRows_.size()) {
    table_.assign(GL_RGBA32F, rows.data(), rows.size() * sizeof(glm::vec4), uploaded);
  } else {
    const auto first =
        static_cast<std::size_t>(std::mismatch(rows.begin(), rows.end(), tableRows_.begin()).first - rows.begin());
    std::size_t end = rows.size();
    while (end > first && rows[end - 1] == tableRows_[end - 1]) --end;
    table_.buffer().write(first * sizeof(glm::vec4), rows.data() + first, (end - first) * sizeof(glm::vec4), uploaded);
  }
  tableRows_ = std::move(rows);
}

std::uint32_t MeshStore::outlines(std::uint64_t& uploaded) {
  if (outlinesFit_ || !mesh_) return outlineIndices_;
  std::vector<std::uint32_t> indices;
  for (std::size_t i = 0; i < sides_.size(); ++i) {
    if (!mesh_->surfaces[i]) continue;
    for (const std::uint32_t index : mesh_->surfaces[i]->outlines) indices.push_back(sides_[i].firstVertex_ + index);
  }
  lineIndices_.assign(indices.data(), indices.size() * sizeof(std::uint32_t), uploaded);
  glBindVertexArray(lines_.name());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, lineIndices_.name());
  glBindVertexArray(0);
  outlineIndices_ = static_cast<std::uint32_t>(indices.size());
  outlinesFit_ = true;
  return outlineIndices_;
}

}  // namespace deltalux::viewer::gl
