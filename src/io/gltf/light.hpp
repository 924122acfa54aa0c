#pragma once
// Lights and cameras that glTF nodes carry. [KHR_lights_punctual; EXT_lights_ies; glTF 2.0, 3.10]
#include <deltalux/scene.hpp>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "io/gltf/document.hpp"

namespace deltalux::io {

/// `light` at the origin of `toWorld`, aimed along its -Z. Candelas and lux are divided by `luminousEfficacy`.
Light punctualLight(const tinygltf::Light& light, const Mat4& toWorld, double luminousEfficacy, std::string name);

/// The document's IES profiles, in order; warnings are appended. Throws InputError.
std::vector<std::shared_ptr<const Photometry>> readProfiles(const GltfDocument&, std::vector<std::string>& warnings);

/// A node's measured light: `instance` is the node's extension object. Its candelas become watts by `luminousEfficacy`.
Light measuredLight(const tinygltf::Value& instance, const std::vector<std::shared_ptr<const Photometry>>& profiles,
                    const Mat4& toWorld, double luminousEfficacy, std::string name);

/// A camera's view: along -Z of `toWorld`, +Y up. Perspective without an aspect ratio gets 16:9.
View viewOf(const tinygltf::Camera&, const Mat4& toWorld, std::string name);

/// Rotation of `toWorld` alone: orthonormal columns along its x and z axes; the identity where those do not exist.
glm::dmat3 rotationOf(const Mat4& toWorld);

}  // namespace deltalux::io
