#include <array>
#include <cmath>
#include <optional>

#include "io/radiance/expression_generator.hpp"
#include "io/radiance/generators.hpp"
#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

using Position = std::optional<Vec3>;  // nothing where valid(s,t) <= 0

struct SurfaceFunctions {
  Calc::Function x, y, z, valid;

  /// Nothing as well where a function has no finite value.
  Position operator()(double s, double t) const {
    if (valid && !(valid({s, t}) > 0)) return std::nullopt;
    const Vec3 p(x({s, t}), y({s, t}), z({s, t}));
    for (int axis = 0; axis < 3; ++axis) {
      if (!(std::abs(p[axis]) <= kLargestNumber)) return std::nullopt;
    }
    return p;
  }
};

/// Samples at (i/m, j/n), i in -1..m+1 and j in -1..n+1: one past each end, for the normals there.
class SampleGrid {
 public:
  SampleGrid(const SurfaceFunctions& function, int m, int n, const ObjectMaker& maker, bool withMargin) : m_(m), n_(n) {
    positions_.resize(static_cast<std::size_t>(m + 3) * static_cast<std::size_t>(n + 3));
    const int margin = withMargin ? 1 : 0;
    for (int i = -margin; i <= m + margin; ++i) {
      for (int j = -margin; j <= n + margin; ++j) {
        const double s = static_cast<double>(i) / m, t = static_cast<double>(j) / n;
        const Position p = function(s, t);
        const bool inside = i >= 0 && i <= m && j >= 0 && j <= n;
        if (!p && inside && !function.valid)
          maker.fail("the surface is not finite at s=" + std::to_string(s) + " t=" + std::to_string(t));
        positions_[slot(i, j)] = p;
      }
    }
  }

  const Position& at(int i, int j) const { return positions_[slot(i, j)]; }

  /// Cross product of the central differences (one-sided at an edge of validity); zero where there is none.
  Vec3 normal(int i, int j) const {
    const auto difference = [&](const Position& before, const Position& here, const Position& after) {
      if (!before && !after) return Vec3(0);
      return (after ? *after : *here) - (before ? *before : *here);
    };
    const Vec3 alongS = difference(at(i - 1, j), at(i, j), at(i + 1, j));
    const Vec3 alongT = difference(at(i, j - 1), at(i, j), at(i, j + 1));
    return glm::cross(alongS, alongT);
  }

  int m() const { return m_; }
  int n() const { return n_; }

 private:
  std::size_t slot(int i, int j) const {
    return static_cast<std::size_t>(i + 1) * static_cast<std::size_t>(n_ + 3) + static_cast<std::size_t>(j + 1);
  }
  int m_, n_;
  std::vector<Position> positions_;
};

struct GridIndex {
  int i, j;
};

/// The cell's corners a b c d, cut into the triangles a b c and c b d; neighbours alternate the diagonal.
std::array<GridIndex, 4> cellCorners(const SampleGrid& grid, int i, int j) {
  bool rising = j % 2 == 1;
  if (!grid.at(i, j) || !grid.at(i + 1, j + 1)) {
    rising = true;
  } else if (!grid.at(i + 1, j) || !grid.at(i, j + 1)) {
    rising = false;
  }
  if (rising) return {{{i, j}, {i + 1, j}, {i, j + 1}, {i + 1, j + 1}}};
  return {{{i + 1, j}, {i + 1, j + 1}, {i, j}, {i, j + 1}}};
}

Vec3 unitOrZero(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0 ? v / length : Vec3(0);
}

std::vector<double> coordinates(const SampleGrid& grid, std::initializer_list<GridIndex> corners) {
  std::vector<double> reals;
  for (const auto& [i, j] : corners) {
    const Vec3& p = *grid.at(i, j);
    reals.insert(reals.end(), {p.x, p.y, p.z});
  }
  return reals;
}

void addPolygons(ObjectMaker& maker, const SampleGrid& grid, bool inverted) {
  int made = 0;
  const auto add = [&](std::initializer_list<GridIndex> corners) {
    maker.add(Type::Polygon, std::to_string(++made), coordinates(grid, corners));
  };
  const auto facing = [&](GridIndex a, GridIndex b, GridIndex c) {
    const Position &p = grid.at(a.i, a.j), &q = grid.at(b.i, b.j), &r = grid.at(c.i, c.j);
    return p && q && r ? unitOrZero(glm::cross(*q - *p, *r - *p)) : Vec3(0);
  };
  for (int i = 0; i < grid.m(); ++i) {
    for (int j = 0; j < grid.n(); ++j) {
      auto [a, b, c, d] = cellCorners(grid, i, j);
      if (inverted) std::swap(b, c);
      const Vec3 first = facing(a, b, c), second = facing(c, b, d);
      constexpr double kCoplanar = 1 - 1e-12;  // [rounding]
      if (glm::dot(first, second) >= kCoplanar) {
        add({a, b, d, c});
        continue;
      }
      if (first != Vec3(0)) add({a, b, c});
      if (second != Vec3(0)) add({c, b, d});
    }
  }
}

void addSmoothMesh(ObjectMaker& maker, const SampleGrid& grid, bool inverted) {
  auto mesh = std::make_shared<Mesh>();
  std::vector<std::uint32_t> vertexOf(static_cast<std::size_t>(grid.m() + 1) * static_cast<std::size_t>(grid.n() + 1));
  const auto vertex = [&](GridIndex k) -> std::uint32_t& {
    return vertexOf[static_cast<std::size_t>(k.i) * static_cast<std::size_t>(grid.n() + 1) +
                    static_cast<std::size_t>(k.j)];
  };
  for (int i = 0; i <= grid.m(); ++i) {
    for (int j = 0; j <= grid.n(); ++j) {
      if (!grid.at(i, j)) continue;
      vertex({i, j}) = static_cast<std::uint32_t>(mesh->positions.size());
      mesh->positions.push_back(*grid.at(i, j));
      mesh->normals.push_back((inverted ? -1.0 : 1.0) * unitOrZero(grid.normal(i, j)));
    }
  }
  const auto add = [&](GridIndex a, GridIndex b, GridIndex c) {
    if (!grid.at(a.i, a.j) || !grid.at(b.i, b.j) || !grid.at(c.i, c.j)) return;
    const std::array<std::uint32_t, 3> triangle{vertex(a), vertex(b), vertex(c)};
    const auto& p = mesh->positions;
    const Vec3 normal = unitOrZero(glm::cross(p[triangle[1]] - p[triangle[0]], p[triangle[2]] - p[triangle[0]]));
    if (normal == Vec3(0)) return;
    mesh->triangles.push_back(triangle);
    for (const std::uint32_t corner : triangle) {
      if (mesh->normals[corner] == Vec3(0)) mesh->normals[corner] = normal;
    }
  };
  for (int i = 0; i < grid.m(); ++i) {
    for (int j = 0; j < grid.n(); ++j) {
      auto [a, b, c, d] = cellCorners(grid, i, j);
      if (inverted) std::swap(b, c);
      add(a, b, c), add(c, b, d);
    }
  }
  for (Vec3& normal : mesh->normals) {
    if (normal == Vec3(0)) normal = Vec3(0, 0, 1);  // a vertex of no triangle
  }
  if (!mesh->triangles.empty()) maker.addNamed(Type::GeneratedMesh, maker.name(), {}).mesh = std::move(mesh);
}

}  // namespace

std::vector<RadObject> gensurf(const GeneratorInput& input) {
  ObjectMaker maker(input, "gensurf material name 'x(s,t)' 'y(s,t)' 'z(s,t)' m n [-s] [-i] [-e expression] [-f file]");
  Calc calc(input.where);
  maker.readMaterialAndName();
  std::array<std::string, 3> texts;
  for (std::string& text : texts) text = maker.word("x(s,t) y(s,t) z(s,t)");
  const std::string rows = maker.word("m"), columns = maker.word("n");
  bool smooth = false, inverted = false;
  while (!maker.done()) {
    const std::string option = maker.word("option");
    if (option == "-s") {
      smooth = true;
    } else if (option == "-i") {
      inverted = true;
    } else if (!readDefinition(option, maker, calc)) {
      maker.fail("gensurf has no option '" + option + "' here");
    }
  }
  const int m = segmentCount(rows, maker, calc), n = segmentCount(columns, maker, calc);
  if (static_cast<double>(m) * n > static_cast<double>(input.mostObjects)) maker.fail("too many cells");
  const std::vector<std::string> st{"s", "t"};
  SurfaceFunctions functions{calc.function(st, texts[0]), calc.function(st, texts[1]), calc.function(st, texts[2]),
                             calc.userFunction("valid", 2)};
  const SampleGrid grid(functions, m, n, maker, smooth);
  if (smooth) {
    addSmoothMesh(maker, grid, inverted);
  } else {
    addPolygons(maker, grid, inverted);
  }
  return maker.take();
}

}  // namespace deltalux::io::radiance
