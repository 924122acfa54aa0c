#pragma once
// Memory that was freed stays with the C library for who asks next. From update to update, pieces of it that no array
// fits into add up; giving all of it back each time would cost an update a twentieth of its time.
#include <cstdint>

namespace deltalux {

class FreedMemory {
 public:
  /// Called after each update: gives freed memory back to the system where what is resident has grown by more than an
  /// eighth since the first one, or since so much was in use. Does nothing where the C library cannot.
  void giveBack();

 private:
  std::uint64_t usual_ = 0;  // resident after an update [bytes]
};

/// Of this process; 0 where the system does not tell [bytes].
std::uint64_t residentBytes();

}  // namespace deltalux
