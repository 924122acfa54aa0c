#pragma once
// Members of extension objects as tinygltf keeps them, with their defaults.
#include <deltalux/units.hpp>
#include <string>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// The extension `name`, or nullptr.
inline const tinygltf::Value* extensionOf(const tinygltf::ExtensionMap& extensions, const char* name) {
  const auto found = extensions.find(name);
  return found != extensions.end() && found->second.IsObject() ? &found->second : nullptr;
}

/// The number `key` of `object`; `otherwise` when either is not there.
inline double numberOf(const tinygltf::Value* object, const char* key, double otherwise) {
  if (!object || !object->Has(key) || !object->Get(key).IsNumber()) return otherwise;
  return object->Get(key).GetNumberAsDouble();
}

/// The first `size` numbers of the array `key`; `otherwise` when it is not there or shorter.
inline std::vector<double> numbersOf(const tinygltf::Value* object, const char* key, std::vector<double> otherwise) {
  if (!object || !object->Has(key) || object->Get(key).ArrayLen() < otherwise.size()) return otherwise;
  for (std::size_t i = 0; i < otherwise.size(); ++i) {
    otherwise[i] = object->Get(key).Get(static_cast<int>(i)).GetNumberAsDouble();
  }
  return otherwise;
}

inline Rgb rgbOf(const std::vector<double>& numbers) {
  return {static_cast<float>(numbers[0]), static_cast<float>(numbers[1]), static_cast<float>(numbers[2])};
}

}  // namespace deltalux::io
