#include "io/radiance/object_maker.hpp"

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

const std::string& ObjectMaker::word(const char* what) {
  if (done()) fail(std::string("missing ") + what);
  return input_.words[next_++];
}

double ObjectMaker::number(const char* what) { return requireNumber(word(what), where(), what); }
long ObjectMaker::integer(const char* what) { return requireInteger(word(what), where(), what); }

void ObjectMaker::fail(const std::string& message) const { throw inputError(where(), message, "usage: " + usage_); }

void ObjectMaker::readMaterialAndName() {
  material_ = word("material");
  name_ = word("name");
}

RadObject& ObjectMaker::add(Type type, const std::string& suffix, std::vector<double> reals) {
  return addNamed(type, name_ + "." + suffix, std::move(reals));
}

RadObject& ObjectMaker::addNamed(Type type, const std::string& name, std::vector<double> reals) {
  if (objects_.size() >= input_.mostObjects) fail("more than " + std::to_string(input_.mostObjects) + " objects");
  for (const double real : reals) {
    if (!(std::abs(real) <= kLargestNumber)) fail("'" + name + "' has a coordinate that is not finite or beyond 1e12");
  }
  RadObject object;
  object.type = type;
  object.typeName = nameOf(type);
  object.modifier = material_;
  object.name = name;
  object.reals = std::move(reals);
  object.where = where();
  return objects_.emplace_back(std::move(object));
}

std::vector<double> flattened(std::initializer_list<Vec3> points, std::initializer_list<double> rest) {
  std::vector<double> reals;
  for (const Vec3& p : points) reals.insert(reals.end(), {p.x, p.y, p.z});
  reals.insert(reals.end(), rest);
  return reals;
}

}  // namespace deltalux::io::radiance
