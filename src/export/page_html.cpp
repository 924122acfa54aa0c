#include "export/page_html.hpp"

#include "base/check.hpp"
#include "export/packing.hpp"

namespace deltalux::exporting {

std::string pageHtml(std::string_view pageTemplate, std::string_view bytes) {
  constexpr std::string_view kPlace = "@DELTALUX_SOLUTION@";
  const std::size_t at = pageTemplate.find(kPlace);
  DELTALUX_CHECK(at != std::string_view::npos, "the template has a place for the solution");
  std::string out(pageTemplate.substr(0, at));
  out += base64(gzip(bytes));
  out += pageTemplate.substr(at + kPlace.size());
  return out;
}

}  // namespace deltalux::exporting
