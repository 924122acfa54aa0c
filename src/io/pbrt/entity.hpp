#pragma once
// What statements of pbrt describe: a type and its parameters, "float radius" 2 and the like. [pbrt]
#include <deltalux/math.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "io/pbrt/tokens.hpp"

namespace deltalux::io::pbrt {

struct Parameter {
  std::string type, name;
  std::vector<double> numbers;
  std::vector<std::string> texts;  // of string, texture, and spectrum's names; "true" and "false" of bool
  Place at;
};

/// What counts where an entity's own parameters say nothing.
using Defaults = std::vector<std::shared_ptr<const Parameter>>;

struct Entity {
  std::string type;
  std::vector<Parameter> parameters;
  Place at;
  std::shared_ptr<const Defaults> defaults = nullptr;  // null: none
  bool isDefined = true;                               // false: `type` is the name of one that should be defined yet
};

/// Every parameter that follows. Throws InputError.
std::vector<Parameter> takeParameters(Tokens&);

/// The parameter of that name; null where there is none.
const Parameter* find(const Entity&, std::string_view name);

// These take `otherwise` where a parameter is not there, and throw InputError where its value is of another type.
double numberOr(const Entity&, std::string_view name, double otherwise);
bool flagOr(const Entity&, std::string_view name, bool otherwise);
std::string textOr(const Entity&, std::string_view name, const std::string& otherwise);
Vec3 pointOr(const Entity&, std::string_view name, const Vec3& otherwise);

/// The numbers of a parameter, a multiple of `stride`; none where it is not there.
std::vector<double> numbersOf(const Entity&, std::string_view name, std::size_t stride);
std::vector<Vec3> pointsOf(const Entity&, std::string_view name);

}  // namespace deltalux::io::pbrt
