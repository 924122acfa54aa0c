#include "export/page_data.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "export/byte_planes.hpp"
#include "export/page_points.hpp"
#include "export/page_texture.hpp"
#include "export/rgb9e5.hpp"
#include "export/sections.hpp"

namespace deltalux::exporting {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kSteps = 1 << 22;  // of positions over the longest side of the scene [layout]

constexpr float kFaint = 0.1f, kVeryFaint = 0.01f, kHardlyThere = 3e-3f;  // of all light: kept to 0.8, 1.6, 6 % [shown]
constexpr std::uint8_t kFaintSlack = 2, kVeryFaintSlack = 4, kHardlyThereSlack = 16,
                       kFirstPictureSlack = 8;  // steps of a mantissa [layout]

template <class V>
Json three(const V& v) {
  return {v.x, v.y, v.z};
}

Json groupJson(const PageGroup& group) {
  static constexpr const char* kKinds[] = {"lamp", "sun", "sky"};
  Json lights = Json::array();
  for (const PageLight& l : group.lights)
    lights.push_back({{"name", l.name}, {"base", three(l.base)}, {"off", l.switchedOff}});
  return {{"name", group.name},
          {"kind", kKinds[static_cast<int>(group.kind)]},
          {"weight", three(group.weight)},
          {"colour", three(group.colour)},
          {"lights", lights}};
}

Json viewJson(const View& view) {
  return {{"name", view.name},
          {"position", three(view.position)},
          {"direction", three(glm::normalize(view.direction))},
          {"up", three(glm::normalize(view.up))},
          {"horizontal", view.horizontal},
          {"angle", view.vertical}};
}

/// Where there is no view: from a corner, onto all of it.
View overview(const Scene& scene, const Box& box) {
  View view;
  view.name = "overview";
  const Vec3 side = glm::normalize(glm::cross(scene.up, std::abs(scene.up.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0)));
  const Vec3 from = glm::normalize(side + 0.6 * glm::cross(scene.up, side) + 0.5 * scene.up);
  view.direction = -from, view.up = scene.up;
  view.position = box.center() + 1.2 * box.diagonal() * from;
  return view;
}

Box boxOf(const PageMesh& mesh) {
  Box box;
  for (const MeshVertex& v : mesh.vertices) box.extend(Vec3(v.position));
  return box;
}

void addPositions(Json& header, Sections& sections, const PageMesh& mesh, const Box& box) {
  const Vec3 size = box.extent();
  const double step = std::max({size.x, size.y, size.z}) / kSteps;
  header["lower"] = three(box.lower), header["step"] = step;
  std::string planes;
  std::vector<std::int32_t> whole(mesh.vertices.size());
  for (int c = 0; c < 3; ++c) {
    std::ranges::transform(mesh.vertices, whole.begin(), [&](const MeshVertex& v) {
      return static_cast<std::int32_t>(std::lround((double(v.position[c]) - box.lower[c]) / std::max(step, 1e-300)));
    });
    planes += differencePlanes(whole);
  }
  sections.add("positions", planes);
}

/// The octahedron's two coordinates of a unit vector, each in [-1, 1].
glm::vec2 octahedral(const Vec3f& n) {
  const glm::vec2 p = glm::vec2(n) / (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  if (n.z >= 0) return p;
  return {(1 - std::abs(p.y)) * (p.x < 0 ? -1.0f : 1.0f), (1 - std::abs(p.x)) * (p.y < 0 ? -1.0f : 1.0f)};
}

void addVertices(Sections& sections, const PageMesh& mesh) {
  const std::size_t count = mesh.vertices.size();
  std::string normals(2 * count, '\0');
  for (std::size_t i = 0; i < count; ++i) {
    const glm::vec2 p = octahedral(mesh.vertices[i].normal);
    normals[i] = static_cast<char>(std::lround(127 * p.x)),
    normals[count + i] = static_cast<char>(std::lround(127 * p.y));
  }
  sections.add("normals", normals);
  std::vector<std::uint32_t> sides;
  for (const PageMesh::Side& s : mesh.sides) sides.insert(sides.end(), {s.count, s.material});
  sections.addArray("sides", sides);
  if (std::ranges::none_of(mesh.draws, [](const PageDraw& d) { return d.texture.valid(); })) return;
  std::vector<glm::vec2> uvs;
  for (const MeshVertex& v : mesh.vertices) uvs.push_back(v.uv);
  sections.addArray("uvs", uvs);
}

void addDraws(Json& header, Sections& sections, const PageMesh& mesh, const Scene& scene) {
  static constexpr const char* kKinds[] = {"opaque", "mirror", "behind", "pane"};
  sections.add("triangles", differencePlanes(std::vector<std::int32_t>(mesh.triangles.begin(), mesh.triangles.end())));
  header["draws"] = header["textures"] = Json::array();
  std::vector<TextureId> textures;
  for (const PageDraw& d : mesh.draws) {
    Json draw = {{"kind", kKinds[static_cast<int>(d.kind)]}, {"first", d.first}, {"count", d.count}, {"texture", -1}};
    if (d.texture.valid()) {
      const auto at = std::ranges::find(textures, d.texture);
      draw["texture"] = at - textures.begin();
      if (at == textures.end()) textures.push_back(d.texture);
    }
    if (d.pane) draw["transmissivity"] = three(d.pane->transmissivity), draw["index"] = d.pane->index;
    if (d.mirror) {
      draw["plane"] = {d.mirror->plane.x, d.mirror->plane.y, d.mirror->plane.z, d.mirror->plane.w};
      draw["corners"] = Json::array();
      for (const Vec3& p : d.mirror->corners) draw["corners"].push_back(three(p));
    }
    header["draws"].push_back(std::move(draw));
  }
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const PageTexture t = pageTexture(scene.textures[textures[i].index()]);
    header["textures"].push_back({{"width", t.width}, {"height", t.height}});
    sections.add("texture" + std::to_string(i), t.rgba);
  }
}

/// A group that is faint beside all light at a vertex is kept less exactly there.
void addLayers(Sections& sections, const std::vector<std::vector<Rgb>>& layers) {
  if (layers.empty()) return;
  std::vector<float> total(layers.front().size(), 0.0f);
  for (const auto& layer : layers)
    for (std::size_t v = 0; v < total.size(); ++v) total[v] += maxChannel(layer[v]);
  for (std::size_t g = 0; g < layers.size(); ++g) {
    std::vector<std::uint32_t> words;
    std::vector<std::uint8_t> slack;
    for (std::size_t v = 0; v < total.size(); ++v) {
      const float share = maxChannel(layers[g][v]) / std::max(total[v], 1e-30f);
      words.push_back(packRgb9e5(layers[g][v]));
      slack.push_back(share < kHardlyThere ? kHardlyThereSlack
                      : share < kVeryFaint ? kVeryFaintSlack
                      : share < kFaint     ? kFaintSlack
                                           : 0);
    }
    sections.add("layer" + std::to_string(g), rgb9e5Planes(words, slack));
  }
}

/// What the first picture shows, before the groups are told apart.
void addSum(Sections& sections, const PageData& page) {
  std::vector<std::uint32_t> words;
  for (std::size_t v = 0; v < page.mesh.vertices.size(); ++v) {
    Rgb sum(0.0f);
    for (std::size_t g = 0; g < page.layers.size(); ++g) sum += page.groups[g].weight * page.layers[g][v];
    words.push_back(packRgb9e5(sum));
  }
  sections.add("sum", rgb9e5Planes(words, std::vector<std::uint8_t>(words.size(), kFirstPictureSlack)));
}

int groupNumber(const std::optional<std::size_t>& group) { return group ? static_cast<int>(*group) : -1; }

void addMaterials(Json& header, const PageMesh& mesh) {
  header["materials"] = header["emission"] = Json::array();
  header["specular"] = std::ranges::any_of(mesh.materials, [](const PageMaterial& m) { return !isBlack(m.gloss); });
  for (const PageMaterial& m : mesh.materials)
    header["materials"].push_back(
        {{"rho", three(m.reflectance)}, {"tau", three(m.transmittance)}, {"gloss", three(m.gloss)}});
  for (const PageEmission& e : mesh.emission)
    header["emission"].push_back({e.material, groupNumber(e.group), e.radiance.r, e.radiance.g, e.radiance.b});
}

void addCaustics(Json& header, Sections& sections, const std::vector<std::optional<PageCaustics>>& sheets) {
  header["caustics"] = Json::array();
  for (std::size_t g = 0; g < sheets.size(); ++g) {
    if (!sheets[g]) continue;
    const PageCaustics& c = *sheets[g];
    const std::string name = "caustic" + std::to_string(header["caustics"].size()) + ".";
    header["caustics"].push_back(
        {{"group", g}, {"width", c.width}, {"height", c.height}, {"vertexCount", c.positions.size()}});
    sections.addArray(name + "positions", c.positions), sections.addArray(name + "texcoords", c.texcoords);
    sections.addArray(name + "materials", c.materials), sections.addArray(name + "triangles", c.triangles);
    sections.addArray(name + "texels", c.texels), sections.addArray(name + "shows", c.shows);
  }
}

void addSkies(Json& header, Sections& sections, const PageData& page) {
  header["skySize"] = {kSkyWidth, kSkyHeight};
  header["skies"] = header["suns"] = Json::array();
  for (std::size_t i = 0; i < page.skies.size(); ++i) {
    header["skies"].push_back({{"group", groupNumber(page.skies[i].group)}});
    sections.addArray("sky" + std::to_string(i), page.skies[i].radiance);
  }
  for (const PageSun& s : page.suns)
    header["suns"].push_back({{"group", s.group},
                              {"direction", three(s.direction)},
                              {"angularRadius", s.angularRadius},
                              {"radiance", three(s.radiance)}});
}

void addPoints(Json& header, Sections& sections, const PageData& page) {
  const std::vector<ProbePoint> points = pointsOf(page.grids);
  Json grids = Json::array();
  std::size_t first = 0;
  for (const PageGrid& grid : page.grids) {
    Json numbers = Json::array();
    for (std::size_t i = 0; i < grid.points.size(); ++i) numbers.push_back(first + i);
    grids.push_back({{"name", grid.name}, {"points", numbers}});
    first += grid.points.size();
  }
  header["points"] = {{"count", points.size()}, {"grids", grids}};
  if (points.empty()) return;
  std::vector<Vec3f> places, light;
  for (const ProbePoint& p : points) places.emplace_back(p.position), places.emplace_back(p.normal);
  for (const std::vector<Rgb>& group : page.pointLight) light.insert(light.end(), group.begin(), group.end());
  sections.addArray("points.places", places), sections.addArray("points.light", light);
}

}  // namespace

PageBytes pageBytes(const PageData& page, const Scene& scene) {
  const Box box = boxOf(page.mesh);
  Sections sections, later;
  Json header = {{"format", 1},
                 {"version", DELTALUX_VERSION},
                 {"title", page.title},
                 {"efficacy", page.efficacy},
                 {"ev", page.ev},
                 {"byLight", page.byLight},
                 {"metresPerUnit", scene.metresPerUnit},
                 {"origin", three(scene.origin)},
                 {"up", three(scene.up)},
                 {"vertexCount", page.mesh.vertices.size()},
                 {"indexCount", page.mesh.triangles.size()}};
  header["groups"] = header["views"] = Json::array();
  for (const PageGroup& group : page.groups) header["groups"].push_back(groupJson(group));
  for (const View& view : page.views) header["views"].push_back(viewJson(view));
  header["overview"] = viewJson(overview(scene, box));
  addPositions(header, sections, page.mesh, box);
  addVertices(sections, page.mesh);
  addDraws(header, sections, page.mesh, scene);
  addMaterials(header, page.mesh);
  const bool several = page.layers.size() > 1;
  if (several) addSum(sections, page);
  addLayers(several ? later : sections, page.layers);
  addCaustics(header, sections, page.caustics);
  addSkies(header, sections, page);
  addPoints(header, sections, page);
  header["sections"] = sections.table(), header["later"] = later.table();
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string out(reinterpret_cast<const char*>(&length), sizeof(length));
  out += text;
  out.resize((out.size() + 3) / 4 * 4, '\0');
  return {out + sections.bytes(), later.bytes()};
}

}  // namespace deltalux::exporting
