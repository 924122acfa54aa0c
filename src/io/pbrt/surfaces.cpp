#include "io/pbrt/surfaces.hpp"

#include <algorithm>

#include "io/pbrt/lights.hpp"
#include "io/pbrt/shapes.hpp"
#include "io/turned_over.hpp"

namespace deltalux::io::pbrt {

namespace {

constexpr std::size_t kMostShapes = 1'000'000, kMostPrimitives = 5'000'000;  // [limit]
constexpr std::size_t kMostTriangles = 50'000'000;                           // of all meshes [limit]
constexpr const char* kFlattened = "shapes that are sheared or flattened";

/// A shape's name in the scene: that of its file, else its kind and number.
std::string nameOf(const Entity& shape, std::size_t number) {
  const Parameter* file = find(shape, "filename");
  if (!file || file->texts.empty()) return shape.type + std::to_string(number);
  std::filesystem::path name = std::filesystem::path(file->texts[0]).filename();
  if (name.extension() == ".gz") name = name.stem();
  return name.stem().empty() ? shape.type + std::to_string(number) : name.stem().string();
}

}  // namespace

void Surfaces::define(const std::string& material, Entity entity) {
  Entity*& known = named_[material];
  if (!known || known->isDefined) known = &definitions_.emplace_back();  // earlier shapes keep an earlier definition
  *known = std::move(entity);
  names_[known] = material;
}

const Entity* Surfaces::named(const std::string& material, const Place& at) {
  Entity*& known = named_[material];
  if (!known) known = &definitions_.emplace_back(Entity{material, {}, at, nullptr, false});
  return known;
}

ObjectId Surfaces::objectId(const std::string& name) {
  const auto [known, isNew] = ids_.try_emplace(name);
  if (!isNew) return known->second;
  const std::size_t slash = name.rfind('/');
  const ObjectId parent = slash == std::string::npos ? ObjectId() : objectId(name.substr(0, slash));
  known->second = ObjectId(scene_.objects.size());
  scene_.objects.push_back({name, parent});
  return known->second;
}

MaterialId Surfaces::idOf(const Making& making) {
  const auto [known, isNew] = made_.try_emplace(making, MaterialId(scene_.materials.size()));
  if (isNew) scene_.materials.emplace_back();
  return known->second;
}

Material Surfaces::materialOf(const Making& making) {
  Material material{"default", Opaque{Rgb(0.5f), {}, {}}, std::nullopt};
  if (making.material) material = pbrt::materialOf(context_, named_, *making.material);
  if (const auto own = names_.find(making.material); own != names_.end()) material.name = own->second;
  const auto alpha = static_cast<float>(making.alpha);
  if (!std::holds_alternative<Dielectric>(material.surface)) material.coverage *= alpha;
  if (making.light) material.emission = emissionOf(context_, *making.light, making.area);
  // A lamp whose alpha is 0 is not seen, but shines.
  if (material.emission && alpha > 0) material.emission->radiance *= alpha;
  return material;
}

void Surfaces::finish() {
  for (const auto& [making, id] : made_) {
    Material material = materialOf(making);
    if (material.name.empty()) material.name = "material" + std::to_string(id.index());
    scene_.materials[id.index()] = std::move(material);
  }
}

void Surfaces::add(Part part, ObjectId object, const Place& at) {
  if (const auto* mesh = std::get_if<Mesh>(&part.shape)) triangles_ += mesh->triangles.size();
  if (scene_.primitives.size() >= kMostPrimitives || triangles_ > kMostTriangles)
    fail(at, "the scene has too many surfaces");
  scene_.primitives.push_back({std::move(part.shape), part.material, object});
}

void Surfaces::addShape(const Entity& e, const State& state) {
  if (++shapes_ > kMostShapes) fail(e.at, "the scene has too many shapes and instances");
  std::vector<Shape> placed;
  double total = 0;
  for (const Shape& shape : shapesOf(context_, e)) {
    const auto there = transformed(shape, state.toWorld);
    if (!there) {
      ignore(context_, kFlattened);
      continue;
    }
    placed.push_back(state.reversed ? turnedOver(*there) : *there);
    total += area(placed.back());
  }
  if (placed.empty()) return;
  const Entity* light = state.areaLight;
  if (light && current_) {
    ignore(context_, "area lights of instances");  // as pbrt does
    light = nullptr;
  }
  const double alpha = std::clamp(scalarOr(context_, e, "alpha", 1), 0.0, 1.0);
  const bool powered = light && find(*light, "power");  // only then it matters how large a surface is
  const MaterialId material = idOf({state.material, light, alpha, powered ? total : 1.0});
  const ObjectId object = current_ ? ObjectId() : objectId(nameOf(e, shapes_ - 1));
  for (Shape& shape : placed) {
    if (current_)
      current_->push_back({std::move(shape), material});
    else
      add({std::move(shape), material}, object, e.at);
  }
  ++context_.report.surfaces[e.type];
}

void Surfaces::beginObject(const std::string& name, const Place& at) {
  if (current_) fail(at, "an object is defined within another");
  current_ = &objects_[name];
  current_->clear();
}

void Surfaces::endObject(const Place& at) {
  if (!current_) fail(at, "no object is being defined");
  current_ = nullptr;
}

void Surfaces::addInstance(const std::string& name, const Mat4& toWorld, const Place& at) {
  if (++shapes_ > kMostShapes) fail(at, "the scene has too many shapes and instances");
  if (current_) fail(at, "an instance stands within an object");
  const auto object = objects_.find(name);
  if (object == objects_.end()) fail(at, "the object " + shown(name) + " is not defined");
  std::string own = name.empty() ? "object" : name;
  std::ranges::replace(own, '/', '_');
  const ObjectId id = objectId(own + "/" + std::to_string(instances_[own]++));
  for (const Part& part : object->second) {
    if (const auto there = transformed(part.shape, toWorld))
      add({*there, part.material}, id, at);
    else
      ignore(context_, kFlattened);
  }
}

}  // namespace deltalux::io::pbrt
