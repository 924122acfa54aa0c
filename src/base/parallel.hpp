#pragma once
// Parallel loops over oneTBB, and sums whose order of addition does not depend on the thread count.
#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cstddef>
#include <vector>

namespace deltalux {

/// Limits the threads of all parallel loops while it lives; 0 leaves the machine's default.
class ThreadLimit {
 public:
  explicit ThreadLimit(std::size_t threads)
      : control_(tbb::global_control::max_allowed_parallelism, threads > 0 ? threads : defaultThreads()) {}
  static std::size_t defaultThreads();

 private:
  tbb::global_control control_;
};

/// body(begin, end) over fixed blocks of `block` indices of [0, count); the blocks are the same for any thread count.
template <class Body>
void parallelBlocks(std::size_t count, std::size_t block, const Body& body) {
  const std::size_t blocks = (count + block - 1) / block;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, blocks, 1), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t b = range.begin(); b != range.end(); ++b) body(b * block, std::min(count, (b + 1) * block));
  });
}

/// body(i) for i in [0, count).
template <class Body>
void parallelFor(std::size_t count, std::size_t block, const Body& body) {
  parallelBlocks(count, block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i != end; ++i) body(i);
  });
}

/// body(), whose parallel loops take up no work of others meanwhile: for what is made once, while others wait for it.
template <class Body>
void withoutOtherWork(const Body& body) {
  tbb::this_task_arena::isolate(body);
}

/// Sum of term(i) over [0, count), added in index order within blocks and block order across: deterministic.
template <class Sum, class Term>
Sum parallelSum(std::size_t count, std::size_t block, const Term& term) {
  std::vector<Sum> partial((count + block - 1) / block, Sum{});
  parallelBlocks(count, block, [&](std::size_t begin, std::size_t end) {
    Sum sum{};
    for (std::size_t i = begin; i != end; ++i) sum += term(i);
    partial[begin / block] = sum;
  });
  Sum total{};
  for (const Sum& p : partial) total += p;
  return total;
}

}  // namespace deltalux
