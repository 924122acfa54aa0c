#pragma once
#include <deltalux/edit_io.hpp>
#include <nlohmann/json.hpp>

#include "io/json_view.hpp"

namespace deltalux::io {

inline constexpr const char* kEditHint = "docs/command_line.md shows the form of edits";

/// The steps of the document's "edits".
std::vector<EditStep> readEdits(const JsonView& document, const std::string& file, const std::filesystem::path& folder,
                                const ImportSettings&);

/// One step as an entry that readEdits takes; transforms are written as matrices.
nlohmann::ordered_json entryOf(const EditStep&);

}  // namespace deltalux::io
