#include "io/mitsuba/properties.hpp"

#include <algorithm>
#include <cmath>
#include <deltalux/error.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include "io/lower_case.hpp"
#include "io/number.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io::mitsuba {

std::string snakeCase(std::string_view name) {
  std::string snake;
  const auto isUpper = [](char c) { return c >= 'A' && c <= 'Z'; };
  for (std::size_t i = 0; i < name.size(); ++i) {
    if (isUpper(name[i]) && i > 0 && !isUpper(name[i - 1]) && name[i - 1] != '_') snake += '_';
    snake += name[i];
  }
  return lowerCase(snake);
}

void Properties::fail(const XmlElement& at, const std::string& message) const {
  throw InputError(file_, at.line, message, "compare the scene with Mitsuba's documentation of its plugins");
}

std::string Properties::type() const {
  const std::string* type = element_.attribute("type");
  return type ? lowerCase(*type) : "";
}

const XmlElement* Properties::named(std::string_view name) const {
  for (const XmlElement& child : element_.children)
    if (const std::string* own = child.attribute("name"); own && snakeCase(*own) == name) return &child;
  return nullptr;
}

std::vector<double> Properties::numbers(const XmlElement& at, const std::string& text, std::size_t least,
                                        std::size_t most) const {
  std::vector<double> all;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t first = text.find_first_not_of(" \t\r\n,", begin);
    if (first == std::string::npos) break;
    const std::size_t end = std::min(text.find_first_of(" \t\r\n,", first), text.size());
    const std::string word = text.substr(first, end - first);
    const std::optional<double> value = parseDecimal(word);
    if (!value || !(std::abs(*value) <= kMostNumber)) fail(at, "<" + at.name + ">: " + notANumber(word));
    all.push_back(*value);
    if (all.size() > most) break;
    begin = end;
  }
  if (all.size() < least || all.size() > most) fail(at, "<" + at.name + "> has not as many numbers as it should");
  return all;
}

double Properties::number(std::string_view name, double otherwise) const {
  const XmlElement* child = named(name);
  const std::string* value = child ? child->attribute("value") : nullptr;
  return value ? numbers(*child, *value, 1, 1)[0] : otherwise;
}

bool Properties::flag(std::string_view name, bool otherwise) const {
  const XmlElement* child = named(name);
  const std::string* value = child ? child->attribute("value") : nullptr;
  return value ? lowerCase(trimmed(*value)) == "true" : otherwise;
}

std::optional<std::string> Properties::word(std::string_view name) const {
  const XmlElement* child = named(name);
  const std::string* value = child ? child->attribute("value") : nullptr;
  return value ? std::optional(*value) : std::nullopt;
}

Vec3 Properties::triple(const XmlElement& at, double otherwise) const {
  if (const std::string* value = at.attribute("value")) {
    const std::vector<double> all = numbers(at, *value, 1, 3);
    if (all.size() == 2) fail(at, "<" + at.name + "> has two numbers");
    return all.size() == 1 ? Vec3(all[0]) : Vec3(all[0], all[1], all[2]);
  }
  Vec3 result(otherwise);
  const char* const axes[] = {"x", "y", "z"};
  for (int i = 0; i < 3; ++i)
    if (const std::string* value = at.attribute(axes[i])) result[i] = numbers(at, *value, 1, 1)[0];
  return result;
}

Vec3 Properties::point(std::string_view name, const Vec3& otherwise) const {
  const XmlElement* child = named(name);
  return child ? triple(*child, 0) : otherwise;
}

std::optional<Rgb> Properties::colour(const XmlElement& e, std::map<std::string, std::size_t>& ignored) const {
  const std::string* value = e.attribute("value");
  if (!value) return std::nullopt;
  Rgb colour(0.0f);
  if (e.name == "spectrum" && value->find(':') != std::string::npos) {
    std::string plain = *value;
    std::ranges::replace(plain, ':', ' ');
    constexpr std::size_t kMost = 10'000;  // [limit]
    const std::vector<double> all = numbers(e, plain, 2, kMost);
    if (all.size() % 2 != 0) fail(e, "a wavelength has no value");
    double sum = 0;
    for (std::size_t i = 1; i < all.size(); i += 2) sum += all[i];
    colour = Rgb(static_cast<float>(2 * sum / static_cast<double>(all.size())));
    ++ignored["spectra (gray instead)"];
  } else {
    const std::vector<double> all = numbers(e, *value, 1, 3);
    if (all.size() == 2) fail(e, "a colour has two numbers");
    colour = all.size() == 1 ? Rgb(static_cast<float>(all[0])) : Rgb(Vec3(all[0], all[1], all[2]));
  }
  for (int c = 0; c < 3; ++c)
    if (colour[c] < 0) fail(e, "a colour is negative");
  return colour;
}

Mat4 Properties::step(const XmlElement& e) const {
  const std::string kind = lowerCase(e.name);
  if (kind == "translate") return glm::translate(Mat4(1.0), triple(e, 0));
  if (kind == "scale") return glm::scale(Mat4(1.0), triple(e, 1));
  if (kind == "rotate") {
    const Vec3 axis = triple(e, 0);
    const std::string* angle = e.attribute("angle");
    if (!angle || !(glm::length(axis) > 0)) fail(e, "a rotation has no axis or no angle");
    return glm::rotate(Mat4(1.0), glm::radians(numbers(e, *angle, 1, 1)[0]), glm::normalize(axis));
  }
  if (kind == "matrix") {
    const std::string* value = e.attribute("value");
    if (!value) fail(e, "a matrix has no numbers");
    const std::vector<double> all = numbers(e, *value, 9, 16);
    if (all.size() != 9 && all.size() != 16) fail(e, "a matrix has neither 9 nor 16 numbers");
    const std::size_t side = all.size() == 9 ? 3 : 4;
    Mat4 m(1.0);
    for (std::size_t row = 0; row < 3; ++row)
      for (std::size_t column = 0; column < side; ++column)
        m[static_cast<int>(column)][static_cast<int>(row)] = all[side * row + column];
    return m;
  }
  if (kind == "lookat") {
    const auto at = [&](const char* name, const Vec3& otherwise) {
      const std::string* value = e.attribute(name);
      if (!value) return otherwise;
      const std::vector<double> all = numbers(e, *value, 3, 3);
      return Vec3(all[0], all[1], all[2]);
    };
    const Vec3 origin = at("origin", Vec3(0)), aim = at("target", Vec3(0, 0, 1)) - origin;
    if (!(glm::length(aim) > 0)) fail(e, "it looks at where it stands");
    const Vec3 forward = glm::normalize(aim);
    Vec3 left = glm::cross(at("up", Vec3(0, 1, 0)), forward);
    if (!(glm::length(left) > 1e-9)) left = Frame(forward).tangent;
    left = glm::normalize(left);
    Mat4 m(1.0);
    m[0] = glm::dvec4(left, 0), m[1] = glm::dvec4(glm::cross(forward, left), 0), m[2] = glm::dvec4(forward, 0);
    m[3] = glm::dvec4(origin, 1);
    return m;
  }
  fail(e, "<" + e.name.substr(0, 40) + "> is no transform");
}

Mat4 Properties::toWorld() const {
  Mat4 result(1.0);
  const XmlElement* transform = named("to_world");
  if (!transform) return result;
  for (const XmlElement& child : transform->children) result = step(child) * result;
  for (int i = 0; i < 16; ++i)
    if (!(std::abs(result[i / 4][i % 4]) <= kMostNumber)) fail(*transform, "a transform overflows");
  return result;
}

}  // namespace deltalux::io::mitsuba
