// Any bytes as a data file of Radiance: a table whose values can be looked up anywhere, or an InputError.
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <deltalux/error.hpp>
#include <limits>

#include "io/radiance/data_table.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace deltalux;
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    const io::radiance::DataTable table = io::radiance::parseDataTable({"data", {}, "data", text});
    for (const double x : {-1e300, -1.0, 0.0, 0.3, 90.0, 1e300, std::numeric_limits<double>::quiet_NaN()}) {
      valueAt(table, std::vector<double>(table.dimensions.size(), x));
    }
  } catch (const InputError& error) {
    if (error.message().empty()) std::abort();
  }
  return 0;
}
