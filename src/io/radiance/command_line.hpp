#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// The words of each command of a pipeline, quoted as a POSIX shell reads them ('...', "...", backslash). What only a
/// shell could do (substitution, redirection, lists) is an InputError: nothing is ever run. * and ? mean themselves.
std::vector<std::vector<std::string>> parsePipeline(std::string_view text, const SourceLine& where);

}  // namespace deltalux::io::radiance
