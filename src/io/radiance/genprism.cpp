#include <cmath>

#include "io/radiance/generators.hpp"
#include "io/radiance/lexer.hpp"
#include "io/radiance/object_maker.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kTiny = 1e-6;  // [rounding]

Vec2 perpendicular(const Vec2& v) { return {-v.y, v.x}; }

class PrismBuilder {
 public:
  PrismBuilder(ObjectMaker& maker, std::vector<Vec2> outline, const Vec3& length, bool completed)
      : maker_(maker),
        outline_(std::move(outline)),
        length_(length),
        sideCount_(outline_.size() - (completed ? 1 : 0)) {}

  void plainEnds() { ends(outline_); }

  void plainSides() {
    for (std::size_t i = 0; i < sideCount_; ++i) {
      const Vec3 a = bottom(outline_[i]), b = bottom(outline_[next(i)]);
      maker_.add(Type::Polygon, std::to_string(i + 1), flattened({a, a + length_, b + length_, b}));
    }
  }

  /// Prepares rounding all edges by `radius`: edge directions, trims at the corners, and centres of the corners' arcs.
  void setRounding(double radius) {
    const std::size_t n = outline_.size();
    radius_ = radius;
    signedRadius_ = length_.z < 0 ? -radius : radius;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 back = outline_[(i + n - 1) % n] - outline_[i];
      if (glm::length(back) <= kTiny) maker_.fail("a side of the prism has no length");
      backward_.push_back(glm::normalize(back));
    }
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2 &in = backward_[i], &out = backward_[next(i)];
      const double cosine = glm::dot(in, out);
      if (1 + cosine <= kTiny) maker_.fail("two sides of the prism overlap");
      const double trim = cosine >= 1 ? 0 : std::sqrt((1 - cosine) / (1 + cosine));
      trim_.push_back(std::copysign(trim, out.x * in.y - out.y * in.x));
      centers_.push_back(outline_[i] + signedRadius_ * (trim_[i] * in + perpendicular(in)));
    }
  }

  void roundedEnds() {
    ends(centers_);
    const Vec3 lift(0, 0, signedRadius_);
    rim("b", lift);
    rim("t", length_ - lift);
  }

  void roundedSides() {
    const double direction = length_.z < 0 ? -1 : 1;
    for (std::size_t i = 0; i < sideCount_; ++i) {
      const std::size_t j = next(i);
      const Vec2& along = backward_[j];
      // A slanted prism's sides touch the roundings off the horizontal.
      const double sine = direction * (length_.y * along.x - length_.x * along.y) / glm::length(length_);
      const double cosine = std::sqrt(std::max(0.0, 1 - sine * sine));
      const Vec3 tangent(std::abs(sine) > kTiny ? Vec3((1 - cosine) * perpendicular(along), sine) : Vec3(0));
      const Vec3 lift(0, 0, signedRadius_);
      const Vec3 a = bottom(outline_[i] - signedRadius_ * trim_[i] * along) + signedRadius_ * tangent;
      const Vec3 b = bottom(outline_[j] + signedRadius_ * trim_[j] * along) + signedRadius_ * tangent;
      maker_.add(Type::Polygon, std::to_string(i + 1),
                 flattened({a + lift, a + length_ - lift, b + length_ - lift, b + lift}));
      if (direction * trim_[j] < 0) continue;  // an inner corner has no edge to round
      const Vec3 center = bottom(centers_[j]);
      maker_.add(Type::Cylinder, "e" + std::to_string(i + 1),
                 flattened({center + lift, center + length_ - lift}, {radius_}));
    }
  }

 private:
  std::size_t next(std::size_t i) const { return (i + 1) % outline_.size(); }
  static Vec3 bottom(const Vec2& p) { return {p.x, p.y, 0}; }

  void ends(const std::vector<Vec2>& outline) {
    std::vector<double> low, high;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec2 p = outline[i], q = outline[outline.size() - 1 - i];
      low.insert(low.end(), {p.x, p.y, 0.0});
      high.insert(high.end(), {q.x + length_.x, q.y + length_.y, length_.z});
    }
    maker_.add(Type::Polygon, "b", std::move(low));
    maker_.add(Type::Polygon, "t", std::move(high));
  }

  /// The rounded edge of an end: a cylinder for each side, a sphere at each outer corner.
  void rim(const std::string& end, const Vec3& offset) {
    const double direction = length_.z < 0 ? -1 : 1;
    const std::size_t n = outline_.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3 from = bottom(centers_[(i + n - 1) % n]) + offset, to = bottom(centers_[i]) + offset;
      const std::string number = std::to_string(i + 1);
      if (direction * trim_[i] > 0) maker_.add(Type::Sphere, end + "c" + number, flattened({to}, {radius_}));
      maker_.add(Type::Cylinder, end + "e" + number, flattened({from, to}, {radius_}));
    }
  }

  ObjectMaker& maker_;
  std::vector<Vec2> outline_;
  Vec3 length_;
  std::size_t sideCount_;
  double radius_ = 0, signedRadius_ = 0;  // the sign is the extrusion's
  std::vector<Vec2> backward_;            // unit vector from vertex i to the one before
  std::vector<double> trim_;              // how far the rounding cuts into the sides at vertex i, in radii; < 0 inside
  std::vector<Vec2> centers_;
};

std::vector<Vec2> outlineFromFile(const ObjectMaker& maker, const std::string& name) {
  const SourceFile file = maker.input().open(name);
  Lexer lexer(file.text, std::make_shared<const std::string>(file.name));
  std::vector<Vec2> outline;
  while (const auto x = lexer.word()) {
    const auto y = lexer.word();
    if (!y) throw inputError(lexer.where(), "an odd number of coordinates");
    outline.emplace_back(requireNumber(*x, lexer.where(), "x"), requireNumber(*y, lexer.where(), "y"));
  }
  return outline;
}

std::vector<Vec2> readOutline(ObjectMaker& maker) {
  const std::string source = maker.word("the vertices");
  const auto count = parseInteger(source);
  if (!count) return outlineFromFile(maker, source);
  std::vector<Vec2> outline;
  for (long i = 0; i < *count; ++i) {
    const double x = maker.number("a vertex"), y = maker.number("a vertex");
    outline.emplace_back(x, y);
  }
  return outline;
}

}  // namespace

std::vector<RadObject> genprism(const GeneratorInput& input) {
  ObjectMaker maker(input, "genprism material name {file | N x1 y1 .. xN yN} [-l x y z] [-r radius] [-c] [-e]");
  maker.readMaterialAndName();
  std::vector<Vec2> outline = readOutline(maker);
  if (outline.size() < 3) maker.fail("a prism has at least 3 vertices");
  Vec3 length(0, 0, 1);
  double radius = 0;
  bool withEnds = true, completed = false;
  while (!maker.done()) {
    const std::string option = maker.word("option");
    if (option == "-l") {
      for (int axis = 0; axis < 3; ++axis) length[axis] = maker.number("-l");
      if (std::abs(length.z) <= kTiny) maker.fail("the length vector of a prism leaves its plane");
    } else if (option == "-r") {
      radius = maker.number("-r");
    } else if (option == "-e") {
      withEnds = !withEnds;
    } else if (option == "-c") {
      completed = !completed;
    } else {
      maker.fail("genprism has no option '" + option + "'");
    }
  }
  PrismBuilder prism(maker, std::move(outline), length, completed);
  if (radius > kTiny) {
    if (radius > std::abs(length.z)) maker.fail("the rounding is greater than the prism's height");
    prism.setRounding(radius);
    if (withEnds) prism.roundedEnds();
    prism.roundedSides();
  } else {
    if (withEnds) prism.plainEnds();
    prism.plainSides();
  }
  return maker.take();
}

}  // namespace deltalux::io::radiance
