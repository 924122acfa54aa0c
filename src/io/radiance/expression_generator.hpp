#pragma once
#include "io/radiance/calc.hpp"
#include "io/radiance/object_maker.hpp"

namespace deltalux::io::radiance {

/// If `option` is -e or -f, takes its argument from `maker` into `calc` and returns true.
bool readDefinition(const std::string& option, ObjectMaker& maker, Calc& calc);

/// A number of segments given as an expression; at least 1, at most a million.
int segmentCount(const std::string& expression, const ObjectMaker& maker, Calc& calc);

}  // namespace deltalux::io::radiance
