#pragma once
// Radiance's data files: values over a grid of one to five dimensions. [Radiance, "File Formats", data files]
//
//   N, then for each dimension `begin end count` (equal steps) or `0 0 count` and as many coordinates in order, then
//   the values, the last dimension running fastest; # comments.
#include <span>
#include <vector>

#include "io/radiance/file_access.hpp"

namespace deltalux::io::radiance {

struct DataTable {
  struct Dimension {
    double begin = 0, end = 0;
    std::size_t count = 0;
    std::vector<double> points;  // `count` of them, in strict order; empty: equal steps
  };
  std::vector<Dimension> dimensions;
  std::vector<double> values;
};

/// Throws InputError with the file and line.
DataTable parseDataTable(const SourceFile&);

/// Multilinear between the points. Outside, values go on straight for one step and then fall off with distance, as
/// Radiance has it; a dimension of one point does not matter.
double valueAt(const DataTable&, std::span<const double> at);

}  // namespace deltalux::io::radiance
