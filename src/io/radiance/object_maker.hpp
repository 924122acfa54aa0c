#pragma once
#include <deltalux/math.hpp>
#include <initializer_list>

#include "io/radiance/generators.hpp"

namespace deltalux::io::radiance {

/// Reads a generator's words in order and collects what it makes.
class ObjectMaker {
 public:
  /// `usage` is the command's form, for error messages.
  ObjectMaker(const GeneratorInput& input, std::string usage) : input_(input), usage_(std::move(usage)) {}

  bool done() const { return next_ >= input_.words.size(); }
  const std::string& word(const char* what);
  double number(const char* what);
  long integer(const char* what);
  [[noreturn]] void fail(const std::string& message) const;

  const SourceLine& where() const { return input_.where; }
  const GeneratorInput& input() const { return input_; }

  /// Material and name that every object gets; names are `name.suffix`.
  void readMaterialAndName();
  const std::string& material() const { return material_; }
  const std::string& name() const { return name_; }

  RadObject& add(Type type, const std::string& suffix, std::vector<double> reals);
  RadObject& addNamed(Type type, const std::string& name, std::vector<double> reals);
  std::vector<RadObject> take() { return std::move(objects_); }

 private:
  const GeneratorInput& input_;
  std::string usage_;
  std::size_t next_ = 0;
  std::string material_, name_;
  std::vector<RadObject> objects_;
};

/// The coordinates of `points` one after another.
std::vector<double> flattened(std::initializer_list<Vec3> points, std::initializer_list<double> rest = {});

}  // namespace deltalux::io::radiance
