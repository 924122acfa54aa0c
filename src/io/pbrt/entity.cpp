#include "io/pbrt/entity.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "io/obj/words.hpp"

namespace deltalux::io::pbrt {

namespace {

/// Values of a type are numbers, so many together, or texts (0).
struct Type {
  std::string_view name;
  std::size_t stride;
};
constexpr std::array kTypes{Type{"float", 1},    Type{"integer", 1}, Type{"point2", 2},  Type{"vector2", 2},
                            Type{"point3", 3},   Type{"point", 3},   Type{"vector3", 3}, Type{"vector", 3},
                            Type{"normal3", 3},  Type{"normal", 3},  Type{"rgb", 3},     Type{"color", 3},
                            Type{"bool", 0},     Type{"string", 0},  Type{"texture", 0}, Type{"spectrum", 1},
                            Type{"blackbody", 1}};  // [layout]

void takeValue(const Token& token, const Type& type, Parameter& parameter) {
  const Place at{parameter.at.file, token.line};
  if (token.kind == Token::Kind::Text) {
    if (type.stride > 0 && type.name != "spectrum")
      fail(at, shown(token.text) + " is no number, of which it is a list");
    if (type.name == "bool" && token.text != "true" && token.text != "false")
      fail(at, shown(token.text) + " is neither true nor false");
    parameter.texts.emplace_back(token.text);
  } else if (token.kind == Token::Kind::Open) {
    fail(at, "a list stands within a list");
  } else if (type.stride > 0) {
    parameter.numbers.push_back(numberOf(token.text, at));
    if (type.name == "integer" && parameter.numbers.back() != std::floor(parameter.numbers.back()))
      fail(at, shown(token.text) + " is no integer");
  } else if (type.name == "bool" && (token.text == "true" || token.text == "false")) {
    parameter.texts.emplace_back(token.text);
  } else {
    fail(at, shown(token.text) + " should stand in quotes");
  }
}

Parameter takeParameter(Tokens& tokens) {
  const Token declared = tokens.take("a parameter");
  std::string_view words = declared.text;
  Parameter parameter;
  parameter.at = {tokens.place().file, declared.line};
  parameter.type = takeWord(words), parameter.name = takeWord(words);
  const auto type = std::ranges::find(kTypes, std::string_view(parameter.type), &Type::name);
  if (type == kTypes.end() || parameter.name.empty() || !takeWord(words).empty())
    fail(parameter.at, shown(declared.text) + " is no type and name of a parameter");
  if (!tokens.passed(Token::Kind::Open)) {
    takeValue(tokens.take("a value"), *type, parameter);
  } else {
    while (!tokens.passed(Token::Kind::Close)) takeValue(tokens.take("the end of a list, ]"), *type, parameter);
  }
  if (parameter.numbers.empty() == parameter.texts.empty() && !(parameter.numbers.empty() && type->stride > 0))
    fail(parameter.at, "the parameter " + shown(parameter.name) + " has no value, or several kinds of them");
  if (type->stride > 1 && parameter.numbers.size() % type->stride != 0)
    fail(parameter.at, "the parameter " + shown(parameter.name) + " has not as many numbers as it should");
  return parameter;
}

const Parameter* single(const Entity& entity, std::string_view name, std::initializer_list<std::string_view> types) {
  const Parameter* found = find(entity, name);
  if (!found) return nullptr;
  if (std::ranges::find(types, std::string_view(found->type)) == types.end())
    fail(found->at, "the parameter " + shown(name) + " is of a type that it cannot have");
  const std::size_t count = found->numbers.size() + found->texts.size();
  const bool isPoint = found->type != "float" && found->type != "integer" && !found->numbers.empty();
  if (count != (isPoint ? 3u : 1u)) fail(found->at, "the parameter " + shown(name) + " has not one value");
  return found;
}

}  // namespace

std::vector<Parameter> takeParameters(Tokens& tokens) {
  std::vector<Parameter> parameters;
  while (tokens.peek() && tokens.peek()->kind == Token::Kind::Text) parameters.push_back(takeParameter(tokens));
  return parameters;
}

const Parameter* find(const Entity& entity, std::string_view name) {
  const auto found = std::ranges::find(entity.parameters, name, &Parameter::name);
  if (found != entity.parameters.end()) return &*found;
  if (!entity.defaults) return nullptr;
  const auto usual = std::ranges::find_if(*entity.defaults, [&](const auto& p) { return p->name == name; });
  return usual == entity.defaults->end() ? nullptr : usual->get();
}

double numberOr(const Entity& entity, std::string_view name, double otherwise) {
  const Parameter* found = single(entity, name, {"float", "integer"});
  return found ? found->numbers[0] : otherwise;
}

bool flagOr(const Entity& entity, std::string_view name, bool otherwise) {
  const Parameter* found = single(entity, name, {"bool"});
  return found ? found->texts[0] == "true" : otherwise;
}

std::string textOr(const Entity& entity, std::string_view name, const std::string& otherwise) {
  const Parameter* found = single(entity, name, {"string"});
  return found ? found->texts[0] : otherwise;
}

Vec3 pointOr(const Entity& entity, std::string_view name, const Vec3& otherwise) {
  const Parameter* found = single(entity, name, {"point3", "point", "vector3", "vector"});
  return found ? Vec3(found->numbers[0], found->numbers[1], found->numbers[2]) : otherwise;
}

std::vector<double> numbersOf(const Entity& entity, std::string_view name, std::size_t stride) {
  const Parameter* found = find(entity, name);
  if (!found) return {};
  if (!found->texts.empty()) fail(found->at, "the parameter " + shown(name) + " is no list of numbers");
  if (found->numbers.size() % stride != 0)
    fail(found->at, "the parameter " + shown(name) + " has not as many numbers as it should");
  return found->numbers;
}

std::vector<Vec3> pointsOf(const Entity& entity, std::string_view name) {
  const std::vector<double> numbers = numbersOf(entity, name, 3);
  std::vector<Vec3> points;
  points.reserve(numbers.size() / 3);
  for (std::size_t i = 0; i < numbers.size(); i += 3) points.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  return points;
}

}  // namespace deltalux::io::pbrt
