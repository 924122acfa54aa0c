#include <algorithm>
#include <array>

#include "io/radiance/generators.hpp"
#include "io/radiance/object_maker.hpp"

namespace deltalux::io::radiance {

namespace {

// A corner of the box is three bits, x lowest; a vertex of a bevelled box is a corner and three more bits that tell
// along which axes it stands inset by the bevel. Names spell vertices with one character each.
using Corner = unsigned;
constexpr std::string_view kVertexNames = "0123456789._ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

struct BoxFace {
  std::array<Corner, 4> corners;
  unsigned insets;  // of the face's own vertices when edges are bevelled: the axes along it
};
constexpr std::array<BoxFace, 6> kFaces{
    // [defined]
    {{{1, 5, 4, 0}, 5}, {{4, 6, 2, 0}, 6}, {{2, 3, 1, 0}, 3}, {{3, 2, 6, 7}, 5}, {{5, 1, 3, 7}, 6}, {{6, 4, 5, 7}, 3}}};
constexpr std::array<std::array<Corner, 2>, 12> kEdges{
    {{0, 1}, {0, 4}, {0, 2}, {3, 1}, {3, 2}, {3, 7}, {5, 1}, {5, 4}, {5, 7}, {6, 2}, {6, 4}, {6, 7}}};  // [defined]

class BoxBuilder {
 public:
  BoxBuilder(ObjectMaker& maker, const Vec3& size, double bevel, bool inward)
      : maker_(maker), size_(size), bevel_(bevel), inward_(inward) {}

  void faces() {
    for (const BoxFace& face : kFaces) {
      std::vector<unsigned> vertices;
      for (const Corner corner : face.corners) vertices.push_back(vertex(corner, bevel_ > 0 ? face.insets : 0));
      polygon(std::move(vertices));
    }
  }

  void bevelledEdges() {
    for (const auto& [a, b] : kEdges) {
      const unsigned along = a ^ b, first = along == 1 ? 2 : 1, second = 7 ^ along ^ first;
      polygon(
          {vertex(a, along | first), vertex(b, along | first), vertex(b, along | second), vertex(a, along | second)});
    }
    for (Corner c = 0; c < 8; ++c) polygon({vertex(c, 3), vertex(c, 5), vertex(c, 6)});
  }

  void roundedEdges() {
    for (const auto& [a, b] : kEdges) {
      const unsigned v0 = vertex(a, 7), v1 = vertex(b, 7);
      maker_.add(inward_ ? Type::Tube : Type::Cylinder, names({v0, v1}), flattened({at(v0), at(v1)}, {bevel_}));
    }
    for (Corner c = 0; c < 8; ++c) {
      const unsigned v = vertex(c, 7);
      maker_.add(inward_ ? Type::Bubble : Type::Sphere, names({v}), flattened({at(v)}, {bevel_}));
    }
  }

 private:
  static unsigned vertex(Corner corner, unsigned insets) { return insets << 3 | corner; }

  Vec3 at(unsigned vertex) const {
    Vec3 p;
    for (int axis = 0; axis < 3; ++axis) {
      const double inset = (vertex >> (3 + axis) & 1) != 0 ? bevel_ : 0.0;
      p[axis] = (vertex >> axis & 1) != 0 ? size_[axis] - inset : inset;
    }
    return p;
  }

  static std::string names(const std::vector<unsigned>& vertices) {
    std::string text;
    for (const unsigned v : vertices) text += kVertexNames[v];
    return text;
  }

  void polygon(std::vector<unsigned> vertices) {
    std::string name = names(vertices);
    const Vec3 normal = glm::cross(at(vertices[1]) - at(vertices[0]), at(vertices[2]) - at(vertices[0]));
    const bool facesOut = glm::dot(normal, at(vertices[0]) - 0.5 * size_) > 0;
    if (facesOut == inward_) std::reverse(vertices.begin(), vertices.end());
    std::vector<double> reals;
    for (const unsigned v : vertices) {
      const Vec3 p = at(v);
      reals.insert(reals.end(), {p.x, p.y, p.z});
    }
    maker_.add(Type::Polygon, name, std::move(reals));
  }

  ObjectMaker& maker_;
  Vec3 size_;
  double bevel_;
  bool inward_;
};

}  // namespace

std::vector<RadObject> genbox(const GeneratorInput& input) {
  ObjectMaker maker(input, "genbox material name xsize ysize zsize [-i] [-b bevel | -r radius]");
  maker.readMaterialAndName();
  Vec3 size;
  for (int axis = 0; axis < 3; ++axis) size[axis] = maker.number("a size");
  if (!(size.x > 0 && size.y > 0 && size.z > 0)) maker.fail("the sizes of a box are greater than zero");
  bool inward = false, rounded = false;
  double bevel = 0;
  while (!maker.done()) {
    const std::string option = maker.word("option");
    if (option == "-i") {
      inward = true;
    } else if (option == "-b" || option == "-r") {
      rounded = option == "-r";
      bevel = maker.number(option.c_str());
      if (!(bevel > 0)) maker.fail(option + " is greater than zero");
      if (bevel > 0.5 * std::min({size.x, size.y, size.z})) maker.fail(option + " leaves nothing of the box");
    } else if (option == "-n") {
      maker.integer("-n");
    } else if (option != "-s") {
      maker.fail("genbox has no option '" + option + "' here");
    }
  }
  BoxBuilder box(maker, size, bevel, inward);
  box.faces();
  if (bevel > 0 && rounded) box.roundedEdges();
  if (bevel > 0 && !rounded) box.bevelledEdges();
  return maker.take();
}

}  // namespace deltalux::io::radiance
