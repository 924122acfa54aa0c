#include <cmath>

#include "io/radiance/expression_generator.hpp"
#include "io/radiance/generators.hpp"

namespace deltalux::io::radiance {

namespace {

struct ProfilePoint {
  double z = 0, r = 0;
};

/// One segment of the profile turned about z; rising z faces outwards. Nothing for a segment without length.
void addSegment(ObjectMaker& maker, const ProfilePoint& from, const ProfilePoint& to, int index) {
  constexpr double kSame = 1e-9;  // [rounding]
  const double rise = to.z - from.z, widening = to.r - from.r;
  const bool level = std::abs(rise) <= kSame, straight = std::abs(widening) <= kSame;
  if (level && straight) return;
  const std::string suffix = std::to_string(index);
  const Vec3 p0(0, 0, from.z), p1(0, 0, to.z);
  if (straight) {
    maker.add(rise < 0 ? Type::Tube : Type::Cylinder, suffix, flattened({p0, p1}, {to.r}));
  } else if (level) {
    maker.add(Type::Ring, suffix, flattened({p1, Vec3(0, 0, widening < 0 ? 1 : -1)}, {from.r, to.r}));
  } else {
    maker.add(rise < 0 ? Type::Cup : Type::Cone, suffix, flattened({p0, p1}, {from.r, to.r}));
  }
}

/// genrev -s puts a texture before each segment that smooths its normals; surfaces then name it as their modifier.
RadObject smoothingTexture(const ObjectMaker& maker) {
  RadObject texture;
  texture.type = Type::Pattern;
  texture.typeName = "texfunc";
  texture.modifier = maker.material();
  texture.name = "Phong";
  texture.where = maker.where();
  return texture;
}

std::vector<RadObject> smoothed(std::vector<RadObject> segments, const RadObject& texture) {
  std::vector<RadObject> result;
  for (RadObject& segment : segments) {
    segment.modifier = texture.name;
    result.push_back(texture);
    result.push_back(std::move(segment));
  }
  return result;
}

}  // namespace

std::vector<RadObject> genrev(const GeneratorInput& input) {
  ObjectMaker maker(input, "genrev material name 'z(t)' 'r(t)' nseg [-e expression] [-f file] [-s]");
  Calc calc(input.where);
  maker.readMaterialAndName();
  const std::string zText = maker.word("z(t)"), rText = maker.word("r(t)"), segments = maker.word("nseg");
  bool smooth = false;
  while (!maker.done()) {
    const std::string option = maker.word("option");
    if (option == "-s") {
      smooth = true;
    } else if (!readDefinition(option, maker, calc)) {
      maker.fail("genrev has no option '" + option + "'");
    }
  }
  const int count = segmentCount(segments, maker, calc);
  const Calc::Function z = calc.function({"t"}, zText), r = calc.function({"t"}, rText);
  const auto profile = [&](int i) {
    const double t = static_cast<double>(i) / count;
    return ProfilePoint{z({t}), r({t})};
  };
  ProfilePoint last = profile(0);
  for (int i = 1; i <= count; ++i) {
    const ProfilePoint next = profile(i);
    if (!(next.r >= -1e-9 && last.r >= -1e-9)) maker.fail("r(t) is below zero");
    addSegment(maker, last, next, i);
    last = next;
  }
  return smooth ? smoothed(maker.take(), smoothingTexture(maker)) : maker.take();
}

}  // namespace deltalux::io::radiance
