#pragma once
// web/dist/index.html, the page without a solution, as bytes (cmake/embed_page.cmake).
#include <string_view>

namespace deltalux::exporting {

std::string_view pageTemplate();

}  // namespace deltalux::exporting
