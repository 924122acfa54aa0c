#include <array>
#include <cmath>

#include "io/radiance/expression_generator.hpp"
#include "io/radiance/generators.hpp"

namespace deltalux::io::radiance {

namespace {

struct Bead {
  Vec3 center{0};
  double radius = 0;
};

/// The piece between two spheres: a cylinder, or the cone that touches both along circles.
void addJoint(ObjectMaker& maker, const Bead& from, const Bead& to, int index) {
  constexpr double kSame = 1e-6;  // [rounding]
  const std::string suffix = "c" + std::to_string(index);
  const Vec3 axis = to.center - from.center;
  const double shrink = from.radius - to.radius;
  if (std::abs(shrink) <= kSame) {
    maker.add(Type::Cylinder, suffix, flattened({from.center, to.center}, {to.radius}));
    return;
  }
  const double length2 = glm::dot(axis, axis);
  if (length2 <= shrink * shrink) return;  // one sphere swallows the other: no cone touches both
  // The cone's slope is sin a = shrink / length; its circles lie at r sin a along the axis with radius r cos a.
  const Vec3 along = axis * (shrink / length2);
  const double cosine = std::sqrt(1 - shrink * shrink / length2);
  maker.add(Type::Cone, suffix,
            flattened({from.center + from.radius * along, to.center + to.radius * along},
                      {cosine * from.radius, cosine * to.radius}));
}

}  // namespace

std::vector<RadObject> genworm(const GeneratorInput& input) {
  ObjectMaker maker(input, "genworm material name 'x(t)' 'y(t)' 'z(t)' 'r(t)' nseg [-e expression] [-f file]");
  Calc calc(input.where);
  maker.readMaterialAndName();
  std::array<std::string, 4> texts;
  for (std::string& text : texts) text = maker.word("x(t) y(t) z(t) r(t)");
  const std::string segments = maker.word("nseg");
  while (!maker.done()) {
    const std::string option = maker.word("option");
    if (!readDefinition(option, maker, calc)) maker.fail("genworm has no option '" + option + "'");
  }
  const int count = segmentCount(segments, maker, calc);
  std::array<Calc::Function, 4> functions;
  for (std::size_t i = 0; i < 4; ++i) functions[i] = calc.function({"t"}, texts[i]);
  Bead last;
  for (int i = 0; i <= count; ++i) {
    const std::vector<double> t{static_cast<double>(i) / count};
    const Bead bead{{functions[0](t), functions[1](t), functions[2](t)}, functions[3](t)};
    if (!(bead.radius >= 0)) maker.fail("r(t) is below zero");
    if (i > 0) addJoint(maker, last, bead, i);
    maker.add(Type::Sphere, "s" + std::to_string(i), flattened({bead.center}, {bead.radius}));
    last = bead;
  }
  return maker.take();
}

}  // namespace deltalux::io::radiance
