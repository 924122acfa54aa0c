#include "io/radiance/transform.hpp"

#include <glm/gtc/matrix_transform.hpp>

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr long kMostIterations = 1000000;  // [limit]

/// Options between two -i, multiplied out. Composition is `later * earlier`: options apply in the order written.
struct Group {
  Mat4 matrix{1.0};
  double scale = 1;
  long repeats = 1;

  void then(const Mat4& step, double factor = 1) { matrix = step * matrix, scale *= factor; }
};

Transform repeated(const Transform& before, const Group& group) {
  Transform result = before;
  // By squaring: a million iterations cost twenty products.
  Mat4 power = group.matrix;
  for (long n = group.repeats; n > 0; n /= 2, power = power * power) {
    if (n % 2 == 1) result.matrix = power * result.matrix;
  }
  result.scale *= std::pow(group.scale, static_cast<double>(group.repeats));
  return result;
}

void checkFinite(const Transform& transform, const SourceLine& where) {
  for (int column = 0; column < 4; ++column) {
    for (int row = 0; row < 4; ++row) {
      if (!(std::abs(transform.matrix[column][row]) <= kLargestNumber)) {
        throw inputError(where, "the transform overflows", "check its -s and -i");
      }
    }
  }
  if (!(transform.scale > 1e-12)) throw inputError(where, "the transform shrinks everything to nothing");
}

}  // namespace

Transform parseTransform(std::span<const std::string> words, std::size_t& used, const SourceLine& where) {
  Transform transform;
  Group group;
  std::size_t i = 0;
  const auto number = [&](std::string_view option) {
    if (++i >= words.size()) throw inputError(where, std::string(option) + " needs a number after it");
    return requireNumber(words[i], where, option);
  };
  for (; i < words.size(); ++i) {
    const std::string& option = words[i];
    if (option == "-t") {
      const double x = number(option), y = number(option), z = number(option);
      group.then(glm::translate(Mat4(1.0), Vec3(x, y, z)));
    } else if (option == "-s") {
      const double factor = number(option);
      if (factor == 0) throw inputError(where, "-s 0 shrinks everything to nothing");
      group.then(glm::scale(Mat4(1.0), Vec3(factor)), factor);
    } else if (option == "-rx" || option == "-ry" || option == "-rz") {
      Vec3 axis(0);
      axis[option[2] - 'x'] = 1;
      group.then(glm::rotate(Mat4(1.0), glm::radians(number(option)), axis));
    } else if (option == "-mx" || option == "-my" || option == "-mz") {
      Vec3 factors(1);
      factors[option[2] - 'x'] = -1;
      group.then(glm::scale(Mat4(1.0), factors));
    } else if (option == "-i") {
      if (++i >= words.size()) throw inputError(where, "-i needs a count after it");
      transform = repeated(transform, group);
      group = {};
      group.repeats = requireInteger(words[i], where, "-i");
      if (group.repeats < 0 || group.repeats > kMostIterations) throw inputError(where, "-i " + words[i]);
    } else {
      break;
    }
  }
  transform = repeated(transform, group);
  used = i;
  transform.scale = std::abs(transform.scale);
  transform.mirrored = glm::determinant(glm::dmat3(transform.matrix)) < 0;
  checkFinite(transform, where);
  return transform;
}

}  // namespace deltalux::io::radiance
