#pragma once
// What the bytes of a case in corpus/dlx mean: changes to the solution of a small room. Each is one byte for the
// section, three for the offset in it, one for a length n, and n bytes that are written there; a length of 255 ends the
// section at that offset. Sections are packed and the frame is sealed afterwards, so that the changes get past the
// checksums; from 128 on a section's number means what it is packed to. Such cases stay good when the records of a
// solution change.
#include <deltalux/engine.hpp>

#include "io/solution_file.hpp"
#include "io/solution_file/packing.hpp"

namespace deltalux::fuzz {

struct StoredSection {
  std::string tag, payload;  // unpacked but in a file
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

inline const std::vector<StoredSection>& smallSolution(SolveMethod method = SolveMethod::Lines) {
  const auto solve = [](SolveMethod by) {
    SolveSettings settings;
    settings.error = 0.9, settings.method = by;
    Engine engine(smallRoom(), settings);
    engine.solve();
    std::string bytes;
    io::writeSolution(engine.solution(), [&](std::string_view block) { bytes += block; });
    std::vector<StoredSection> stored;
    for (const io::Section& s : io::openContainer(bytes, "small.dlx")) {
      io::ArchiveReader reader(s.payload, "small.dlx");
      std::string payload(reader.left(), '\0');
      reader.bytes(payload.data(), payload.size());
      stored.push_back({std::string(s.tag), std::move(payload)});
    }
    return stored;
  };
  static const std::vector<StoredSection> lines = solve(SolveMethod::Lines), paper = solve(SolveMethod::Paper);
  return method == SolveMethod::Lines ? lines : paper;
}

inline std::vector<StoredSection> packed(std::vector<StoredSection> sections) {
  for (StoredSection& s : sections) {
    io::Packer packer;
    packer.bytes(s.payload.data(), s.payload.size());
    s.payload = packer.finish();
  }
  return sections;
}

/// A file of sections that are packed.
inline std::string sealed(const std::vector<StoredSection>& sections) {
  std::vector<io::Section> views;
  for (const StoredSection& s : sections) views.push_back({s.tag, s.payload});
  std::string bytes;
  io::writeContainer(views, [&](std::string_view block) { bytes += block; });
  return bytes;
}

/// Makes the changes of `input` whose section number is from 128 on, or those with one below.
inline void change(std::vector<StoredSection>& sections, std::string_view input, bool from128) {
  const auto byte = [&](std::size_t i) { return static_cast<std::size_t>(static_cast<unsigned char>(input[i])); };
  while (input.size() >= 5) {
    const bool meant = (byte(0) >= 128) == from128;
    std::string& payload = sections[byte(0) % 128 % sections.size()].payload;
    const std::size_t at = (byte(1) + 256 * byte(2) + 65536 * byte(3)) % (payload.size() + 1), length = byte(4);
    input.remove_prefix(5);
    if (length == 255) {
      if (meant) payload.resize(at);
      continue;
    }
    const std::string_view bytes = input.substr(0, length);
    if (meant)
      for (std::size_t i = 0; i < bytes.size() && at + i < payload.size(); ++i) payload[at + i] = bytes[i];
    input.remove_prefix(bytes.size());
  }
}

inline std::string dlxOf(std::string_view input, SolveMethod method = SolveMethod::Lines) {
  static const std::vector<StoredSection> lines = packed(smallSolution(SolveMethod::Lines)),
                                          paper = packed(smallSolution(SolveMethod::Paper));
  const std::vector<StoredSection>& before = smallSolution(method);
  std::vector<StoredSection> sections = before;
  change(sections, input, false);
  for (std::size_t i = 0; i < sections.size(); ++i)
    sections[i] = sections[i].payload == before[i].payload ? (method == SolveMethod::Lines ? lines : paper)[i]
                                                           : packed({sections[i]}).front();
  change(sections, input, true);
  return sealed(sections);
}

}  // namespace deltalux::fuzz
