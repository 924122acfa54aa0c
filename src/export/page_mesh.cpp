#include "export/page_mesh.hpp"

#include <algorithm>
#include <deltalux/error.hpp>
#include <map>
#include <numeric>

#include "scene/texture_tint.hpp"

namespace deltalux::exporting {

namespace {

using Kind = PageDraw::Kind;

constexpr double kMirrorArea = 0.05;        // of a flat mirror that gets a picture of its own, at least [m2] [shown]
constexpr double kMirrorReflectance = 0.3;  // the same; below it is drawn like gloss [shown]

/// The same triangles in the same order, whichever vertices they share.
bool sameShape(const SurfaceMesh& a, const SurfaceMesh& b) {
  return std::ranges::equal(a.triangles, b.triangles, [&](std::uint32_t v, std::uint32_t w) {
    return a.vertices[v].position == b.vertices[w].position;
  });
}

/// A side's vertices that are told apart in any group's mesh.
struct SharedVertices {
  std::vector<std::uint32_t> triangles;
  std::vector<std::vector<std::uint32_t>> of;  // by group and vertex: the group's own
};

SharedVertices sharedVertices(const std::vector<SolutionMesh>& meshes, std::size_t side) {
  SharedVertices shared{meshes.front().surfaces[side]->triangles, {{}}};
  shared.of[0].resize(meshes.front().surfaces[side]->vertices.size());
  std::iota(shared.of[0].begin(), shared.of[0].end(), 0u);
  for (std::size_t g = 1; g < meshes.size(); ++g) {
    const std::vector<std::uint32_t>& own = meshes[g].surfaces[side]->triangles;
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs(own.size());
    for (std::size_t i = 0; i < own.size(); ++i) pairs[i] = {shared.triangles[i], own[i]};
    std::vector<std::pair<std::uint32_t, std::uint32_t>> known = pairs;
    std::ranges::sort(known);
    known.erase(std::unique(known.begin(), known.end()), known.end());
    for (std::size_t i = 0; i < own.size(); ++i)
      shared.triangles[i] = static_cast<std::uint32_t>(std::ranges::lower_bound(known, pairs[i]) - known.begin());
    for (std::vector<std::uint32_t>& vertices : shared.of) {
      std::vector<std::uint32_t> now;
      for (const auto& pair : known) now.push_back(vertices[pair.first]);
      vertices = std::move(now);
    }
    shared.of.emplace_back();
    for (const auto& pair : known) shared.of.back().push_back(pair.second);
  }
  return shared;
}

bool sameShape(const SolutionMesh& a, const SolutionMesh& b) {
  return std::ranges::equal(a.surfaces, b.surfaces, [](const auto& s, const auto& t) {
    return !s == !t && (!s || s == t || sameShape(*s, *t));
  });
}

std::optional<PagePane> paneOf(const Material& m) {
  if (const auto* body = std::get_if<Dielectric>(&m.surface)) return PagePane{Rgb(1.0f), body->ior};
  if (!passesStraight(m)) return std::nullopt;
  const auto* glass = std::get_if<ThinGlass>(&m.surface);
  if (glass && m.coverage >= 1) return PagePane{glass->transmissivity, glass->ior};
  return PagePane{straightTransmittance(m, 1), 1.0f};
}

/// What is reflected otherwise than diffusely, about; of glass as it is seen at a slant.
Rgb glossOf(const Material& m, bool front) {
  constexpr double kSlant = 0.8;  // cosine [shown]
  struct Visitor {
    bool front;
    Rgb operator()(const Opaque& s) const { return s.specular.reflectance; }
    Rgb operator()(const Mirror& s) const { return front ? s.reflectance : Rgb(0.0f); }
    Rgb operator()(const ThinGlass& s) const { return deltalux::reflectance(s, kSlant); }
    Rgb operator()(const Dielectric& s) const {
      return Rgb(static_cast<float>(fresnelDielectric(kSlant, double(s.ior))));
    }
    Rgb operator()(const Trans& s) const { return s.reflection.reflectance; }
  };
  return m.coverage * std::visit(Visitor{front}, m.surface);
}

/// A flat mirror that is large enough for a picture of its own.
std::optional<PageMirror> mirrorOf(const Scene& scene, PrimitiveId p, bool front) {
  const Material& m = scene.materialOf(p);
  const auto* polygon = std::get_if<Polygon>(&scene[p].shape);
  const auto* opaque = std::get_if<Opaque>(&m.surface);
  const bool polished = opaque && opaque->specular.roughness <= 0;
  if (!polygon || !(std::holds_alternative<Mirror>(m.surface) || polished)) return std::nullopt;
  if (gray(glossOf(m, front)) < kMirrorReflectance) return std::nullopt;
  if (polygon->area * scene.metresPerUnit * scene.metresPerUnit < kMirrorArea) return std::nullopt;
  const Vec3 n = front ? polygon->normal : -polygon->normal;
  return PageMirror{glm::dvec4(n, glm::dot(n, polygon->origin)), polygon->vertices};
}

/// By primitive: the group that its emission belongs to.
std::vector<std::optional<std::size_t>> emitters(const Scene& scene, const std::vector<LightGroup>& groups) {
  std::vector<std::optional<std::size_t>> of(scene.primitives.size());
  for (std::size_t g = 0; g < groups.size(); ++g)
    for (const LightId light : groups[g].lights)
      if (const auto* area = std::get_if<AreaLight>(&scene[light].emitter)) of[area->primitive.index()] = g;
  return of;
}

class Builder {
 public:
  Builder(const std::vector<LightGroup>& groups, const std::vector<SolutionMesh>& meshes)
      : meshes_(meshes), scene_(*meshes.front().scene), emitters_(emitters(scene_, groups)) {}

  PageMesh build() {
    const auto& surfaces = meshes_.front().surfaces;
    for (std::size_t s = 0; s < surfaces.size(); ++s)
      if (surfaces[s] && !surfaces[s]->triangles.empty()) addSide(s, *surfaces[s]);
    for (auto& [draw, sides] : draws_) addDraw(draw, sides);
    for (auto& [draw, side] : mirrors_) addDraw(draw, {side});
    return std::move(page_);
  }

 private:
  /// Draws of one kind, texture and pane are one.
  struct Key {
    Kind kind;
    std::size_t texture;
    std::array<float, 4> pane;
    auto operator<=>(const Key&) const = default;
  };

  void addSide(std::size_t s, const SurfaceMesh& side) {
    SharedVertices shared = sharedVertices(meshes_, s);
    const PageMesh::Side placed{static_cast<std::uint32_t>(s), static_cast<std::uint32_t>(page_.vertices.size()),
                                static_cast<std::uint32_t>(shared.of[0].size()), materialAt(s, side)};
    for (const std::uint32_t v : shared.of[0]) page_.vertices.push_back(side.vertices[v]);
    page_.source.resize(meshes_.size());
    for (std::size_t g = 0; g < meshes_.size(); ++g)
      page_.source[g].insert(page_.source[g].end(), shared.of[g].begin(), shared.of[g].end());
    triangles_.push_back(std::move(shared.triangles));
    const std::size_t number = page_.sides.size();
    page_.sides.push_back(placed);
    const std::optional<PagePane> pane = paneOf(scene_.materialOf(side.primitive));
    const TextureId texture = scene::diffuseTexture(scene_, side.primitive);
    const auto mirror = mirrorOf(scene_, side.primitive, side.front);
    if (mirror && !pane)
      mirrors_.push_back({PageDraw{Kind::Mirror, {}, {}, mirror, 0, 0}, number});
    else
      enter({pane ? Kind::Pane : Kind::Opaque, texture, pane, {}, 0, 0}, number);
    if (!isBlack(side.transmittance)) enter({Kind::Behind, {}, {}, {}, 0, 0}, number);
  }

  void enter(const PageDraw& draw, std::size_t side) {
    Key key{draw.kind, draw.texture.valid() ? draw.texture.index() + 1 : 0, {0, 0, 0, 0}};
    if (draw.pane)
      key.pane = {draw.pane->transmissivity.r, draw.pane->transmissivity.g, draw.pane->transmissivity.b,
                  draw.pane->index};
    const auto [at, added] = known_.try_emplace(key, draws_.size());
    if (added) draws_.push_back({draw, {}});
    draws_[at->second].second.push_back(side);
  }

  void addDraw(PageDraw draw, const std::vector<std::size_t>& sides) {
    draw.first = static_cast<std::uint32_t>(page_.triangles.size());
    for (const std::size_t number : sides) {
      const PageMesh::Side& placed = page_.sides[number];
      for (const std::uint32_t i : triangles_[number]) page_.triangles.push_back(placed.first + i);
    }
    draw.count = static_cast<std::uint32_t>(page_.triangles.size()) - draw.first;
    page_.draws.push_back(std::move(draw));
  }

  /// Radiance counts once: of the group that the light belongs to, or of the solution where no light is known of.
  std::vector<PageEmission> emissionOf(std::size_t s, const SurfaceMesh& side) const {
    const auto group = emitters_[side.primitive.index()];
    const Rgb L = group ? meshes_[*group].surfaces[s]->radiance : side.radiance;
    if (isBlack(L)) return {};
    return {PageEmission{0, group, L}};
  }

  std::uint32_t materialAt(std::size_t s, const SurfaceMesh& side) {
    const std::vector<PageEmission> emission = emissionOf(s, side);
    PageMaterial material{side.albedo, side.transmittance, glossOf(scene_.materialOf(side.primitive), side.front), 0};
    if (!emission.empty()) {
      const PageEmission& e = emission.front();
      const std::array<float, 4> key{e.radiance.r, e.radiance.g, e.radiance.b,
                                     e.group ? static_cast<float>(*e.group) : -1.0f};
      material.emitter =
          emitterNumbers_.try_emplace(key, static_cast<std::uint32_t>(emitterNumbers_.size() + 1)).first->second;
    }
    const auto same = std::ranges::find(page_.materials, material);
    if (same != page_.materials.end()) return static_cast<std::uint32_t>(same - page_.materials.begin());
    const auto number = static_cast<std::uint32_t>(page_.materials.size());
    page_.materials.push_back(material);
    for (PageEmission e : emission) e.material = number, page_.emission.push_back(e);
    return number;
  }

  const std::vector<SolutionMesh>& meshes_;
  const Scene& scene_;
  const std::vector<std::optional<std::size_t>> emitters_;
  PageMesh page_;
  std::vector<std::vector<std::uint32_t>> triangles_;  // by side of the page, numbered within it
  std::map<Key, std::size_t> known_;
  std::vector<std::pair<PageDraw, std::vector<std::size_t>>> draws_;
  std::vector<std::pair<PageDraw, std::size_t>> mirrors_;
  std::map<std::array<float, 4>, std::uint32_t> emitterNumbers_;
};

/// By vertex of the page's mesh.
std::vector<Rgb> readVertices(const PageMesh& page, std::size_t group, const SolutionMesh& mesh, const auto& light) {
  std::vector<Rgb> out;
  out.reserve(page.vertices.size());
  for (const PageMesh::Side& side : page.sides)
    for (std::uint32_t i = side.first; i < side.first + side.count; ++i)
      out.push_back(light(mesh.surfaces[side.side]->vertices[page.source[group][i]]));
  return out;
}

}  // namespace

PageMesh pageMesh(const std::vector<LightGroup>& groups, const std::vector<SolutionMesh>& meshes) {
  for (std::size_t g = 1; g < meshes.size(); ++g)
    if (!sameShape(meshes.front(), meshes[g]))
      throw InputError(
          "", 0,
          "the lights '" + groups.front().name + "' and '" + groups[g].name + "' of the solution have different meshes",
          "solve the scene again");
  return Builder(groups, meshes).build();
}

std::vector<Rgb> pageLayer(const PageMesh& page, std::size_t group, const SolutionMesh& mesh) {
  return readVertices(page, group, mesh, [](const MeshVertex& v) { return v.direct + v.indirect + v.particle; });
}

std::vector<Rgb> pageDirect(const PageMesh& page, std::size_t group, const SolutionMesh& mesh) {
  return readVertices(page, group, mesh, [](const MeshVertex& v) { return v.direct; });
}

std::vector<std::uint32_t> sideOfVertices(const PageMesh& mesh) {
  std::vector<std::uint32_t> of(mesh.vertices.size());
  for (std::uint32_t s = 0; s < mesh.sides.size(); ++s)
    std::fill_n(of.begin() + mesh.sides[s].first, mesh.sides[s].count, s);
  return of;
}

std::vector<SideTriangles> trianglesOfSides(const PageMesh& mesh) {
  const std::vector<std::uint32_t> sideOf = sideOfVertices(mesh);
  std::vector<SideTriangles> triangles(mesh.sides.size());
  for (const PageDraw& d : mesh.draws)
    if (d.kind != PageDraw::Kind::Behind)
      for (std::uint32_t i = d.first; i < d.first + d.count; i += 3)
        triangles[sideOf[mesh.triangles[i]]].push_back(
            {mesh.triangles[i], mesh.triangles[i + 1], mesh.triangles[i + 2]});
  return triangles;
}

void replaceTriangles(PageMesh& mesh, const std::vector<SideTriangles>& of, const std::vector<std::uint32_t>& firsts) {
  const std::vector<std::uint32_t> sideOf = sideOfVertices(mesh);
  std::vector<std::uint32_t> triangles;
  for (PageDraw& d : mesh.draws) {
    std::optional<std::uint32_t> last;
    const std::uint32_t from = d.first, end = d.first + d.count;
    d.first = static_cast<std::uint32_t>(triangles.size());
    for (std::uint32_t i = from; i < end; i += 3) {
      const std::uint32_t s = sideOf[mesh.triangles[i]];
      if (s == last) continue;
      last = s;
      for (const auto& t : of[s])
        for (const std::uint32_t v : t) triangles.push_back(firsts[s] + v);
    }
    d.count = static_cast<std::uint32_t>(triangles.size()) - d.first;
  }
  mesh.triangles = std::move(triangles);
}

}  // namespace deltalux::exporting
