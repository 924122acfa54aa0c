#include "io/obj/faces.hpp"

#include <algorithm>
#include <cmath>

#include "io/triangulated.hpp"
#include "scene/hole_winding.hpp"

namespace deltalux::io {

namespace {

using Face = std::vector<ObjCorner>;

Face withoutRepetitions(const Face& face, const ObjVertices& vertices) {
  Face kept;
  const auto place = [&](const ObjCorner& corner) {
    return vertices.positions[static_cast<std::size_t>(corner.position)];
  };
  for (const ObjCorner& corner : face) {
    if (kept.empty() || place(kept.back()) != place(corner)) kept.push_back(corner);
  }
  while (kept.size() > 1 && place(kept.front()) == place(kept.back())) kept.pop_back();
  return kept;
}

std::vector<Vec3> outlineOf(const Face& face, const ObjVertices& vertices) {
  std::vector<Vec3> outline;
  for (const ObjCorner& corner : face) outline.push_back(vertices.positions[static_cast<std::size_t>(corner.position)]);
  return outline;
}

// Holes joined by seams turned as triangles need them.
Face withHolesWound(const Face& face, const ObjVertices& vertices) {
  return scene::inOrder(face, scene::windingOrder(outlineOf(face, vertices)));
}

// Puts corners into a mesh, equal ones once.
class CornerTable {
 public:
  CornerTable(const ObjVertices& vertices, bool textured, bool shaded, Mesh& mesh)
      : vertices_(vertices), textured_(textured), shaded_(shaded), mesh_(mesh) {}

  std::uint32_t put(ObjCorner corner) {
    if (!textured_) corner.texcoord = -1;
    if (!shaded_) corner.normal = -1;
    const auto [entry, isNew] = indices_.try_emplace(corner, static_cast<std::uint32_t>(mesh_.positions.size()));
    if (!isNew) return entry->second;
    mesh_.positions.push_back(vertices_.positions[static_cast<std::size_t>(corner.position)]);
    if (shaded_) mesh_.normals.push_back(glm::normalize(vertices_.normals[static_cast<std::size_t>(corner.normal)]));
    if (textured_) {
      const Vec2 at = corner.texcoord < 0 ? Vec2(0) : vertices_.texcoords[static_cast<std::size_t>(corner.texcoord)];
      mesh_.texcoords.push_back({at.x, 1 - at.y});
    }
    return entry->second;
  }

 private:
  const ObjVertices& vertices_;
  bool textured_, shaded_;
  Mesh& mesh_;
  std::map<ObjCorner, std::uint32_t> indices_;
};

bool allShaded(const std::vector<Face>& faces, const ObjVertices& vertices) {
  return std::all_of(faces.begin(), faces.end(), [&](const Face& face) {
    return std::all_of(face.begin(), face.end(), [&](const ObjCorner& corner) {
      if (corner.normal < 0) return false;
      const double length = glm::length(vertices.normals[static_cast<std::size_t>(corner.normal)]);
      return length > 1e-100 && length < 1e100;
    });
  });
}

}  // namespace

Mesh meshOf(const ObjVertices& vertices, const std::vector<Face>& faces, bool textured,
            std::map<std::string, std::size_t>& ignored) {
  Mesh mesh;
  CornerTable table(vertices, textured, allShaded(faces, vertices), mesh);
  for (const Face& given : faces) {
    const Face face = withHolesWound(withoutRepetitions(given, vertices), vertices);
    bool any = false;
    const std::vector<Vec3> outline = outlineOf(face, vertices);
    for (const auto& [a, b, c] : triangulated(outline)) {
      if (!hasArea(outline[a], outline[b], outline[c])) continue;
      mesh.triangles.push_back({table.put(face[a]), table.put(face[b]), table.put(face[c])});
      any = true;
    }
    if (!any) ++ignored["faces without area"];
  }
  return mesh;
}

}  // namespace deltalux::io
