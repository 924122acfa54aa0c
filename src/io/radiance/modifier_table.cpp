#include "io/radiance/modifier_table.hpp"

#include <algorithm>

#include "io/radiance/rad_materials.hpp"

namespace deltalux::io::radiance {

namespace {
constexpr std::string_view kVoid = "void";

bool sameArguments(const RadObject& a, const RadObject& b) {
  return a.type == b.type && a.reals == b.reals && a.strings == b.strings;
}
}  // namespace

void ModifierTable::define(const RadObject& object) { byName_.insert_or_assign(object.name, resolve(object)); }

Modifier ModifierTable::lookUp(const std::string& name, const RadObject& user) const {
  if (name == kVoid) return {};
  if (const auto found = byName_.find(name); found != byName_.end()) return found->second;
  std::vector<std::string> names;
  for (const auto& [known, modifier] : byName_) names.push_back(known);
  std::string hint = "define it above its use";
  for (const std::string& near : nearMisses(name.substr(0, 100), names)) {
    hint += (hint.ends_with("use") ? "; near: " : ", ") + near;
  }
  throw inputError(user.where,
                   "'" + name.substr(0, 100) + "', which " + user.typeName + " '" + user.name.substr(0, 100) +
                       "' names, is not defined before it",
                   hint);
}

Modifier ModifierTable::resolve(const RadObject& object) {
  // `inherit` keeps the modifier of what an alias stands for.
  const Modifier base = object.modifier == "inherit" ? Modifier{} : lookUp(object.modifier, object);
  switch (object.type) {
    case Type::Pattern:
      patterns_.push_back(&object);
      [[fallthrough]];
    case Type::SkyBrightness:
    case Type::PerezBrightness: {
      Modifier modifier = base;
      modifier.patterns.push_back(&object);
      return modifier;
    }
    case Type::Mixture: {
      const bool evaluated = object.typeName == "mixfunc";
      if (!evaluated) ++report_.ignored[object.typeName];
      if (object.strings.size() < 2) {
        throw inputError(object.where, object.typeName + " '" + object.name + "' names no two modifiers to mix");
      }
      const Modifier first = lookUp(object.strings[0], object);
      const bool ends = first.material.valid() || !first.unsupported.empty();
      if (!evaluated) return ends ? first : lookUp(object.strings[1], object);
      const Modifier second = lookUp(object.strings[1], object);
      patterns_.push_back(&object);
      Modifier mixed = ends ? first : second;
      mixed.patterns = base.patterns;
      mixed.mixture = std::make_shared<const Mixture>(Mixture{&object, first, second});
      return mixed;
    }
    case Type::Alias: {
      const Modifier modifier = lookUp(object.strings[0], object);
      return base.patterns.empty() ? modifier : patterned(modifier, base);
    }
    case Type::Unsupported:
      return {{}, object.type, object.typeName, {}, nullptr};
    default:
      return patterned({materialFor(object), object.type, {}, {}, nullptr}, base);
  }
}

Modifier ModifierTable::patterned(Modifier modifier, const Modifier& base) {
  modifier.patterns = base.patterns;
  const bool emits = modifier.material.valid() && scene_[modifier.material].emission;
  if (!emits) onSurfaces_.insert(base.patterns.begin(), base.patterns.end());
  return modifier;
}

void ModifierTable::noteUnread(const Asked& byLights, const Asked& bySurfaces) {
  for (const RadObject* pattern : patterns_) {
    const bool read =
        onSurfaces_.count(pattern) != 0 ? bySurfaces(*pattern) : byLights(*pattern) || bySurfaces(*pattern);
    if (!read) ++report_.ignored[pattern->typeName];
  }
}

MaterialId ModifierTable::alternateOf(const RadObject& object) const {
  const bool mayHave = object.type == Type::Mirror || object.type == Type::Illum;
  if (!mayHave || object.strings.empty()) return {};
  return lookUp(object.strings[0], object).material;
}

/// Counts what the material asks for and does not get.
void ModifierTable::noteSimplifications(const RadObject& object) {
  const std::vector<double>& a = object.reals;
  const auto ignored = [&](const char* what) { ++report_.ignored[what]; };
  switch (object.type) {
    case Type::Glass:
      if (std::max({a[0], a[1], a[2]}) > 1) ignored("glass transmissivity above 1");
      break;
    case Type::Dielectric:
      if (a[4] != 0) ignored("dielectric dispersion");
      break;
    case Type::Plastic2:
    case Type::Metal2:
    case Type::Trans2:
      if (a[4] != a[5]) ignored("anisotropy");
      break;
    default:
      break;
  }
}

MaterialId ModifierTable::materialFor(const RadObject& object) {
  const MaterialId alternate = alternateOf(object);
  std::vector<Made>& made = made_[object.name];
  for (const Made& earlier : made) {
    if (earlier.alternate == alternate && sameArguments(*earlier.source, object)) return earlier.material;
  }
  noteSimplifications(object);
  const MaterialId material(scene_.materials.size());
  scene_.materials.push_back(makeMaterial(object, alternate.valid() ? &scene_[alternate] : nullptr));
  made.push_back({&object, alternate, material});
  return material;
}

}  // namespace deltalux::io::radiance
