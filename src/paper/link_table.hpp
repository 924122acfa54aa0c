#pragma once
// The links that cross a cell of the octree: a hash table "indexed by receiver element r on which the link is stored,
// and the link l" [GD01 4.1]. Entries are links alone; a link's receiver stands in its ends, and names the bucket with
// it. Open addressing with linear probing; what is taken out leaves no mark.
// Memory: 4 bytes a slot, of which between three eighths and three quarters are taken.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/random.hpp"
#include "particles/particles.hpp"

namespace deltalux::paper {

class LinkTable {
 public:
  using AllLinks = std::vector<particles::ParticleLink>;

  /// A link that is there already stays so.
  void insert(std::uint32_t link, const AllLinks& all) {
    if (4 * (size_ + 1) > 3 * slots_.size()) grow(all);
    std::size_t at = slotOf(link, all);
    while (slots_[at] != kNone) {
      if (slots_[at] == link) return;
      at = next(at);
    }
    slots_[at] = link, ++size_;
  }

  void erase(std::uint32_t link, const AllLinks& all) {
    if (size_ == 0) return;
    std::size_t at = slotOf(link, all);
    while (slots_[at] != link) {
      if (slots_[at] == kNone) return;
      at = next(at);
    }
    // What stands behind moves up, unless it stands before the place that it asks for.
    for (std::size_t from = next(at); slots_[from] != kNone; from = next(from)) {
      const std::size_t wanted = slotOf(slots_[from], all);
      if (((from - wanted) & mask()) < ((from - at) & mask())) continue;
      slots_[at] = slots_[from], at = from;
    }
    slots_[at] = kNone, --size_;
  }

  /// visit(link), in no order.
  template <class Visit>
  void forEach(const Visit& visit) const {
    for (const std::uint32_t link : slots_)
      if (link != kNone) visit(link);
  }

  std::size_t size() const { return size_; }
  void clear() { slots_ = {}, size_ = 0; }
  std::size_t memoryBytes() const { return slots_.capacity() * sizeof slots_[0]; }

 private:
  static constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]

  std::size_t mask() const { return slots_.size() - 1; }
  std::size_t next(std::size_t slot) const { return (slot + 1) & mask(); }
  std::size_t slotOf(std::uint32_t link, const AllLinks& all) const {
    return mix64(std::uint64_t(all[link].ends.receiver) << 32 | link) & mask();
  }
  void grow(const AllLinks& all) {
    constexpr std::size_t kFewest = 8;  // slots [task]
    std::vector<std::uint32_t> before(std::max(kFewest, 2 * slots_.size()), kNone);
    before.swap(slots_), size_ = 0;
    for (const std::uint32_t link : before)
      if (link != kNone) insert(link, all);
  }

  std::vector<std::uint32_t> slots_;  // a power of two of them
  std::uint32_t size_ = 0;
};

}  // namespace deltalux::paper
