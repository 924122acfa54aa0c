#pragma once
// Properties of Mitsuba's plugins: <float name="radius" value="2"/> and the like.
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "io/xml.hpp"

namespace deltalux::io::mitsuba {

constexpr double kMostNumber = 1e15;  // of all numbers [limit]

/// One file's elements, read. Throws InputError with the line everywhere.
class Properties {
 public:
  Properties(const XmlElement& element, const std::string& file) : element_(element), file_(file) {}

  const XmlElement& element() const { return element_; }
  std::string type() const;
  /// The child whose attribute `name` is that, or null.
  const XmlElement* named(std::string_view name) const;
  double number(std::string_view name, double otherwise) const;
  bool flag(std::string_view name, bool otherwise) const;
  std::optional<std::string> word(std::string_view name) const;
  Vec3 point(std::string_view name, const Vec3& otherwise) const;
  /// A colour, at least 0: rgb, a number, or a spectrum's mean, which counts as gray in `ignored`.
  std::optional<Rgb> colour(const XmlElement&, std::map<std::string, std::size_t>& ignored) const;
  /// The transform `to_world`; the identity without.
  Mat4 toWorld() const;

  [[noreturn]] void fail(const XmlElement& at, const std::string& message) const;
  /// The numbers of a text, divided by blanks and commas; as many as `least` to `most`.
  std::vector<double> numbers(const XmlElement& at, const std::string& text, std::size_t least, std::size_t most) const;

 private:
  Vec3 triple(const XmlElement& at, double otherwise) const;
  Mat4 step(const XmlElement&) const;

  const XmlElement& element_;
  const std::string& file_;
};

/// Names as Mitsuba 3 has them: "toWorld" is "to_world".
std::string snakeCase(std::string_view name);

}  // namespace deltalux::io::mitsuba
