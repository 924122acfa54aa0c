#pragma once
// Reading scenes. The format follows from the file name: .rad (and names without a known extension), .gltf, .glb, .obj,
// .xml (Mitsuba), .pbrt.
#include <deltalux/scene.hpp>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace deltalux {

struct ImportSettings {
  /// glTF photometric values to radiometric [lm/W]; 179 is Radiance's convention, 683 Blender's exporter. The scene
  /// keeps it. Other formats hold radiometric values, whose efficacy is 179.
  double luminousEfficacy = kLuminousEfficacy;
  /// Metres per scene unit where the format does not say (all but glTF).
  double metresPerUnit = 1.0;
};

struct ImportReport {
  std::map<std::string, std::size_t> surfaces;  // by the format's own type names: "polygon", "cylinder", "source" ...
  std::map<std::string, std::size_t> ignored;   // what was skipped, by kind ("colorpict", "texfunc" ...)
  std::vector<std::string> warnings;            // one line each; at most one for everything in `ignored`
};

struct ImportedScene {
  Scene scene;
  ImportReport report;
};

/// Reads `files` as one scene: several .rad files in order, as `oconv a b c` takes them, or one file of another format.
/// The scene has its fittingOrigin. Throws InputError (file, line, what to do); nothing is half-read.
ImportedScene loadScene(const std::vector<std::filesystem::path>& files, const ImportSettings& = {});

/// Reads an IES LM-63 file (1986-2019; types A, B, C) into type C photometry. Throws InputError. What was mended or
/// looks doubtful in the file is appended to `warnings`, one line each, when given.
Photometry loadPhotometry(const std::filesystem::path& file, std::vector<std::string>* warnings = nullptr);

/// A measured light that hangs in a scene: aimed against its up, the 0 degree plane along +x (+y where up is x).
struct Luminaire {
  std::filesystem::path file;  // IES LM-63
  Vec3 position{0};            // in the coordinates of the scene's files
};

/// Adds it, named after its file and different from every light; `warnings` as in loadPhotometry. Throws InputError.
void addLuminaire(Scene&, const Luminaire&, std::vector<std::string>* warnings = nullptr);

/// Reads a Radiance view file: the last line that starts with rview, rvu, rpict or VIEW=, in its own coordinates.
/// Throws InputError.
View loadView(const std::filesystem::path& file);

}  // namespace deltalux
