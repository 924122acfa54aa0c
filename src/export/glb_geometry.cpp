#include "export/glb_geometry.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "export/lightmap.hpp"

namespace deltalux::exporting {

namespace {

constexpr int kFloat = 5126, kUnsigned = 5125, kVertices = 34962, kIndices = 34963;  // [defined]

/// Part of a side that one chart shows, or all of a side that none does.
struct Piece {
  const SurfaceMesh* side;
  std::optional<std::size_t> chart;
};

/// Arrays that all accessors share.
struct VertexArrays {
  std::vector<Vec3f> positions, normals;
  std::vector<glm::vec2> texcoords, atlas;
  std::vector<std::uint32_t> indices;
};

/// The range of the arrays that is one primitive.
struct PrimitiveRange {
  std::size_t object = 0, material = 0;
  std::optional<std::uint32_t> page;  // where nodes tell it
  std::size_t firstVertex = 0, vertices = 0, firstIndex = 0, indices = 0;
};

Vec3f unitNormal(const Vec3f& n) {
  const float length = glm::length(n);
  return length > 0 ? n / length : Vec3f(0, 0, 1);
}

class GeometryWriter {
 public:
  GeometryWriter(const Atlas& atlas, VertexArrays& arrays) : atlas_(atlas), arrays_(arrays) {}

  PrimitiveRange write(const std::vector<Piece>& pieces) {
    PrimitiveRange range;
    range.firstVertex = arrays_.positions.size(), range.firstIndex = arrays_.indices.size();
    for (const Piece& p : pieces) p.chart ? addChart(*p.side, *p.chart, range) : addSide(*p.side, range);
    range.vertices = arrays_.positions.size() - range.firstVertex;
    range.indices = arrays_.indices.size() - range.firstIndex;
    return range;
  }

 private:
  std::uint32_t next(const PrimitiveRange& range) const {
    return static_cast<std::uint32_t>(arrays_.positions.size() - range.firstVertex);
  }
  void addVertex(const MeshVertex& v, const glm::vec2& atlas) {
    arrays_.positions.push_back(v.position);
    arrays_.normals.push_back(unitNormal(v.normal));
    arrays_.texcoords.push_back(v.uv);
    arrays_.atlas.push_back(atlas);
  }
  void addChart(const SurfaceMesh& side, std::size_t index, const PrimitiveRange& range) {
    const AtlasChart& chart = atlas_.charts[index];
    const std::uint32_t first = next(range);
    for (std::size_t i = 0; i < chart.vertices.size(); ++i)
      addVertex(side.vertices[chart.vertices[i]], glm::vec2(texcoordOf(atlas_, index, chart.places[i])));
    for (const std::uint32_t c : chart.corners) arrays_.indices.push_back(first + c);
  }
  void addSide(const SurfaceMesh& side, const PrimitiveRange& range) {
    const std::uint32_t first = next(range);
    for (const MeshVertex& v : side.vertices) addVertex(v, glm::vec2(0.0f));
    for (const std::uint32_t i : side.triangles) arrays_.indices.push_back(first + i);
  }

  const Atlas& atlas_;
  VertexArrays& arrays_;
};

/// What one primitive of the file holds, by object, page where nodes tell it, and material.
using PiecesByMaterial =
    std::map<std::tuple<std::size_t, std::optional<std::uint32_t>, std::size_t>, std::vector<Piece>>;

PiecesByMaterial piecesOf(const SolutionMesh& mesh, const Atlas& atlas, const MaterialOfSide& materialOf, bool byPage) {
  PiecesByMaterial pieces;
  const auto put = [&](const SurfaceMesh& side, std::optional<std::size_t> chart) {
    const std::optional<std::uint32_t> page = chart ? std::optional(atlas.places[*chart].page) : std::nullopt;
    pieces[{(*mesh.scene)[side.primitive].object.value, byPage ? page : std::nullopt, materialOf(side, page)}]
        .push_back({&side, chart});
  };
  std::size_t chart = 0;  // they are in the order of the sides
  for (std::size_t s = 0; s < mesh.surfaces.size(); ++s) {
    const bool charted = chart < atlas.charts.size() && atlas.charts[chart].side == s;
    if (!charted && isShown(mesh, s)) put(*mesh.surfaces[s], std::nullopt);
    for (; chart < atlas.charts.size() && atlas.charts[chart].side == s; ++chart) put(*mesh.surfaces[s], chart);
  }
  return pieces;
}

struct ArrayViews {
  std::size_t positions = 0, normals = 0, texcoords = 0, atlas = 0, indices = 0;
};

GlbJson accessor(std::size_t view, std::size_t offset, int component, std::size_t count, const char* type) {
  return {{"bufferView", view}, {"byteOffset", offset}, {"componentType", component}, {"count", count}, {"type", type}};
}

std::size_t addPositions(GlbContainer& glb, const VertexArrays& arrays, const PrimitiveRange& r, std::size_t view) {
  Vec3f low(arrays.positions[r.firstVertex]), high = low;
  for (std::size_t i = r.firstVertex; i < r.firstVertex + r.vertices; ++i)
    low = glm::min(low, arrays.positions[i]), high = glm::max(high, arrays.positions[i]);
  GlbJson json = accessor(view, r.firstVertex * sizeof(Vec3f), kFloat, r.vertices, "VEC3");
  json["min"] = {low.x, low.y, low.z}, json["max"] = {high.x, high.y, high.z};
  return glb.add("accessors", std::move(json));
}

GlbJson primitiveOf(GlbContainer& glb, const VertexArrays& arrays, const PrimitiveRange& r, const ArrayViews& views,
                    AtlasSet set) {
  GlbJson attributes;
  attributes["POSITION"] = addPositions(glb, arrays, r, views.positions);
  attributes["NORMAL"] =
      glb.add("accessors", accessor(views.normals, r.firstVertex * sizeof(Vec3f), kFloat, r.vertices, "VEC3"));
  const auto texcoord = [&](std::size_t view) {
    return glb.add("accessors", accessor(view, r.firstVertex * sizeof(glm::vec2), kFloat, r.vertices, "VEC2"));
  };
  if (set == AtlasSet::Second) attributes["TEXCOORD_0"] = texcoord(views.texcoords);
  attributes[set == AtlasSet::Second ? "TEXCOORD_1" : "TEXCOORD_0"] = texcoord(views.atlas);
  const std::size_t indices = glb.add(
      "accessors", accessor(views.indices, r.firstIndex * sizeof(std::uint32_t), kUnsigned, r.indices, "SCALAR"));
  return {{"attributes", std::move(attributes)}, {"indices", indices}, {"material", r.material}};
}

/// Turns the scene's up to +y by the shortest way: x, y, z, w.
GlbJson rotationOf(const Vec3& up) {
  const Vec3 from = glm::normalize(up), to(0, 1, 0);
  const double w = 1 + glm::dot(from, to);
  glm::dvec4 q = w > 1e-9 ? glm::dvec4(glm::cross(from, to), w) : glm::dvec4(1, 0, 0, 0);
  q /= glm::length(q);
  return {q.x, q.y, q.z, q.w};
}

/// A node by itself, or one that holds them.
std::size_t addObject(GlbContainer& glb, const std::string& name, std::vector<GlbJson> nodes) {
  if (nodes.size() == 1) return glb.add("nodes", std::move(nodes.front()));
  GlbJson children = GlbJson::array();
  for (GlbJson& node : nodes) children.push_back(glb.add("nodes", std::move(node)));
  return glb.add("nodes", {{"name", name}, {"children", std::move(children)}});
}

}  // namespace

bool isShown(const SolutionMesh& mesh, std::size_t side) {
  const auto& surface = mesh.surfaces[side];
  if (!surface || surface->triangles.empty()) return false;
  return surface->front || !isBlack(surface->radiance) || isLit(mesh, side) ||
         passesStraight(mesh.scene->materialOf(surface->primitive));
}

GeometryCounts addGeometry(GlbContainer& glb, const SolutionMesh& mesh, const Atlas& atlas, AtlasSet set,
                           const MaterialOfSide& materialOf, AddView addView, const PageOfNode& pageOfNode) {
  VertexArrays arrays;
  GeometryWriter writer(atlas, arrays);
  std::vector<PrimitiveRange> ranges;
  for (const auto& [key, pieces] : piecesOf(mesh, atlas, materialOf, bool(pageOfNode))) {
    ranges.push_back(writer.write(pieces));
    PrimitiveRange& range = ranges.back();
    std::tie(range.object, range.page, range.material) = key;
  }
  const Scene& scene = *mesh.scene;
  glb.json["scene"] = 0;
  GlbJson root{{"name", "deltalux"}, {"rotation", rotationOf(scene.up)}};
  if (scene.metresPerUnit != 1) root["scale"] = {scene.metresPerUnit, scene.metresPerUnit, scene.metresPerUnit};
  if (ranges.empty()) {
    glb.json["scenes"] = GlbJson::array({{{"nodes", GlbJson::array({glb.add("nodes", std::move(root))})}}});
    return {};
  }
  ArrayViews views;
  const auto add = [&](const auto& values, std::size_t stride, int target) {
    return (glb.*addView)(bytesOf(std::span(values.data(), values.size())), stride, target);
  };
  views.positions = add(arrays.positions, sizeof(Vec3f), kVertices);
  views.normals = add(arrays.normals, sizeof(Vec3f), kVertices);
  if (set == AtlasSet::Second) views.texcoords = add(arrays.texcoords, sizeof(glm::vec2), kVertices);
  views.atlas = add(arrays.atlas, sizeof(glm::vec2), kVertices);
  views.indices = add(arrays.indices, sizeof(std::uint32_t), kIndices);

  GlbJson children = GlbJson::array();
  for (std::size_t i = 0; i < ranges.size();) {
    const ObjectId object(ranges[i].object);
    const std::string name = object.valid() ? scene[object].name : "scene";
    std::vector<GlbJson> nodes;  // by page
    while (i < ranges.size() && ObjectId(ranges[i].object) == object) {
      GlbJson primitives = GlbJson::array();
      const std::optional<std::uint32_t> page = ranges[i].page;
      for (; i < ranges.size() && ObjectId(ranges[i].object) == object && ranges[i].page == page; ++i)
        primitives.push_back(primitiveOf(glb, arrays, ranges[i], views, set));
      nodes.push_back(
          {{"name", name}, {"mesh", glb.add("meshes", {{"name", name}, {"primitives", std::move(primitives)}})}});
      if (page) nodes.back()["extensions"] = pageOfNode(*page);
    }
    children.push_back(addObject(glb, name, std::move(nodes)));
  }
  root["children"] = std::move(children);
  const std::size_t rootIndex = glb.add("nodes", std::move(root));
  glb.json["scenes"] = GlbJson::array({{{"nodes", GlbJson::array({rootIndex})}}});
  return {arrays.indices.size() / 3, arrays.positions.size()};
}

}  // namespace deltalux::exporting
