#pragma once
// JSON documents, with the line of what keeps them from being read.
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>

namespace deltalux::io {

/// The document that `text` of the file `name` holds. Throws InputError with `hint` and the line for text that is not
/// JSON, numbers beyond the doubles, and nesting deeper than 100, on which recursion over the document would founder.
nlohmann::json parseJson(std::string_view text, const std::string& name, const char* hint);

/// The line in a document's text of what a JSON pointer means; where that is not there, of the last part that is. Keys
/// are compared as they are written. Precondition: the text is JSON.
int lineOf(std::string_view text, std::string_view pointer);

}  // namespace deltalux::io
