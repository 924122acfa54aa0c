#pragma once
// The surfaces of a scene of pbrt: shapes with their materials and lights, where transforms put them, and instances.
#include "io/pbrt/materials.hpp"
#include "io/pbrt/state.hpp"

namespace deltalux::io::pbrt {

class Surfaces {
 public:
  Surfaces(Context& context, Scene& scene) : context_(context), scene_(scene) {}

  void define(const std::string& material, Entity);
  /// The material of that name, which may be defined later.
  const Entity* named(const std::string& material, const Place&);

  /// Adds a shape to the scene, or to the object that is being defined. Throws InputError, as all here do.
  void addShape(const Entity&, const State&);
  void beginObject(const std::string& name, const Place&);
  void endObject(const Place&);
  void addInstance(const std::string& object, const Mat4& toWorld, const Place&);
  /// Makes the materials, all of which are defined now.
  void finish();

 private:
  struct Part {
    Shape shape;
    MaterialId material;
  };
  using Object = std::vector<Part>;

  /// What a surface is made of: its material and light (null: none), its alpha, and its area where the light has a
  /// power.
  struct Making {
    const Entity *material = nullptr, *light = nullptr;
    double alpha = 1, area = 0;
    friend auto operator<=>(const Making&, const Making&) = default;
  };

  MaterialId idOf(const Making&);
  Material materialOf(const Making&);
  ObjectId objectId(const std::string& name);
  void add(Part, ObjectId, const Place&);

  Context& context_;
  Scene& scene_;
  NamedMaterials named_;
  std::map<const Entity*, std::string> names_;
  std::deque<Entity> definitions_;  // that named_ refers to
  std::map<Making, MaterialId> made_;
  std::map<std::string, ObjectId, std::less<>> ids_;
  std::map<std::string, Object, std::less<>> objects_;
  std::map<std::string, std::size_t> instances_;  // of each object
  Object* current_ = nullptr;                     // that is being defined
  std::size_t shapes_ = 0, triangles_ = 0;
};

}  // namespace deltalux::io::pbrt
