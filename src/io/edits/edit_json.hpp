#pragma once
#include <deltalux/edit_io.hpp>
#include <nlohmann/json.hpp>

#include "io/json_view.hpp"

namespace deltalux::io {

inline constexpr const char* kEditHint = "docs/command_line.md shows the form of edits";

/// The steps of the document's "edits".
std::vector<EditStep> readEdits(const JsonView& document, const std::string& file, const std::filesystem::path& folder,
                                const ImportSettings&);

/// A daylight by the keys sky, when, where, north and ground; what is not said is as in `before`.
Daylighting daylightOf(const JsonView&, Daylighting before);
/// Its members, for readers as daylightOf.
nlohmann::ordered_json membersOf(const Daylighting&);

/// One step as an entry that readEdits takes; transforms are written as matrices.
nlohmann::ordered_json entryOf(const EditStep&);

}  // namespace deltalux::io
