#pragma once
// Points files: where irradiance is asked for, and the same rows with the answers.
#include <deltalux/probe.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux {

/// A CSV with a header row; columns x,y,z,nx,ny,nz in scene units, in any order, others are carried through.
struct PointTable {
  std::vector<std::string> columns;            // of the header row, trimmed
  std::vector<std::vector<std::string>> rows;  // fields verbatim (quotes included), as many as columns
  std::vector<ProbePoint> points;              // one per row, in the file's coordinates; normals are made unit

  /// The number of the column of that name.
  std::optional<std::size_t> column(std::string_view name) const;
};

/// Reads a points file. Lines that start with '#' and blank lines are skipped. Throws InputError with the line: a
/// missing or doubled column, a row of the wrong length, a number that is none, a normal of length 0, no rows at all.
PointTable readPoints(const std::filesystem::path&);
PointTable parsePoints(std::string_view text, const std::string& fileName);

/// The table's points in the coordinates of a scene.
std::vector<ProbePoint> pointsIn(const Scene&, const PointTable&);

/// The table's rows plus the results' columns: E_r,E_g,E_b [W/m2], lux, and the standard errors of E, se_r,se_g,se_b; a
/// column of the table that has a result's name is replaced by it. results.size() == table.rows.size(); the efficacy is
/// the scene's.
std::string formatProbeResults(const PointTable& table, std::span<const ProbeResult> results,
                               double luminousEfficacy = kLuminousEfficacy);
/// The same with columns lux_NAME in place of the results', by group of lights: `results` has each group's at all
/// points. They are a matrix A: where lights are dimmed by w, illuminance is A w [lux].
std::string formatProbeColumns(const PointTable& table, std::span<const std::string> names,
                               std::span<const std::vector<ProbeResult>> results, double luminousEfficacy);
void writeProbeColumns(const std::filesystem::path&, const PointTable& table, std::span<const std::string> names,
                       std::span<const std::vector<ProbeResult>> results, double luminousEfficacy);
/// formatProbeResults into a file, atomically. Throws OutputError.
void writeProbeResults(const std::filesystem::path&, const PointTable& table, std::span<const ProbeResult> results,
                       double luminousEfficacy);

}  // namespace deltalux
