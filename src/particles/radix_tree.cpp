#include "particles/radix_tree.hpp"

#include <algorithm>
#include <bit>

#include "base/check.hpp"
#include "base/random.hpp"

namespace deltalux::particles {

namespace {

constexpr int kBits = 128;  // [layout]

int commonPrefix(const Code& a, const Code& b) {
  for (int word = 0; word < 4; ++word)
    if (a[word] != b[word]) return 32 * word + std::countl_zero(a[word] ^ b[word]);
  return kBits;
}

bool bit(const Code& code, int i) { return code[i / 32] >> (31 - i % 32) & 1u; }

std::uint64_t prefixKey(const Code& code, int length, std::uint64_t seed) {
  std::uint64_t key = combineKeys(seed, static_cast<std::uint64_t>(length));
  for (int word = 0; word < 4; ++word) {
    const int left = std::clamp(length - 32 * word, 0, 32);
    const std::uint32_t kept = left == 0 ? 0u : code[word] & ~std::uint32_t(0) << (32 - left);
    key = combineKeys(key, kept);
  }
  return key;
}

struct Builder {
  std::vector<RadixNode>& nodes;
  std::span<const Code> codes;
  std::uint32_t firstLeaf;
  std::uint64_t seed;

  std::uint32_t build(std::size_t begin, std::size_t end) {
    const auto self = static_cast<std::uint32_t>(nodes.size());
    const int length = begin + 1 == end ? kBits : commonPrefix(codes[begin], codes[end - 1]);
    RadixNode node;
    node.begin = firstLeaf + static_cast<std::uint32_t>(begin);
    node.end = firstLeaf + static_cast<std::uint32_t>(end);
    node.key = prefixKey(codes[begin], length, seed);
    nodes.push_back(node);
    if (begin + 1 == end) return self;
    DELTALUX_CHECK(length < kBits, "codes are all different");
    const auto first = codes.begin() + static_cast<std::ptrdiff_t>(begin);
    const auto last = codes.begin() + static_cast<std::ptrdiff_t>(end);
    const auto ones = std::partition_point(first, last, [&](const Code& c) { return !bit(c, length); });
    const auto middle = static_cast<std::size_t>(ones - codes.begin());
    const std::uint32_t zeros = build(begin, middle);
    const std::uint32_t rest = build(middle, end);
    nodes[self].child[0] = zeros;
    nodes[self].child[1] = rest;
    return self;
  }
};

}  // namespace

std::uint32_t appendRadixTree(std::vector<RadixNode>& nodes, std::span<const Code> codes, std::uint32_t firstLeaf,
                              std::uint64_t seed) {
  DELTALUX_CHECK(!codes.empty(), "a tree has leaves");
  return Builder{nodes, codes, firstLeaf, seed}.build(0, codes.size());
}

}  // namespace deltalux::particles
