#include "lines/exchange.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kLeaves = 512, kFewLeaves = 32;  // of a task [task]
constexpr float kLeastEnd = 1e-6f;                     // in place of a chance of 0 [rounding]
constexpr std::uint32_t kMostCount = 0xffff;           // [layout]
constexpr std::size_t kLanes = 8;                      // [task]
constexpr std::size_t kFewRows = 4;                    // share of all, above which all are as soon done [task]

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

/// change(leaf, lines) of the straight lines of leaf i by the leaves that they end on, of those that there were too.
template <class Change>
void forEachChange(const KnownLines& known, const Lines& lines, std::uint32_t i, const Change& change) {
  constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  const std::uint32_t old = known.of[i], count = lines.countOf(i),
                      countBefore = old == kNone ? 0 : known.lines.countOf(old);
  const std::uint32_t* now = lines.end.data() + lines.first[i];
  const std::uint32_t* before = old == kNone ? nullptr : known.lines.end.data() + known.lines.first[old];
  for (std::uint32_t k = 0; k < std::max(count, countBefore); ++k) {
    const std::uint32_t a = k < countBefore ? KnownLines::leafOf(before[k]) : kNone,
                        b = k < count && now[k] < kFirstMark ? now[k] : kNone;
    if (a == b) continue;
    if (a != kNone) change(a, -1);
    if (b != kNone) change(b, 1);
  }
}

}  // namespace

/// Without rows.
Exchange::Exchange(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves, const LineTracer& tracer,
                   const Lines& lines, std::span<const std::uint32_t> covered) {
  const std::size_t n = leaves.size();
  area_.resize(n), m_.resize(n), e_.resize(n), closed_.resize(n), target_.resize(n), records_.resize(n);
  scale_.assign(n, 1.0f);
  parallelFor(n, kLeaves, [&](std::size_t i) {
    const hierarchy::ElementGeometry& g = elements.shape(leaves[i]);
    const hierarchy::Side side = elements.sideOf(leaves[i]);
    const auto count = static_cast<float>(lines.countOf(i) - covered[i]);
    e_[i] = std::max(tracer.responses().at(side.primitive, side.front).ends, kLeastEnd);
    area_[i] = count > 0 ? g.litArea() : 0.0f;
    m_[i] = area_[i] > 0 ? count / (area_[i] * e_[i]) : 0.0f;
  });
}

Exchange::Exchange(const Lines& lines, const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves,
                   const LineTracer& tracer, std::span<const std::uint32_t> covered)
    : Exchange(elements, leaves, tracer, lines, covered) {
  build(lines);
  weigh();
  addSpecials(lines);
  listOneWay();
  setTargets(lines, covered);
  scale();
}

Exchange::Exchange(const Exchange& before, const KnownLines& known, const Lines& lines,
                   const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves, const LineTracer& tracer,
                   std::span<const std::uint32_t> covered)
    : Exchange(elements, leaves, tracer, lines, covered) {
  build(before, known, lines);
  weigh();
  addSpecials(lines);
  listOneWay();
  setTargets(lines, covered);
  scale();
}

void Exchange::build(const Lines& lines) {
  const std::size_t n = lines.leaves();
  std::vector<std::atomic<std::uint32_t>> degree(n);
  /// visit(row, other) of both ends of all straight lines.
  const auto forEachEnd = [&](const auto& visit) {
    parallelFor(n, kLeaves, [&](std::size_t i) {
      for (std::uint64_t k = lines.first[i]; k < lines.first[i + 1]; ++k) {
        if (lines.end[k] >= kFirstMark) continue;
        visit(static_cast<std::uint32_t>(i), lines.end[k]);
        if (!onlyReceives(i)) visit(lines.end[k], static_cast<std::uint32_t>(i));
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
  // In the order of ids, whichever thread came first; lines of one pair become one entry.
  std::vector<std::uint32_t> distinct(n, 0);
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
    forEachEntry(i, [&](std::uint32_t, std::uint16_t) { ++distinct[i]; });
  });
  begin_.resize(n + 1);
  begin_[0] = 0;
  for (std::size_t i = 0; i < n; ++i) begin_[i + 1] = begin_[i] + distinct[i];
  id_.resize(begin_[n]), count_.resize(begin_[n]);
  parallelFor(n, kLeaves, [&](std::size_t i) {
    std::uint64_t at = begin_[i];
    forEachEntry(i, [&](std::uint32_t j, std::uint16_t count) { id_[at] = j, count_[at++] = count; });
  });
}

void Exchange::build(const Exchange& before, const KnownLines& known, const Lines& lines) {
  const std::size_t n = lines.leaves(), blocks = (n + kLeaves - 1) / kLeaves;
  // Ends of straight lines that are others.
  std::vector<std::vector<RowChange>> found(blocks);
  parallelBlocks(n, kLeaves, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      forEachChange(known, lines, static_cast<std::uint32_t>(i), [&](std::uint32_t j, std::int32_t more) {
        found[begin / kLeaves].push_back({static_cast<std::uint32_t>(i), j, more});
        if (!onlyReceives(i)) found[begin / kLeaves].push_back({j, static_cast<std::uint32_t>(i), more});
      });
  });
  std::vector<std::uint64_t> first(n + 1, 0);
  for (const auto& block : found)
    for (const RowChange& c : block) ++first[c.row + 1];
  for (std::size_t i = 0; i < n; ++i) first[i + 1] += first[i];
  std::vector<RowChange> changes(first[n]);
  std::vector<std::uint64_t> next(first.begin(), first.end() - 1);
  for (const auto& block : found)
    for (const RowChange& c : block) changes[next[c.row]++] = c;

  struct Rows {
    std::vector<std::uint32_t> id, size;
    std::vector<std::uint16_t> count;
  };
  std::vector<Rows> rows(blocks);
  parallelBlocks(n, kLeaves, [&](std::size_t begin, std::size_t end) {
    Rows& to = rows[begin / kLeaves];
    std::vector<RowEntry> row;
    for (std::size_t i = begin; i < end; ++i) {
      row.clear();
      bool ordered = first[i] == first[i + 1];
      if (const std::uint32_t old = known.of[i]; old != hierarchy::LeafTable::kNone) {
        for (std::uint64_t k = before.begin_[old]; k < before.begin_[old + 1]; ++k) {
          const std::uint32_t j = known.now[before.id_[k]];
          if (j == hierarchy::LeafTable::kNone) continue;
          ordered = ordered && (row.empty() || row.back().id <= j);
          row.push_back({j, before.count_[k]});
        }
      }
      for (std::uint64_t k = first[i]; k < first[i + 1]; ++k) row.push_back({changes[k].other, changes[k].lines});
      if (!ordered) std::ranges::stable_sort(row, {}, &RowEntry::id);
      const std::size_t entries = to.id.size();
      for (std::size_t k = 0; k < row.size();) {
        std::int64_t left = 0;
        const std::uint32_t j = row[k].id;
        for (; k < row.size() && row[k].id == j; ++k) left += row[k].lines;
        for (; left > 0; left -= kMostCount) {
          to.id.push_back(j);
          to.count.push_back(static_cast<std::uint16_t>(std::min<std::int64_t>(left, kMostCount)));
        }
      }
      to.size.push_back(static_cast<std::uint32_t>(to.id.size() - entries));
    }
  });
  begin_.resize(n + 1);
  begin_[0] = 0;
  for (std::size_t i = 0; i < n; ++i) begin_[i + 1] = begin_[i] + rows[i / kLeaves].size[i % kLeaves];
  id_.resize(begin_[n]), count_.resize(begin_[n]);
  parallelFor(blocks, 1, [&](std::size_t b) {
    std::ranges::copy(rows[b].id, id_.data() + begin_[b * kLeaves]);
    std::ranges::copy(rows[b].count, count_.data() + begin_[b * kLeaves]);
  });
}

void Exchange::weigh() {
  weight_.resize(begin_[leaves()]);
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    for (std::uint64_t k = begin_[i]; k < begin_[i + 1]; ++k)
      weight_[k] = static_cast<float>(count_[k]) / (m_[i] + m_[id_[k]]);
  });
}

void Exchange::addSpecials(const Lines& lines) {
  const std::size_t n = lines.leaves();
  specialBegin_.assign(n + 1, 0);
  for (const ExceptionalLine& e : lines.exceptions) {
    ++specialBegin_[e.leaf + 1];
    if (!e.rough && !onlyReceives(e.leaf)) ++specialBegin_[e.end + 1];
  }
  for (std::size_t i = 0; i < n; ++i) specialBegin_[i + 1] += specialBegin_[i];
  specials_.resize(specialBegin_[n]);
  std::vector<std::uint32_t> next(specialBegin_.begin(), specialBegin_.end() - 1);
  for (const ExceptionalLine& e : lines.exceptions) {
    const std::uint32_t i = e.leaf, j = e.end;
    if (e.rough) {
      specials_[next[i]++] = {j, e.weight / (m_[i] * e_[i] * e_[j]), true};
      continue;
    }
    const Rgb x = e.weight / (e_[i] * e_[j] * (m_[i] + m_[j]));  // [VG95 (balance heuristic)]
    specials_[next[i]++] = {j, x, false};
    if (!onlyReceives(i)) specials_[next[j]++] = {i, x, false};
  }
}

void Exchange::listOneWay() {
  const auto rough = [](const Special& s) { return s.rough; };
  for (std::uint32_t i = 0; i < leaves(); ++i)
    if (onlyReceives(i) ||
        std::any_of(specials_.begin() + specialBegin_[i], specials_.begin() + specialBegin_[i + 1], rough))
      oneWay_.push_back(i);
}

template <class Visit>
void Exchange::forEachExchange(std::size_t i, const Visit& visit) const {
  const float own = 1 / e_[i];
  for (std::uint64_t k = begin_[i]; k < begin_[i + 1]; ++k) {
    const std::uint32_t j = id_[k];
    visit(j, weight_[k] * own / e_[j]);
  }
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
    if (!specials_[k].rough) visit(specials_[k].other, gray(specials_[k].x));
}

float Exchange::exchangeWith(std::size_t i, std::span<const float> value, std::span<const float> valueOverE) const {
  std::array<float, kLanes> sum{};
  const float *q = valueOverE.data(), *weight = weight_.data();
  const std::uint32_t* id = id_.data();
  inLanes(begin_[i], begin_[i + 1], [&](std::uint64_t k, std::size_t lane) { sum[lane] += weight[k] * q[id[k]]; });
  float all = sumOf(sum) / e_[i];
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
    if (!specials_[k].rough) all += value[specials_[k].other] * gray(specials_[k].x);
  return all;
}

/// What the symmetric part of a row shall sum to: the share of the leaf's own lines, where few of them escape; what
/// lines of both ends say where many do.
void Exchange::setTargets(const Lines& lines, std::span<const std::uint32_t> covered) {
  std::vector<float> rough(lines.leaves(), 0.0f), other(lines.leaves(), 0.0f), beyond(lines.leaves(), 0.0f);
  std::vector<float> one(lines.leaves(), 1.0f), overE(lines.leaves());
  for (std::size_t i = 0; i < overE.size(); ++i) overE[i] = 1 / e_[i];
  for (const ExceptionalLine& e : lines.exceptions) {
    (e.rough ? rough : other)[e.leaf] += gray(e.weight) / e_[e.end];
    if (e.beyond) beyond[e.leaf] += 1;
  }
  parallelFor(lines.leaves(), kLeaves, [&](std::size_t i) {
    const auto count = static_cast<float>(lines.countOf(i) - covered[i]);
    if (!(count > 0) || !(area_[i] > 0)) return;
    // What lines meet first counts whole, whether they end there or go on: that is 1 / e_ of those that end, on
    // average, without its noise. Where hardly any end, what others see beyond must not stand for it.
    float met = beyond[i], ended = 0;
    for (std::uint64_t k = lines.first[i]; k < lines.first[i + 1]; ++k) {
      const std::uint32_t end = lines.end[k];
      if (end < kFirstMark) met += 1, ended += overE[end];
      if (end == kLostBeyond) met += 1;
    }
    const float f = (std::min(met, tuning::kMostMissed * ended) + other[i]) / count;
    const float g = exchangeWith(i, one, overE) / area_[i];
    const float sure = std::min(f, 1.0f);
    target_[i] = std::min(sure * f + (1 - sure) * g, std::max(f, 1.0f));
    closed_[i] = target_[i] + rough[i] / count;
  });
}

/// [SK67], symmetric: each factor takes half of what its row is off by.
void Exchange::scale() {
  std::vector<float> next(leaves()), overE(leaves());
  const auto sumOfRow = [&](std::size_t i) { return scale_[i] * exchangeWith(i, scale_, overE); };
  const auto setOverE = [&] { parallelFor(leaves(), kLeaves, [&](std::size_t i) { overE[i] = scale_[i] / e_[i]; }); };
  for (int pass = 0; pass < tuning::kScalingPasses; ++pass) {
    setOverE();
    parallelFor(leaves(), kLeaves, [&](std::size_t i) {
      next[i] = scale_[i];
      const float sum = sumOfRow(i);
      if (sum > 0 && area_[i] > 0)
        next[i] =
            std::clamp(scale_[i] * std::sqrt(target_[i] * area_[i] / sum), 1 / tuning::kMostScale, tuning::kMostScale);
    });
    scale_.swap(next);
  }
  // What scaling has not reached must not make rows exceed one.
  setOverE();
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    const float sum = sumOfRow(i);
    next[i] = sum > target_[i] * area_[i] ? target_[i] * area_[i] / sum : 1.0f;
  });
  target_.swap(next);
}

void Exchange::fill(std::span<const Rgb> B) {
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    const Rgb sent = B[i] * (scale_[i] / e_[i]);
    records_[i].B = {sent.r, sent.g, sent.b, 0};
  });
}

/// Sum over a row's straight lines of what the records send by them.
Rgb Exchange::sentOver(std::size_t i) const {
  const LeafRecord* records = records_.data();
  const std::uint32_t* id = id_.data();
  const float* weight = weight_.data();
  std::array<LeafRecord, 4> sums{};
  inLanes(begin_[i], begin_[i + 1], [&](std::uint64_t k, std::size_t lane) {
    for (std::size_t c = 0; c < 4; ++c) sums[lane % 4].B[c] += weight[k] * records[id[k]].B[c];
  });
  const auto sum = [&](std::size_t c) { return (sums[0].B[c] + sums[1].B[c]) + (sums[2].B[c] + sums[3].B[c]); };
  return {sum(0), sum(1), sum(2)};
}

Rgb Exchange::irradianceOf(std::size_t i, std::span<const Rgb> B) const {
  if (!(area_[i] > 0)) return Rgb(0.0f);
  Rgb sum = sentOver(i) / e_[i];
  Rgb oneWay(0.0f);
  for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) {
    const Special& s = specials_[k];
    if (s.rough)
      oneWay += s.x * B[s.other];
    else
      sum += s.x * scale_[s.other] * B[s.other];
  }
  return (target_[i] * scale_[i] * sum + oneWay) / area_[i];
}

void Exchange::gather(std::span<const Rgb> B, std::span<Rgb> E) {
  fill(B);
  parallelFor(leaves(), kLeaves, [&](std::size_t i) { E[i] = irradianceOf(i, B); });
}

void Exchange::gather(std::span<const Rgb> B, std::span<Rgb> E, std::span<const std::uint32_t> leaves) {
  fill(B);
  parallelFor(leaves.size(), kFewLeaves, [&](std::size_t k) { E[leaves[k]] = irradianceOf(leaves[k], B); });
}

void Exchange::gatherAbout(std::span<const std::uint32_t> some, std::span<const Rgb> B, std::span<Rgb> E) {
  std::uint64_t entries = 0;
  for (const std::uint32_t i : some) entries += begin_[i + 1] - begin_[i];
  if (entries + oneWay_.size() > leaves() / kFewRows) return gather(B, E);
  std::vector<char> reached(leaves(), false);
  std::vector<std::uint32_t> rows;
  const auto add = [&](std::uint32_t row) {
    if (!reached[row]) reached[row] = true, rows.push_back(row);
  };
  for (const std::uint32_t row : oneWay_) add(row);
  for (const std::uint32_t i : some) {  // who sees them is seen by them
    add(i);
    for (std::uint64_t k = begin_[i]; k < begin_[i + 1]; ++k) add(id_[k]);
    for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) add(specials_[k].other);
  }
  gather(B, E, rows);
}

void Exchange::deviation(std::span<const Rgb> B, std::span<float> sigma) {
  std::vector<float> sent(leaves());
  parallelFor(leaves(), kLeaves, [&](std::size_t i) { sent[i] = scale_[i] / e_[i] * gray(B[i]); });
  parallelFor(leaves(), kLeaves, [&](std::size_t i) {
    std::array<double, kLanes> sums{}, squared{}, counts{};
    const float own = target_[i] * scale_[i] / e_[i];
    inLanes(begin_[i], begin_[i + 1], [&](std::uint64_t k, std::size_t lane) {
      const auto count = static_cast<float>(count_[k]);
      const double each = own * sent[id_[k]] * weight_[k] / count;
      sums[lane] += count * each, squared[lane] += count * each * each, counts[lane] += count;
    });
    double sum = sumOf(sums), squares = sumOf(squared), lines = sumOf(counts);
    const auto add = [&](double count, double each) {
      sum += count * each, squares += count * each * each, lines += count;
    };
    for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k) {
      const Special& s = specials_[k];
      add(1, gray(s.x * B[s.other]) * (s.rough ? 1.0f : target_[i] * scale_[i] * scale_[s.other]));
    }
    const double variance = lines > 1 ? std::max(0.0, squares - sum * sum / lines) * lines / (lines - 1) : sum * sum;
    sigma[i] = area_[i] > 0 ? static_cast<float>(std::sqrt(variance)) / area_[i] : 0.0f;
  });
}

void Exchange::arriving(std::span<double> share) const {
  // Symmetric: what i gets from j by radiosity, j gets from i; the factor of the receiver comes on top.
  parallelFor(leaves(), kLeaves, [&](std::size_t j) {
    double sum = 0;
    forEachExchange(j, [&](std::uint32_t i, float x) { sum += double(target_[i]) * scale_[i] * x; });
    share[j] = area_[j] > 0 ? sum * scale_[j] / area_[j] : 0;
  });
  for (std::size_t i = 0; i < leaves(); ++i)
    for (std::uint32_t k = specialBegin_[i]; k < specialBegin_[i + 1]; ++k)
      if (specials_[k].rough && area_[specials_[k].other] > 0)
        share[specials_[k].other] += gray(specials_[k].x) / area_[specials_[k].other];
}

std::size_t Exchange::memoryBytes() const {
  return leaves() * (6 * sizeof(float) + sizeof(LeafRecord)) + begin_.capacity() * 8 + id_.capacity() * 4 +
         count_.capacity() * 2 + weight_.capacity() * 4 + specialBegin_.capacity() * 4 +
         specials_.capacity() * sizeof(Special);
}

}  // namespace deltalux::lines
