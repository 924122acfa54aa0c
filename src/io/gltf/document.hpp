#pragma once
// A glTF file taken apart: its tree as tinygltf reads it, its buffers as bytes.
//
// tinygltf trusts sizes and indices, and opens what a file names. So the JSON is checked first (check.hpp), buffers and
// images are taken out of it and read here, and tinygltf gets a document without any reference to bytes.
#include <tiny_gltf.h>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

struct GltfImage {
  std::string uri;  // empty: in the buffer view
  int bufferView = -1;
};

struct GltfDocument {
  std::string name;  // of the file, in messages
  std::filesystem::path folder;
  tinygltf::Model model;  // without buffers, images, skins and animations
  std::vector<std::string> buffers;
  std::vector<GltfImage> images;
  std::size_t skins = 0, animations = 0;
};

/// Throws InputError for anything whose form is not glTF 2.0; every index of the model is in range afterwards.
GltfDocument openGltf(std::string_view bytes, const std::string& name, const std::filesystem::path& folder);

/// The bytes of a buffer view. Throws InputError when they are not there.
std::string_view bytesOfView(const GltfDocument&, int bufferView);

/// What `uri` holds: a data URI, or a file in the document's folder. `where` is the place in the document.
std::string bytesOfUri(const std::string& name, const std::filesystem::path& folder, const std::string& uri,
                       const std::string& where);

}  // namespace deltalux::io
