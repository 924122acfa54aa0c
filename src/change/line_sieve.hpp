#pragma once
// Which of a leaf's lines come anywhere near where something has moved: for millions of them, a nanosecond each, so
// that few are looked at one by one.
#include <array>

#include "change/moved_space.hpp"
#include "lines/line_code.hpp"

namespace deltalux::change {

class LineSieve {
 public:
  /// Of lines that start anywhere in `from` and may go astray by `stray` of the way.
  LineSieve(const MovedSpace&, const BoxF& from, float stray);

  /// Marks lines by their codes; never too few. Sizes must agree.
  void mark(std::span<const lines::LineCode>, std::span<char> near) const;

 private:
  /// A group of boxes as lines from the origin see it.
  struct Target {
    Vec3f center, half;
    float far;  // how far lines have to run
  };

  std::array<Target, MovedSpace::kMostAround> targets_;
  std::size_t count_ = 0;
};

}  // namespace deltalux::change
