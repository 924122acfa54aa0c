#include "io/pbrt/transforms.hpp"

#include <array>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace deltalux::io::pbrt {

namespace {

template <std::size_t N>
std::array<double, N> takeNumbers(Tokens& tokens) {
  const bool list = tokens.passed(Token::Kind::Open);
  std::array<double, N> numbers;
  for (double& number : numbers) number = tokens.takeNumber();
  if (list && !tokens.passed(Token::Kind::Close)) fail(tokens.place(), "the list has not as many numbers as it should");
  return numbers;
}

/// From the world to a viewer that looks along z, x to the right and y up.
Mat4 lookAt(const Vec3& eye, const Vec3& at, const Vec3& upwards, const Place& place) {
  if (!(glm::length(at - eye) > 0)) fail(place, "it looks at where it stands");
  const Vec3 forward = glm::normalize(at - eye);
  Vec3 right = glm::cross(upwards, forward);
  if (!(glm::length(right) > 1e-9 * glm::length(upwards))) right = Frame(forward).tangent;
  right = glm::normalize(right);
  const glm::dmat3 turn = glm::transpose(glm::dmat3(right, glm::cross(forward, right), forward));
  return glm::translate(Mat4(turn), -eye);
}

Mat4 matrix(const std::array<double, 16>& numbers, const Place& place) {
  Mat4 m(1.0);
  for (int i = 0; i < 16; ++i) m[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
  const double last = m[3][3];
  if (last == 0 || m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0) fail(place, "the matrix is that of a projection");
  return m / last;
}

}  // namespace

std::optional<Mat4> takeTransform(std::string_view word, Tokens& tokens) {
  if (word == "Translate" || word == "Scale") {
    const auto [x, y, z] = takeNumbers<3>(tokens);
    return word == "Scale" ? glm::scale(Mat4(1.0), {x, y, z}) : glm::translate(Mat4(1.0), {x, y, z});
  }
  if (word == "Rotate") {
    const auto [angle, x, y, z] = takeNumbers<4>(tokens);
    const Vec3 axis(x, y, z);
    if (!(glm::length(axis) > 0)) fail(tokens.place(), "a rotation has no axis");
    return glm::rotate(Mat4(1.0), glm::radians(angle), glm::normalize(axis));
  }
  if (word == "LookAt") {
    const auto n = takeNumbers<9>(tokens);
    return lookAt({n[0], n[1], n[2]}, {n[3], n[4], n[5]}, {n[6], n[7], n[8]}, tokens.place());
  }
  if (word == "Transform" || word == "ConcatTransform") return matrix(takeNumbers<16>(tokens), tokens.place());
  return std::nullopt;
}

void requireFinite(const Mat4& m, const Place& at) {
  constexpr double kMost = 1e15;  // of a transform's numbers [limit]
  for (int i = 0; i < 16; ++i)
    if (!(std::abs(m[i / 4][i % 4]) <= kMost)) fail(at, "the transforms overflow");
}

}  // namespace deltalux::io::pbrt
