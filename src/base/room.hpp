#pragma once
#include <vector>

namespace deltalux {

/// Resizes a large table and leaves room for what is added later, so that little of that moves it as a whole.
template <class T, class Memory>
void resizeWithRoom(std::vector<T, Memory>& table, std::size_t size, const T& fill = {}) {
  constexpr std::size_t kRoom = 16;  // of a part more [task]
  if (size > table.capacity()) table.reserve(size + size / kRoom);
  table.resize(size, fill);
}

}  // namespace deltalux
