#include "io/gltf/accessor.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <deltalux/error.hpp>

namespace deltalux::io {

namespace {

InputError fail(const GltfDocument& document, int accessor, const std::string& message) {
  return InputError(document.name, 0, "/accessors/" + std::to_string(accessor) + " " + message,
                    "export the scene again");
}

template <class T>
T load(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

// [glTF 2.0, 3.6.2.2]
double componentAt(const char* bytes, int componentType, bool normalized) {
  const auto fraction = [&](double value, double top) { return normalized ? std::max(value / top, -1.0) : value; };
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return fraction(load<std::int8_t>(bytes), 127);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return fraction(load<std::uint8_t>(bytes), 255);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return fraction(load<std::int16_t>(bytes), 32767);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return fraction(load<std::uint16_t>(bytes), 65535);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return load<std::uint32_t>(bytes);
    default:
      return static_cast<double>(load<float>(bytes));
  }
}

// A run of equally spaced elements within a buffer view, known to lie inside it.
struct Run {
  const char* bytes = nullptr;
  std::size_t stride = 0;
  std::size_t componentSize = 0;
};

Run runOf(const GltfDocument& document, int accessor, int bufferView, std::size_t offset, int componentType,
          int components, std::size_t count, bool strided) {
  const std::string_view view = bytesOfView(document, bufferView);
  const auto componentSize =
      static_cast<std::size_t>(tinygltf::GetComponentSizeInBytes(static_cast<std::uint32_t>(componentType)));
  const std::size_t size = componentSize * static_cast<std::size_t>(components);
  const std::size_t given = document.model.bufferViews[static_cast<std::size_t>(bufferView)].byteStride;
  const std::size_t stride = strided && given != 0 ? given : size;
  const bool fits =
      offset <= view.size() && size <= view.size() - offset && (count - 1) <= (view.size() - offset - size) / stride;
  if (!fits) {
    throw fail(
        document, accessor,
        "needs more bytes than the " + std::to_string(view.size()) + " of /bufferViews/" + std::to_string(bufferView));
  }
  return {view.data() + offset, stride, componentSize};
}

using Accessor = tinygltf::Accessor;

// Writes the changed elements of a sparse accessor over `values`. [glTF 2.0, 3.6.2.3]
void putSparse(const GltfDocument& document, int index, const Accessor& accessor, int components,
               std::vector<double>& values) {
  const auto& sparse = accessor.sparse;
  const auto count = static_cast<std::size_t>(sparse.count);
  const Run where =
      runOf(document, index, sparse.indices.bufferView, static_cast<std::size_t>(sparse.indices.byteOffset),
            sparse.indices.componentType, 1, count, false);
  const Run what = runOf(document, index, sparse.values.bufferView, static_cast<std::size_t>(sparse.values.byteOffset),
                         accessor.componentType, components, count, false);
  for (std::size_t i = 0; i < count; ++i) {
    const double element = componentAt(where.bytes + i * where.stride, sparse.indices.componentType, false);
    if (!(element >= 0 && element < static_cast<double>(accessor.count))) {
      throw fail(document, index, "changes an element that it does not have");
    }
    for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c) {
      values[static_cast<std::size_t>(element) * static_cast<std::size_t>(components) + c] = componentAt(
          what.bytes + i * what.stride + c * what.componentSize, accessor.componentType, accessor.normalized);
    }
  }
}

std::vector<double> readComponents(const GltfDocument& document, int index, int components) {
  const Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  if (tinygltf::GetNumComponentsInType(static_cast<std::uint32_t>(accessor.type)) != components) {
    throw fail(document, index, "is not of " + std::to_string(components) + " components");
  }
  constexpr std::size_t kMaxWithoutBytes = std::size_t{1} << 22;  // [limit]
  if (accessor.bufferView < 0 && (!accessor.sparse.isSparse || accessor.count > kMaxWithoutBytes)) {
    throw fail(document, index, "has no data; if the file is compressed (Draco, meshopt), export it without");
  }
  const Run run = accessor.bufferView < 0 ? Run{}
                                          : runOf(document, index, accessor.bufferView, accessor.byteOffset,
                                                  accessor.componentType, components, accessor.count, true);
  const auto width = static_cast<std::size_t>(components);
  std::vector<double> values(accessor.count * width, 0.0);
  for (std::size_t i = 0; run.bytes && i < accessor.count; ++i) {
    for (std::size_t c = 0; c < width; ++c) {
      values[i * width + c] =
          componentAt(run.bytes + i * run.stride + c * run.componentSize, accessor.componentType, accessor.normalized);
    }
  }
  if (accessor.sparse.isSparse) putSparse(document, index, accessor, components, values);
  return values;
}

}  // namespace

std::vector<double> readVectors(const GltfDocument& document, int accessor, int components) {
  std::vector<double> values = readComponents(document, accessor, components);
  if (!std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); })) {
    throw fail(document, accessor, "holds numbers that are not finite");
  }
  return values;
}

std::vector<std::uint32_t> readIndices(const GltfDocument& document, int index) {
  const Accessor& accessor = document.model.accessors[static_cast<std::size_t>(index)];
  switch (accessor.componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      break;
    default:
      throw fail(document, index, "holds vertex indices that are not unsigned numbers");
  }
  const std::vector<double> values = readComponents(document, index, 1);
  std::vector<std::uint32_t> indices(values.size());
  std::transform(values.begin(), values.end(), indices.begin(), [](double v) { return static_cast<std::uint32_t>(v); });
  return indices;
}

}  // namespace deltalux::io
