#include "io/mitsuba/shapes.hpp"

#include "io/import_file.hpp"
#include "io/obj.hpp"
#include "io/planar_faces.hpp"
#include "io/ply.hpp"

namespace deltalux::io::mitsuba {

namespace {

Shape quad(const Vec3& centre, const Vec3& u, const Vec3& v) {
  return *makePolygon({centre - u - v, centre + u - v, centre + u + v, centre - u + v});
}

std::vector<Shape> cube() {
  std::vector<Shape> faces;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {1.0, -1.0}) {
      Vec3 n(0), u(0), v(0);
      n[axis] = side, u[(axis + 1) % 3] = 1, v[(axis + 2) % 3] = side;
      faces.push_back(quad(n, u, v));
    }
  return faces;
}

std::filesystem::path fileOf(const Context& context, const Properties& p) {
  const auto file = p.word("filename");
  if (!file) p.fail(p.element(), "names no file");
  return resolveReference(*file, context.folder, context.file, p.element().line, false);
}

std::vector<Shape> objFile(const Context& context, const Properties& p) {
  const auto path = fileOf(context, p);
  std::vector<Shape> shapes;
  for (Primitive& primitive : readObj(readInputFile(path), path.string(), path.parent_path(), {}).scene.primitives) {
    if (auto* mesh = std::get_if<Mesh>(&primitive.shape)) mesh->texcoords.clear();
    shapes.push_back(std::move(primitive.shape));
  }
  return shapes;
}

std::vector<Shape> plyFile(const Context& context, const Properties& p) {
  const auto path = fileOf(context, p);
  Mesh mesh = readPly(readInputFile(path), path.string(), context.report.ignored);
  mesh.texcoords.clear();
  if (p.flag("face_normals", false)) mesh.normals.clear();
  return mesh.triangles.empty() ? std::vector<Shape>{} : planarFaces(std::move(mesh));
}

}  // namespace

std::optional<std::vector<Shape>> shapesOf(const Context& context, const Properties& p) {
  const std::string type = p.type();
  const auto positive = [&](double radius) {
    if (!(radius > 1e-12 && radius <= kMostNumber)) p.fail(p.element(), "its radius is not above 0");
    return radius;
  };
  if (type == "rectangle") return std::vector<Shape>{quad(Vec3(0), {1, 0, 0}, {0, 1, 0})};
  if (type == "cube") return cube();
  if (type == "disk") return std::vector<Shape>{Ring{Vec3(0), {0, 0, 1}, 0, 1}};
  if (type == "sphere")
    return std::vector<Shape>{Sphere{p.point("center", Vec3(0)), positive(p.number("radius", 1)), false}};
  if (type == "cylinder") {
    const Vec3 p0 = p.point("p0", Vec3(0)), p1 = p.point("p1", Vec3(0, 0, 1));
    if (!(glm::distance(p0, p1) > 1e-12)) p.fail(p.element(), "its ends are one point");
    return std::vector<Shape>{Cylinder{p0, p1, positive(p.number("radius", 1)), false}};
  }
  if (type == "obj") return objFile(context, p);
  if (type == "ply") return plyFile(context, p);
  return std::nullopt;
}

}  // namespace deltalux::io::mitsuba
