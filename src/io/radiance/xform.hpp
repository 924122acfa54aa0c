#pragma once
#include <span>
#include <string>
#include <vector>

#include "io/radiance/transform.hpp"

namespace deltalux::io::radiance {

/// What an xform command asks for: one placement per copy, outermost array first, and the files it reads (none: a
/// pipe).
struct XformCommand {
  std::vector<Placement> copies;
  std::vector<std::string> files;
};

/// Parses xform's words after its name. `-a N` makes N copies that repeat, 0 to N-1 times, what follows it up to the
/// next -a or -i; copies are named NAME.0, NAME.1 ..., or a0, a1 ... without -n. -c and -e (when to expand commands)
/// change nothing here. [Radiance, xform(1)] Throws InputError, also for more than `mostCopies`.
XformCommand parseXform(std::span<const std::string> words, std::size_t mostCopies, const SourceLine& where);

}  // namespace deltalux::io::radiance
