#pragma once
// What the bytes of a case in corpus/dlx mean: changes to the solution of a small room. Each is one byte for the
// section, three for the offset in it, one for a length n, and n bytes that are written there; a length of 255 ends the
// section at that offset. The frame is sealed again afterwards, so that the changes get past the checksums. Such cases
// stay good when the records of a solution change.
#include <deltalux/engine.hpp>

#include "io/solution_file.hpp"

namespace deltalux::fuzz {

struct StoredSection {
  std::string tag, payload;
};

/// A floor under a lamp, a ball and a mesh.
inline Scene smallRoom() {
  Scene scene;
  scene.materials.push_back({"grey", Opaque{Rgb(0.5f), {}, {}}, std::nullopt});
  scene.objects.push_back({"room", ObjectId()});
  const auto add = [&](Shape shape) { scene.primitives.push_back({std::move(shape), MaterialId(0), ObjectId(0)}); };
  add(*makePolygon({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  add(Sphere{{0.5, 0.5, 0.2}, 0.1});
  add(*makeMesh({{0, 0, 0.5}, {0.2, 0, 0.5}, {0, 0.2, 0.5}}, {{0, 1, 2}}));
  scene.lights.push_back({"lamp", PointLight{{0.5, 0.2, 1}, Rgb(1.0f)}, Rgb(1.0f)});
  Photometry photometry{{0, 180}, {0, 360}, {100, 100, 100, 100}, Vec3(0)};
  PhotometricLight measured;
  measured.position = {0.2, 0.8, 1};
  measured.photometry = std::make_shared<const Photometry>(photometry);
  scene.lights.push_back({"measured", measured, Rgb(1.0f)});
  return scene;
}

inline const std::vector<StoredSection>& smallSolution() {
  static const std::vector<StoredSection> sections = [] {
    SolveSettings settings;
    settings.error = 0.9;
    Engine engine(smallRoom(), settings);
    engine.solve();
    std::string bytes;
    io::writeSolution(engine.solution(), [&](std::string_view block) { bytes += block; });
    std::vector<StoredSection> stored;
    for (const io::Section& s : io::openContainer(bytes, "small.dlx"))
      stored.push_back({std::string(s.tag), std::string(s.payload)});
    return stored;
  }();
  return sections;
}

inline std::string sealed(const std::vector<StoredSection>& sections) {
  std::string bytes;
  const io::ByteSink sink = [&](std::string_view block) { bytes += block; };
  std::vector<std::uint64_t> lengths;
  for (const StoredSection& s : sections) lengths.push_back(s.payload.size());
  io::ContainerWriter writer(sink, lengths);
  for (const StoredSection& s : sections) {
    writer.beginSection(s.tag, s.payload.size());
    writer.bytes(s.payload.data(), s.payload.size());
    writer.endSection();
  }
  writer.flush();
  return bytes;
}

inline std::string dlxOf(std::string_view input) {
  std::vector<StoredSection> sections = smallSolution();
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(input[i])); };
  while (input.size() >= 5) {
    std::string& payload = sections[byte(0) % sections.size()].payload;
    const std::size_t at = (byte(1) + 256 * byte(2) + 65536 * byte(3)) % (payload.size() + 1), length = byte(4);
    input.remove_prefix(5);
    if (length == 255) {
      payload.resize(at);
      continue;
    }
    const std::string_view change = input.substr(0, length);
    for (std::size_t i = 0; i < change.size() && at + i < payload.size(); ++i) payload[at + i] = change[i];
    input.remove_prefix(change.size());
  }
  return sealed(sections);
}

}  // namespace deltalux::fuzz
