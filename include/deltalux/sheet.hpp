#pragma once
// The sheet of a lighting design: what areas of a scene are to have and what they have, with plans, luminaires, a
// rendering, and how sure all of it is. docs/sheet.md.
#include <deltalux/glare.hpp>
#include <deltalux/grid.hpp>
#include <deltalux/light_groups.hpp>
#include <deltalux/render.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace deltalux {

/// What an area is to have, at least or (UGR) at most; nothing is asked of what is not there.
struct AreaRequirements {
  std::optional<double> mean, uniformity;            // Em [lux], U0
  std::optional<double> glare;                       // RUGL
  std::optional<double> cylindrical;                 // Ez [lux]
  std::optional<double> walls, ceiling;              // Em [lux]
  std::optional<double> surroundingUniformity = {};  // U0 of walls and ceiling
};

/// What EN 12464-1 asks for by the name of a kind of area, such as "office"; nullopt for a name that is none.
std::optional<AreaRequirements> en12464(std::string_view kind);
std::vector<std::string> en12464Kinds();

/// An area that is measured. Positions are in the coordinates of the scene's files.
struct SheetArea {
  std::string name, kind;                                     // kind: of en12464(), or empty
  std::variant<std::string, GridArea, std::vector<Vec3>> on;  // an object's surface, a rectangle, a polygon
  GridSettings grid;
  double eyeHeight = 1.2;    // above what it is on [m]
  int directions = 4;        // lines of sight from each place
  bool skipCovered = false;  // points with something less than 0.1 m before them are left out
  AreaRequirements required;
  std::vector<std::string> walls, ceiling;  // objects
  int line = 0;                             // of the file that asks for it
};

/// What light sources of a type draw: names as edits have them, * stands for anything.
struct LuminairePower {
  std::string pattern, name;  // name: what the sheet calls it; may be empty
  std::optional<double> watts = {};
};

struct SheetRequest {
  std::string file;  // that it was read from, for messages
  std::string title = "Lighting design", project, author, date;
  double maintenanceFactor = 1;
  std::string view;  // of the rendering: a view of the scene, or a .vf file; none if empty
  std::vector<SheetArea> areas;
  std::vector<LuminairePower> luminaires;
};

/// Reads a request (docs/sheet.md). Throws InputError with the line.
SheetRequest loadSheetRequest(const std::filesystem::path&);
SheetRequest parseSheetRequest(std::string_view text, const std::string& file);
/// Throws InputError, with the request's line, for surfaces and views that the scene does not have.
void validateSheetRequest(const SheetRequest&, const Scene&);

/// One quantity of an area.
struct SheetRow {
  std::string quantity, unit;
  double reached = 0;
  std::optional<double> required = {};
  bool atMost = false;  // otherwise at least
  double error = 0;     // of `reached`, about: from the solution's error, in its own unit

  bool passes() const { return !required || (atMost ? reached <= *required : reached >= *required); }
  /// Whether it is nearer to what is required than the error.
  bool close() const { return required && std::abs(reached - *required) < error; }
};

struct MeasuredArea {
  SheetArea area;
  MeasuringGrid grid;
  std::vector<double> lux;  // by point, maintenance factor included
  std::vector<SheetRow> rows;
  std::optional<UnifiedGlare> worst;  // of all places and lines of sight, where a limit is set
  std::size_t glareEyes = 0;
  std::size_t covered = 0;  // points with something less than 0.1 m before them, left out or not

  bool passes() const;
};

/// Luminaires of one kind.
struct LuminaireType {
  std::string name;
  int count = 0;
  double flux = 0;  // of one [lm]
  std::optional<double> watts = {};
  std::shared_ptr<const Photometry> photometry = {};  // of measured ones
};

struct Sheet {
  SheetRequest request;
  std::string scene;  // its name
  std::vector<MeasuredArea> areas;
  std::vector<LuminaireType> luminaires;
  std::optional<Image> rendering;
  double metresPerUnit = 1, luminousEfficacy = kLuminousEfficacy;
  ErrorEstimate error;
  SolveSettings settings;
};

struct SheetSettings {
  ProbeSettings probe;
  int width = 960;  // of the rendering [pixels]
  int samplesPerPixel = 16;
};

/// Measures all that the request asks for. Throws InputError (validateSheetRequest), Interrupted.
Sheet measureSheet(const SolutionView&, const SheetRequest&, const std::string& sceneName, const SheetSettings& = {},
                   Progress* = nullptr);

/// Kinds of luminaires, those that bring most flux first.
std::vector<LuminaireType> luminaireTypes(const Scene&, const std::vector<LuminairePower>& = {});

/// Whether this library was built with what writes PDF.
bool canWritePdf();
/// As .html or .pdf, by the name, atomically. Throws OutputError, also for a .pdf without canWritePdf().
void saveSheet(const std::filesystem::path&, const Sheet&);

}  // namespace deltalux
