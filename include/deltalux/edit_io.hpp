#pragma once
// Edits in files, and recordings: a session as a file that can be played again.
//
//   {"edits": [
//     {"op": "transform", "object": NAME, "translate": [x,y,z]},
//     {"op": "transform", "object": NAME, "rotate": {"axis": [x,y,z], "degrees": d, "about": [x,y,z]}},
//     {"op": "transform", "object": NAME, "matrix": [16 numbers, row-major]},
//     {"op": "light", "light": NAME, one of "scale": s, "rgb": [r,g,b], "on": true or false, "aim": [x,y,z],
//                                           "translate": [x,y,z]},
//     {"op": "material", "material": NAME, "reflectance": [r,g,b] and/or "roughness": a},
//     {"op": "sky", "sky": "cie:12" or "perez:800,100", "when": "2026-06-21T09:00+02:00", "where": [latitude,
//     longitude],
//                   "north": degrees, "ground": reflectance},    what is left out is as in the entry of a sky before
//     {"op": "add", "object": NAME, "scene": FILE, "matrix": [16 numbers]},       "matrix" may be left out
//     {"op": "remove", "object": NAME}, {"op": "undo"}, {"op": "redo"}
//   ]}
//
// A recording has "scene": [files], "luminaires", "import", "daylight", "seed" and "settings" beside its edits.
#include <deltalux/edit.hpp>
#include <deltalux/io.hpp>
#include <deltalux/settings.hpp>
#include <filesystem>
#include <string_view>

namespace deltalux {

struct Undo {};
struct Redo {};
/// One step of a session.
using EditStep = std::variant<Edit, Undo, Redo>;

/// Reads an edits file (or the edits of a recording). Files that are added lie in its folder and are read with
/// `import`. Throws InputError: not JSON, an unknown operation or key, numbers missing, undo without anything to undo.
std::vector<EditStep> loadEdits(const std::filesystem::path&, const ImportSettings& import = {});
std::vector<EditStep> parseEdits(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                                 const ImportSettings& import = {});

/// Applies one step. Throws InputError.
AppliedEdit applyStep(Scene&, EditHistory&, const EditStep&);
/// Tries all steps on a copy of the scene. Throws InputError that names the first step that cannot be.
void validateEdits(Scene, const std::vector<EditStep>&, const std::string& file);

/// A session, and all that it takes to have it again.
struct Recording {
  std::vector<std::filesystem::path> scene;
  std::vector<Luminaire> luminaires;
  ImportSettings import;
  std::optional<Daylighting> daylight;  // that is put over the scene
  SolveSettings settings;               // with the seed
  std::vector<EditStep> steps;
};

/// The recording as JSON text. Steps hold no Restore: sessions say undo (checked).
std::string toJson(const Recording&);
/// Steps as an edits file, atomically; files that they add must be named from its folder. Throws OutputError.
void saveEdits(const std::filesystem::path&, const std::vector<EditStep>&);
/// toJson into a file, atomically, with files named from its folder. Files that steps add must lie there, or below.
/// Throws OutputError.
void saveRecording(const std::filesystem::path&, const Recording&);
/// Names of files are those from here again. Throws InputError.
Recording loadRecording(const std::filesystem::path&);

}  // namespace deltalux
