#include "lines/exchange.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <tuple>
#include <type_traits>

#include "base/parallel.hpp"
#include "base/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kLeaves = 512, kFewLeaves = 32;  // of a task [task]
constexpr float kLeastEnd = 1e-6f;                     // in place of a chance of 0 [rounding]
constexpr std::uint32_t kMostCount = 0xffff;           // [layout]
constexpr std::size_t kLanes = 8;                      // [task]
constexpr double kFewEntries = 0.3;                    // of all, above which all are as soon done [task]
constexpr std::uint32_t kOwedParts = 4;                // of all slots, which are added to at once [task]
constexpr std::uint32_t kRoom = 8;                     // part of a row that there is room for behind it [task]

template <class T>
T sumOf(const std::array<T, kLanes>& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) + ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// body(entry, lane) of the entries from `begin` to `end`.
template <class Body>
void inLanes(std::uint64_t begin, std::uint64_t end, const Body& body) {
  for (; begin + kLanes <= end; begin += kLanes)
    for (std::size_t lane = 0; lane < kLanes; ++lane) body(begin + lane, lane);
  for (std::size_t lane = 0; begin < end; ++begin, ++lane) body(begin, lane);
}

struct RowEntry {
  std::uint32_t id;
  std::int32_t lines;
};

/// So many lines more, or less, between the leaf of a row and another.
struct RowChange {
  std::uint32_t row, other;
  std::int32_t lines;
};

/// change(leaf, lines) of straight lines by the leaves that they end on, of those that there were too.
template <class Change>
void forEachChange(std::span<const std::uint32_t> before, std::span<const std::uint32_t> now, const Change& change) {
  constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  for (std::size_t k = 0; k < std::max(before.size(), now.size()); ++k) {
    const std::uint32_t a = k < before.size() ? KnownLines::leafOf(before[k]) : kNone,
                        b = k < now.size() && now[k] < kFirstMark ? now[k] : kNone;
    if (a == b) continue;
    if (a != kNone) change(a, -1);
    if (b != kNone) change(b, 1);
  }
}

/// Values by slot, one after the other, in any order; `begin`: of all slots, and one more for the end.
/// forEach(visit): visit(slot, value), from any thread, the same each time.
template <class T, class ForEach>
void listBySlot(std::size_t slots, const ForEach& forEach, std::vector<std::uint32_t>& begin, std::vector<T>& values) {
  std::vector<std::atomic<std::uint32_t>> count(slots);
  forEach([&](std::uint32_t slot, const T&) { count[slot].fetch_add(1, std::memory_order_relaxed); });
  begin.assign(slots + 1, 0);
  for (std::size_t i = 0; i < slots; ++i) begin[i + 1] = begin[i] + count[i].load(std::memory_order_relaxed);
  values.resize(begin.back());
  forEach([&](std::uint32_t slot, const T& value) {
    values[begin[slot] + count[slot].fetch_sub(1, std::memory_order_relaxed) - 1] = value;
  });
}

}  // namespace

Exchange::Exchange(const Lines& lines, const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                   const LineTracer& tracer) {
  setLeaves(lines, elements, leaves, tracer);
  build(lines);
  parallelFor(leaves_.size(), kLeaves, [&](std::size_t i) { weigh(slot_[i]); });
  addSpecials(lines);
  listSeers();
  parallelFor(leaves_.size(), kLeaves,
              [&](std::size_t i) { countOwn(lines, leaves_[i]), setShare(lines, leaves_[i]); });
  std::vector<char> changed(row_.size(), true);
  scale(changed);
}

void Exchange::setLeaves(const Lines& lines, const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                         const LineTracer& tracer) {
  leaves_ = leaves.leaves;
  slotOf_.resize(elements.size(), kNone), slot_.resize(leaves.size());
  std::size_t slots = row_.size();
  for (std::uint32_t i = 0; i < leaves_.size(); ++i) {
    std::uint32_t& slot = slotOf_[leaves_[i].index()];
    if (slot == kNone && !free_.empty()) slot = free_.back(), free_.pop_back();
    if (slot == kNone) slot = static_cast<std::uint32_t>(slots++);
    slot_[i] = slot;
  }
  for (std::vector<float>* values : {&area_, &m_, &e_, &closed_, &target_, &share_}) values->resize(slots);
  own_.resize(slots), row_.resize(slots), records_.resize(slots), numberOf_.assign(slots, kNone);
  parallelFor(leaves_.size(), kLeaves, [&](std::size_t i) {
    const std::uint32_t at = slot_[i];
    const hierarchy::Side side = elements.sideOf(leaves_[i]);
    const auto count = static_cast<float>(lines.at(leaves_[i]).open());
    numberOf_[at] = static_cast<std::uint32_t>(i);
    e_[at] = std::max(tracer.responses().at(side.primitive, side.front).ends, kLeastEnd);
    area_[at] = count > 0 ? elements.shape(leaves_[i]).litArea() : 0.0f;
    m_[at] = area_[at] > 0 ? count / (area_[at] * e_[at]) : 0.0f;
  });
}

void Exchange::follow(const KnownLines& known, const Lines& lines, const hierarchy::Elements& elements,
                      const hierarchy::LeafTable& leaves, const LineTracer& tracer) {
  const std::vector<float> before = m_;
  setLeaves(lines, elements, leaves, tracer);
  std::vector<char> changed(row_.size(), false);
  for (std::size_t i = 0; i < leaves_.size(); ++i) changed[slot_[i]] = !known.stands[leaves_[i].index()];
  for (std::size_t i = 0; i < shortened_.size(); ++i) changed[i] |= shortened_[i];
  shortened_.clear();
  change(known, lines, changed);
  freeSlots(changed);
  tidy();
  // What two leaves exchange follows from the lines and the numbers of both.
  std::vector<std::uint32_t> others, recounted;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    const std::uint32_t at = slot_[i];
    const bool same = at < before.size() && before[at] == m_[at];
    if (!same) recounted.push_back(at);
    if (!same || !known.same(leaves_[i], lines)) others.push_back(at), changed[at] = true;
  }
  for (const std::uint32_t i : recounted)
    for (std::uint64_t k = row_[i].first; k < row_[i].end(); ++k) changed[id_[k]] = true;
  for (const std::uint32_t i : others) markSpecials(i, changed);
  addSpecials(lines);
  for (const std::uint32_t i : others) markSpecials(i, changed);
  listSeers();
  parallelFor(leaves_.size(), kLeaves, [&](std::size_t i) {
    if (!known.same(leaves_[i], lines)) countOwn(lines, leaves_[i]);
    if (!changed[slot_[i]]) return;
    weigh(slot_[i]);
    setShare(lines, leaves_[i]);
  });
  scale(changed);
}

void Exchange::renumber(std::span<const std::uint32_t> now, std::size_t elements) {
  std::vector<std::uint32_t> slotOf(elements, kNone);
  std::vector<char> gone(row_.size(), false);
  shortened_.resize(row_.size(), false);
  for (std::size_t old = 0; old < slotOf_.size(); ++old) {
    if (slotOf_[old] == kNone) continue;
    if (now[old] != kNone)
      slotOf[now[old]] = slotOf_[old];
    else
      gone[slotOf_[old]] = true, freeSlot(slotOf_[old], shortened_);
  }
  slotOf_ = std::move(slotOf);
  parallelFor(row_.size(), kLeaves, [&](std::size_t i) {
    Row& row = row_[i];
    std::uint64_t to = row.first;
    for (std::uint64_t k = row.first; k < row.end(); ++k)
      if (!gone[id_[k]]) id_[to] = id_[k], count_[to] = count_[k], weight_[to] = weight_[k], ++to;
    shortened_[i] = shortened_[i] || to != row.end();
    row.count = static_cast<std::uint32_t>(to - row.first);
  });
}

void Exchange::build(const Lines& lines) {
  const std::size_t n = row_.size();
  std::vector<std::atomic<std::uint32_t>> degree(n);
  /// visit(row, other) of both ends of all straight lines.
  const auto forEachEnd = [&](const auto& visit) {
    parallelFor(leaves_.size(), kLeaves, [&](std::size_t i) {
      for (const std::uint32_t end : lines.endsOf(leaves_[i])) {
        if (end >= kFirstMark) continue;
        visit(slot_[i], slotOf_[end]);
        if (!onlyReceives(slot_[i])) visit(slotOf_[end], slot_[i]);
      }
    });
  };
  forEachEnd([&](std::uint32_t i, std::uint32_t) { degree[i].fetch_add(1, std::memory_order_relaxed); });
  std::vector<std::uint64_t> first(n + 1, 0);
  for (std::size_t i = 0; i < n; ++i) first[i + 1] = first[i] + degree[i].load(std::memory_order_relaxed);
  LargeArray<std::uint32_t> ends;
  ends.resize(first[n]);
  forEachEnd([&](std::uint32_t i, std::uint32_t j) {
    ends[first[i] + degree[i].fetch_sub(1, std::memory_order_relaxed) - 1] = j;
  });
  // In the order of slots, whichever thread came first; lines of one pair become one entry.
  const auto forEachEntry = [&](std::size_t i, const auto& visit) {
    for (std::uint64_t k = first[i]; k < first[i + 1];) {
      std::uint64_t last = k + 1;
      while (last < first[i + 1] && ends[last] == ends[k] && last - k < kMostCount) ++last;
      visit(ends[k], static_cast<std::uint16_t>(last - k));
      k = last;
    }
  };
  parallelFor(n, kLeaves, [&](std::size_t i) {
    std::sort(ends.begin() + static_cast<std::ptrdiff_t>(first[i]),
              ends.begin() + static_cast<std::ptrdiff_t>(first[i + 1]));
    forEachEntry(i, [&](std::uint32_t, std::uint16_t) { ++row_[i].count; });
  });
  std::uint64_t next = 0;
  for (Row& row : row_) row.first = next, row.room = row.count + row.count / kRoom, next += row.room;
  id_.resize(next), count_.resize(next), weight_.resize(next);
  parallelFor(n, kLeaves, [&](std::size_t i) {
    std::uint64_t at = row_[i].first;
    forEachEntry(i, [&](std::uint32_t j, std::uint16_t count) { id_[at] = j, count_[at++] = count; });
  });
}

void Exchange::change(const KnownLines& known, const Lines& lines, std::vector<char>& changed) {
  const std::size_t elements = slotOf_.size(), n = row_.size();
  // Ends of straight lines that are others.
  std::vector<std::vector<RowChange>> found((elements + kLeaves - 1) / kLeaves);
  parallelBlocks(elements, kLeaves, [&](std::size_t begin, std::size_t end) {
    std::vector<RowChange>& to = found[begin / kLeaves];
    for (std::size_t i = begin; i < end; ++i) {
      const hierarchy::ElementId leaf(i);
      if (known.before[i].count + lines.countOf(leaf) == 0 || known.same(leaf, lines)) continue;
      const std::uint32_t own = slotOf_[i];
      forEachChange(lines.endsOf(known.before[i]), lines.endsOf(leaf), [&](std::uint32_t on, std::int32_t more) {
        const std::uint32_t other = slotOf_[on];
        to.push_back({own, other, more});
        if (!onlyReceives(own)) to.push_back({other, own, more});
      });
    }
  });
  std::vector<std::uint64_t> first(n + 1, 0);
  for (const auto& block : found)
    for (const RowChange& c : block) ++first[c.row + 1];
  for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
  std::vector<RowChange> changes(first[n]);
  std::vector<std::uint64_t> next(first.begin(), first.end() - 1);
  for (const auto& block : found)
    for (const RowChange& c : block) changes[next[c.row]++] = c;

  /// Rows that have outgrown their room, one after the other.
  struct Outgrown {
    std::vector<std::uint32_t> rows, id;
    std::vector<std::uint16_t> count;
  };
  const std::size_t blocks = (n + kLeaves - 1) / kLeaves;
  std::vector<Outgrown> outgrown(blocks);
  parallelBlocks(n, kLeaves, [&](std::size_t begin, std::size_t end) {
    std::vector<RowEntry> merged;
    for (std::size_t i = begin; i < end; ++i) {
      if (first[i] == first[i + 1] || numberOf_[i] == kNone) continue;
      changed[i] = true;
      Row& row = row_[i];
      const auto own = std::span(changes).subspan(first[i], first[i + 1] - first[i]);
      std::ranges::sort(own, {}, &RowChange::other);
      merged.clear();
      std::uint64_t k = row.first;
      std::size_t c = 0;
      while (k < row.end() || c < own.size()) {
        const std::uint32_t j = std::min(k < row.end() ? id_[k] : kNone, c < own.size() ? own[c].other : kNone);
        std::int64_t left = 0;
        for (; k < row.end() && id_[k] == j; ++k) left += count_[k];
        for (; c < own.size() && own[c].other == j; ++c) left += own[c].lines;
        for (; left > 0; left -= kMostCount)
          merged.push_back({j, static_cast<std::int32_t>(std::min<std::int64_t>(left, kMostCount))});
      }
      row.count = static_cast<std::uint32_t>(merged.size());
      if (row.count <= row.room) {
        for (std::size_t m = 0; m < merged.size(); ++m)
          id_[row.first + m] = merged[m].id, count_[row.first + m] = static_cast<std::uint16_t>(merged[m].lines);
        continue;
      }
      Outgrown& to = outgrown[begin / kLeaves];
      to.rows.push_back(static_cast<std::uint32_t>(i));
      for (const RowEntry& m : merged) to.id.push_back(m.id), to.count.push_back(static_cast<std::uint16_t>(m.lines));
    }
  });
  std::uint64_t end = id_.size();
  for (const Outgrown& block : outgrown)
    for (const std::uint32_t i : block.rows) {
      row_[i].first = end, row_[i].room = row_[i].count + row_[i].count / kRoom;
      end += row_[i].room;
    }
  id_.resize(end), count_.resize(end), weight_.resize(end);
  parallelFor(blocks, 1, [&](std::size_t b) {
    std::size_t from = 0;
    for (const std::uint32_t i : outgrown[b].rows) {
      const Row& row = row_[i];
      std::copy_n(outgrown[b].id.data() + from, row.count, id_.data() + row.first);
      std::copy_n(outgrown[b].count.data() + from, row.count, count_.data() + row.first);
      from += row.count;
    }
  });
}

void Exchange::freeSlots(std::vector<char>& changed) {
  for (std::uint32_t& slot : slotOf_) {
    if (slot == kNone || numberOf_[slot] != kNone) continue;
    freeSlot(slot, changed);
    slot = kNone;
  }
}

void Exchange::freeSlot(std::uint32_t slot, std::vector<char>& changed) {
  markSpecials(slot, changed);
  row_[slot] = {}, m_[slot] = -1;  // no leaf's
  free_.push_back(slot);
}

void Exchange::markSpecials(std::uint32_t slot, std::vector<char>& marked) const {
  if (slot + 1 >= specialBegin_.size()) return;  // there was none
  for (std::uint32_t k = specialBegin_[slot]; k < specialBegin_[slot + 1]; ++k) marked[specials_[k].other] = true;
}

void Exchange::markOthers(std::uint32_t slot, std::vector<char>& marked) const {
  markSpecials(slot, marked);
  for (const std::uint32_t seer : receiving_.of(slot)) marked[seer] = true;
}

/// Moves rows together where half of what there is is no row's any more.
void Exchange::tidy() {
  std::uint64_t used = 0;
  for (const Row& row : row_) used += row.room;
  if (id_.size() <= 2 * used) return;
  const std::vector<Row> before = row_;
  std::uint64_t next = 0;
  for (Row& row : row_) row.first = next, next += row.room;
  const auto move = [&](auto& values) {
    std::remove_reference_t<decltype(values)> moved;
    moved.resize(next);
    parallelFor(row_.size(), kLeaves, [&](std::size_t i) {
      std::copy_n(values.data() + before[i].first, before[i].count, moved.data() + row_[i].first);
    });
    values = std::move(moved);
  };
  move(id_), move(count_), move(weight_);
}

void Exchange::weigh(std::uint32_t i) {
  for (std::uint64_t k = row_[i].first; k < row_[i].end(); ++k)
    weight_[k] = static_cast<float>(count_[k]) / (m_[i] + m_[id_[k]]);
}

void Exchange::addSpecials(const Lines& lines) {
  const std::size_t n = row_.size();
  /// visit(slot, special) of both ends of all lines.
  const auto forEachSpecial = [&](const auto& visit) {
    parallelFor(leaves_.size(), kLeaves, [&](std::size_t leaf) {
      const std::uint32_t i = slot_[leaf];
      for (const ExceptionalLine& e : lines.exceptions.at(leaves_[leaf])) {
        const std::uint32_t j = slotOf_[e.end];
        if (e.rough) {
          visit(i, Special{j, e.weight / (m_[i] * e_[i] * e_[j]), true});
          continue;
        }
        const Rgb x = e.weight / (e_[i] * e_[j] * (m_[i] + m_[j]));  // [VG95 (balance heuristic)]
        visit(i, Special{j, x, false});
        if (!onlyReceives(i)) visit(j, Special{i, x, false});
      }
    });
  };
  listBySlot(n, forEachSpecial, specialBegin_, specials_);
  // In one order, whichever thread came first.
  const auto keyOf = [](const Special& s) { return std::tuple(s.rough, s.other, s.x.r, s.x.g, s.x.b); };
  parallelFor(n, kLeaves, [&](std::size_t i) {
    std::ranges::sort(std::span(specials_).subspan(specialBegin_[i], specialBegin_[i + 1] - specialBegin_[i]), {},
                      keyOf);
  });
}

void Exchange::listSeers() {
  /// visit(slot, special) of all leaves.
  const auto forEachSpecial = [&](const auto& visit) {
    parallelFor(leaves_.size(), kLeaves, [&](std::size_t n) {
      const std::uint32_t i = slot_[n];
      for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) visit(i, specials_[k]);
    });
  };
  const auto list = [&](Seers& of, const auto& forEach) { listBySlot(row_.size(), forEach, of.begin, of.seers); };
  list(roughly_, [&](const auto& visit) {
    forEachSpecial([&](std::uint32_t i, const Special& s) {
      if (s.rough) visit(s.other, i);
    });
  });
  list(receiving_, [&](const auto& visit) {
    forEachSpecial([&](std::uint32_t i, const Special& s) {
      if (!s.rough && onlyReceives(i)) visit(s.other, i);
    });
    parallelFor(leaves_.size(), kLeaves, [&](std::size_t n) {
      const std::uint32_t i = slot_[n];
      if (!onlyReceives(i)) return;
      for (std::uint64_t k = row_[i].first; k < row_[i].end(); ++k) visit(id_[k], i);
    });
  });
}

template <class Visit>
void Exchange::forEachExchange(std::uint32_t i, const Visit& visit) const {
  const float own = 1 / e_[i];
  for (std::uint64_t k = row_[i].first; k < row_[i].end(); ++k) {
    const std::uint32_t j = id_[k];
    visit(j, weight_[k] * own / e_[j]);
  }
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
    if (!specials_[k].rough) visit(specials_[k].other, gray(specials_[k].x));
}

float Exchange::exchangeWith(std::uint32_t i, std::span<const float> valueOverE) const {
  std::array<float, kLanes> sum{};
  const float *q = valueOverE.data(), *weight = weight_.data();
  const std::uint32_t* id = id_.data();
  inLanes(row_[i].first, row_[i].end(), [&](std::uint64_t k, std::size_t lane) { sum[lane] += weight[k] * q[id[k]]; });
  float all = sumOf(sum) / e_[i];
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
    if (!specials_[k].rough) all += q[specials_[k].other] * e_[specials_[k].other] * gray(specials_[k].x);
  return all;
}

void Exchange::countOwn(const Lines& lines, hierarchy::ElementId leaf) {
  // What lines meet first counts whole, whether they end there or go on: that is 1 / e_ of those that end, on average,
  // without its noise.
  OwnLines& own = own_[slotOf_[leaf.index()]];
  own = {};
  for (const std::uint32_t end : lines.endsOf(leaf)) {
    if (end < kFirstMark) own.met += 1, own.ended += 1 / e_[slotOf_[end]];
    if (end == kLostBeyond) own.met += 1;
  }
}

/// What the symmetric part of a row shall sum to: the share of the leaf's own lines, where few of them escape; what
/// lines of both ends say where many do.
void Exchange::setShare(const Lines& lines, hierarchy::ElementId leaf) {
  const std::uint32_t i = slotOf_[leaf.index()];
  closed_[i] = share_[i] = 0;
  const auto count = static_cast<float>(lines.at(leaf).open());
  if (!(count > 0) || !(area_[i] > 0)) return;
  float rough = 0, other = 0, beyond = 0;
  for (const ExceptionalLine& line : lines.exceptions.at(leaf)) {
    (line.rough ? rough : other) += gray(line.weight) / e_[slotOf_[line.end]];
    if (line.beyond) beyond += 1;
  }
  float g = 0;
  forEachExchange(i, [&](std::uint32_t, float x) { g += x; });
  // Where hardly any of what is met ends, what others see beyond must not stand for it.
  const float met = beyond + own_[i].met, f = (std::min(met, tuning::kMostScale * own_[i].ended) + other) / count;
  const float sure = std::min(f, 1.0f);
  share_[i] = std::min(sure * f + (1 - sure) * g / area_[i], std::max(f, 1.0f));
  closed_[i] = share_[i] + rough / count;
}

bool Exchange::owe(std::span<const Other> others, std::vector<float>& owed, std::vector<char>& marked) const {
  std::uint64_t entries = 0;
  for (const Other& o : others) entries += row_[o.slot].count;
  if (static_cast<double>(entries) > kFewEntries * static_cast<double>(id_.size())) return true;
  // Who sees them is seen by them. Entries are in the order of slots.
  parallelFor(kOwedParts, 1, [&](std::size_t part) {
    const std::size_t n = row_.size(), begin = part * n / kOwedParts, end = (part + 1) * n / kOwedParts;
    for (const auto& [i, by] : others) {
      const auto first = id_.begin() + static_cast<std::ptrdiff_t>(row_[i].first), last = first + row_[i].count;
      for (auto id = std::lower_bound(first, last, begin); id != last && *id < end; ++id)
        owed[*id] += weight_[static_cast<std::size_t>(id - id_.begin())] * by;
    }
  });
  for (const auto& [i, by] : others) {
    marked[i] = true;
    markOthers(i, marked);
  }
  return false;
}

/// [SK67], symmetric: each factor takes half of what its row is off by.
void Exchange::scale(std::vector<char>& changed) {
  const std::size_t blocks = (slot_.size() + kLeaves - 1) / kLeaves;
  for (std::vector<float>& factors : passes_) factors.resize(row_.size());
  for (std::vector<float>& owed : owedFactor_) owed.resize(row_.size(), 0);
  bound_.resize(row_.size(), Rgb(1.0f));
  std::vector<Other> others;  // whose factor of the last pass is another
  std::vector<char> marked;
  std::size_t pass = 0;
  /// next(slot) of those rows which may be others: their factors, to `factors`.
  const auto setFactors = [&](std::vector<float>& factors, const auto& next) {
    std::vector<float>& owed = owedFactor_[pass];
    marked = changed;
    const bool all = owe(others, owed, marked);
    const std::vector<float>& q = passes_[pass > 0 ? pass - 1 : 0];
    std::vector<std::vector<Other>> found(blocks);
    parallelBlocks(slot_.size(), kLeaves, [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        const std::uint32_t i = slot_[k];
        if (!all && !marked[i] && !(owed[i] * q[i] > kFollowed * share_[i] * area_[i])) continue;
        owed[i] = 0;
        const float now = next(i), before = factors[i];
        if (std::abs(now - before) <= kFollowed * before) continue;
        factors[i] = now, found[begin / kLeaves].push_back({i, std::abs(now - before)});
      }
    });
    others.clear(), ++pass;
    for (const auto& block : found) others.insert(others.end(), block.begin(), block.end());
  };
  setFactors(passes_[0], [&](std::uint32_t i) { return 1 / e_[i]; });
  while (pass < passes_.size()) {
    const std::vector<float>& q = passes_[pass - 1];
    setFactors(passes_[pass], [&](std::uint32_t i) {
      const float own = q[i] * e_[i], sum = own * exchangeWith(i, q);
      if (!(sum > 0) || !(area_[i] > 0)) return q[i];
      return std::clamp(own * std::sqrt(share_[i] * area_[i] / sum), 1 / tuning::kMostScale, tuning::kMostScale) /
             e_[i];
    });
  }
  const std::vector<float>& q = passes_.back();
  for (const auto& [i, by] : others) changed[i] = true;
  // What scaling has not reached must not make rows exceed one.
  setFactors(target_, [&](std::uint32_t i) {
    const float sum = scaleOf(i) * exchangeWith(i, q);
    return sum > share_[i] * area_[i] ? share_[i] * area_[i] / sum : 1.0f;
  });
  for (const auto& [i, by] : others) changed[i] = true;
}

LeafRecord Exchange::sentBy(std::uint32_t i, const Rgb& B) const {
  const Rgb sent = B * passes_.back()[i];
  return {{sent.r, sent.g, sent.b, 0}};
}

/// Sum over a row's straight lines of what the records send by them.
Rgb Exchange::sentOver(std::uint32_t i) const {
  const LeafRecord* records = records_.data();
  const std::uint32_t* id = id_.data();
  const float* weight = weight_.data();
  std::array<LeafRecord, 4> sums{};
  inLanes(row_[i].first, row_[i].end(), [&](std::uint64_t k, std::size_t lane) {
    for (std::size_t c = 0; c < 4; ++c) sums[lane % 4].B[c] += weight[k] * records[id[k]].B[c];
  });
  const auto sum = [&](std::size_t c) { return (sums[0].B[c] + sums[1].B[c]) + (sums[2].B[c] + sums[3].B[c]); };
  return {sum(0), sum(1), sum(2)};
}

Rgb Exchange::irradianceOf(std::uint32_t i, std::span<const Rgb> B) const {
  if (!(area_[i] > 0)) return Rgb(0.0f);
  Rgb sum = sentOver(i) / e_[i];
  Rgb oneWay(0.0f);
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) {
    const Special& s = specials_[k];
    if (s.rough)
      oneWay += s.x * B[numberOf_[s.other]];
    else
      sum += s.x * scaleOf(s.other) * B[numberOf_[s.other]];
  }
  return bound_[i] * (target_[i] * scaleOf(i) * sum + oneWay) / area_[i];
}

void Exchange::bound(std::span<const Rgb> returned) {
  constexpr auto most = static_cast<float>(deltalux::tuning::kMostSurvival);
  parallelFor(leaves(), kLeaves, [&](std::size_t n) {
    const std::uint32_t i = slot_[n];
    bound_[i] = Rgb(1.0f);
    if (!(area_[i] > 0)) return;
    // All gray exchange is no more than the leaf's share; that over mirrors has colours.
    Rgb sum(share_[i]);
    for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) {
      const Special& s = specials_[k];
      sum += s.rough ? s.x / area_[i] : (s.x - gray(s.x)) * (target_[i] * scaleOf(i) * scaleOf(s.other) / area_[i]);
    }
    for (int c = 0; c < 3; ++c)
      if (sum[c] > 1 && sum[c] * returned[n][c] > most) bound_[i][c] = std::max(1.0f, most / returned[n][c]) / sum[c];
  });
}

void Exchange::send(std::span<const Rgb> B) {
  parallelFor(leaves(), kLeaves, [&](std::size_t i) { records_[slot_[i]] = sentBy(slot_[i], B[i]); });
}

void Exchange::gather(std::span<const Rgb> B, std::span<Rgb> E) {
  send(B);
  parallelFor(leaves(), kLeaves, [&](std::size_t i) { E[i] = irradianceOf(slot_[i], B); });
}

void Exchange::gatherAmong(std::span<const std::uint32_t> some, std::span<const Rgb> B, std::span<Rgb> E) {
  for (const std::uint32_t i : some) records_[slot_[i]] = sentBy(slot_[i], B[i]);
  parallelFor(some.size(), kFewLeaves, [&](std::size_t k) { E[some[k]] = irradianceOf(slot_[some[k]], B); });
}

void Exchange::gatherAbout(std::span<const std::uint32_t> some, std::span<const Rgb> B, std::span<Rgb> E) {
  std::vector<char> marked(row_.size(), false);
  for (const std::uint32_t n : some) {
    const std::uint32_t i = slot_[n];
    records_[i] = sentBy(i, B[n]);
    for (std::uint64_t k = row_[i].first; k < row_[i].end(); ++k) marked[id_[k]] = true;
    markOthers(i, marked);
    for (const std::uint32_t seer : roughly_.of(i)) marked[seer] = true;
  }
  parallelFor(leaves(), kLeaves, [&](std::size_t n) {
    if (marked[slot_[n]]) E[n] = irradianceOf(slot_[n], B);
  });
}

void Exchange::deviation(std::span<const Rgb> B, std::span<float> sigma) {
  std::vector<float> sent(row_.size());
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    const std::uint32_t e = slot_[i];
    sent[e] = passes_.back()[e] * gray(B[i]);
  });
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    const std::uint32_t e = slot_[i];
    std::array<double, kLanes> sums{}, squared{}, counts{};
    const float scale = scaleOf(e), own = target_[e] * scale / e_[e];
    inLanes(row_[e].first, row_[e].end(), [&](std::uint64_t k, std::size_t lane) {
      const auto count = static_cast<float>(count_[k]);
      const double each = own * sent[id_[k]] * weight_[k] / count;
      sums[lane] += count * each, squared[lane] += count * each * each, counts[lane] += count;
    });
    double sum = sumOf(sums), squares = sumOf(squared), lines = sumOf(counts);
    const auto add = [&](double count, double each) {
      sum += count * each, squares += count * each * each, lines += count;
    };
    for (std::uint32_t k = specialBegin_[e]; k < specialBegin_[e + 1]; ++k) {
      const Special& s = specials_[k];
      add(1, gray(s.x * B[numberOf_[s.other]]) * (s.rough ? 1.0f : target_[e] * scale * scaleOf(s.other)));
    }
    const double variance = lines > 1 ? std::max(0.0, squares - sum * sum / lines) * lines / (lines - 1) : sum * sum;
    sigma[i] = area_[e] > 0 ? static_cast<float>(std::sqrt(variance)) / area_[e] : 0.0f;
  });
}

void Exchange::arriving(std::span<double> share) const {
  // Symmetric: what i gets from j by radiosity, j gets from i; the factor of the receiver comes on top.
  parallelFor(leaves(), kLeaves, [&](std::size_t n) {
    const std::uint32_t j = slot_[n];
    double sum = 0;
    forEachExchange(j, [&](std::uint32_t i, float x) { sum += double(target_[i]) * scaleOf(i) * x; });
    share[n] = area_[j] > 0 ? sum * scaleOf(j) / area_[j] : 0;
  });
  for (const std::uint32_t i : slot_)
    for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
      if (specials_[k].rough && area_[specials_[k].other] > 0)
        share[numberOf_[specials_[k].other]] += gray(specials_[k].x) / area_[specials_[k].other];
}

std::size_t Exchange::memoryBytes() const {
  return row_.size() * (7 * sizeof(float) + sizeof(Rgb) + sizeof(LeafRecord) + sizeof(Row) + sizeof(OwnLines)) +
         id_.capacity() * 4 + count_.capacity() * 2 + weight_.capacity() * 4 + specialBegin_.capacity() * 4 +
         specials_.capacity() * sizeof(Special);
}

}  // namespace deltalux::lines
