#pragma once

namespace deltalux {

constexpr double square(double x) { return x * x; }

}  // namespace deltalux
