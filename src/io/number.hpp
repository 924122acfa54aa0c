#pragma once
// Decimal numbers of text files.
#include <optional>
#include <string>
#include <string_view>

namespace deltalux::io {

/// The number that all of `word` is, a leading '+' allowed; 0 for what is nearer to zero than any double. nullopt for
/// everything else: other words, nan, inf, and numbers beyond the doubles.
std::optional<double> parseDecimal(std::string_view word);

/// What is wrong with a word of which parseDecimal makes nothing, for messages: "'1e400' is too large a number".
std::string notANumber(std::string_view word);

}  // namespace deltalux::io
