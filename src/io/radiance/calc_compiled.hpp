#pragma once
#include <muParser.h>

#include <optional>
#include <string>
#include <vector>

#include "io/radiance/calc.hpp"

namespace deltalux::io::radiance {

/// An expression ready to run: muParser's program, and the slots it reads its parameters from.
struct Calc::Compiled {
  std::string name;
  std::vector<double> slots;
  mu::Parser parser;
  long* callsLeft = nullptr;
  long cost = 1;        // in calls: long programs take their time
  bool varies = false;  // with bound variables

  double operator()(const double* arguments, std::size_t count);
};

/// A parser that knows calc's library functions under their calc names, and nothing else.
mu::Parser calcParser();
/// Number of arguments of a library function, -1 for any, or nullopt when it is none.
std::optional<int> libraryArity(std::string_view name);

}  // namespace deltalux::io::radiance
