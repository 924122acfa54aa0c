// Memory that was freed goes back to the system once it has become much.
#include "base/freed_memory.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace deltalux {
namespace {

TEST(FreedMemory, GoesBackOnceItIsMuch) {
#if !defined(__GLIBC__) || defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "memory of another allocator";
#endif
  if (residentBytes() == 0) GTEST_SKIP() << "no /proc/self/statm here";
  constexpr std::size_t kPiece = 1 << 16, kPieces = 4000, kAll = kPiece * kPieces;
  FreedMemory freed;
  freed.giveBack();  // learns what is usual
  std::vector<std::unique_ptr<char[]>> pieces(kPieces);
  for (auto& piece : pieces) piece = std::make_unique<char[]>(kPiece);
  for (std::size_t i = 0; i + 1 < kPieces; ++i) pieces[i].reset();  // the last one keeps the heap from shrinking
  const std::uint64_t before = residentBytes();
  EXPECT_GT(before, kAll);
  freed.giveBack();
  EXPECT_LT(residentBytes(), before - kAll / 2);
}

}  // namespace
}  // namespace deltalux
