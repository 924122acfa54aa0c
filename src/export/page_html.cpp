#include "export/page_html.hpp"

#include "base/check.hpp"
#include "export/packing.hpp"
#include "export/page_data.hpp"

namespace deltalux::exporting {

namespace {

void put(std::string& page, std::string_view place, std::string_view bytes) {
  const std::size_t at = page.find(place);
  DELTALUX_CHECK(at != std::string::npos, "the template has a place for the solution");
  page.replace(at, place.size(), base64(gzip(bytes)));
}

}  // namespace

std::string pageHtml(std::string_view pageTemplate, const PageBytes& bytes) {
  std::string page(pageTemplate);
  put(page, "@DELTALUX_SOLUTION@", bytes.first);
  put(page, "@DELTALUX_LATER@", bytes.later);
  return page;
}

}  // namespace deltalux::exporting
