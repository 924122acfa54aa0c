#include "io/import_report.hpp"

namespace deltalux::io {

void warnOfIgnored(ImportReport& report) {
  std::string list;
  for (const auto& [kind, count] : report.ignored) {
    list += (list.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  }
  if (!list.empty()) report.warnings.push_back("ignored: " + list);
}

}  // namespace deltalux::io
