#pragma once
#include <string>
#include <string_view>

namespace deltalux::exporting {

struct PageBytes;

/// The template with a solution put into its places: gzip and base64 of pageBytes(). Precondition: the template has
/// both.
std::string pageHtml(std::string_view pageTemplate, const PageBytes&);

}  // namespace deltalux::exporting
