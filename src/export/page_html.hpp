#pragma once
#include <string>
#include <string_view>

namespace deltalux::exporting {

/// The template with a solution put into its place: gzip and base64 of pageBytes(). Precondition: the template has one.
std::string pageHtml(std::string_view pageTemplate, std::string_view bytes);

}  // namespace deltalux::exporting
