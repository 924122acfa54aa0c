#pragma once
#include <deltalux/io.hpp>
#include <string>

namespace deltalux::cli {

/// The text of `deltalux info`: one section per kind of thing, names as edits and options take them.
std::string summarize(const ImportedScene&);

}  // namespace deltalux::cli
