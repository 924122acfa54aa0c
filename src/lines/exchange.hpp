#pragma once
// What leaves exchange over their lines, as rows to iterate over. A line between leaves i and j samples the same
// measure from either end, so both ends' estimators are combined by the balance heuristic [VG95]: with n = N / A lines
// by area and e the chance that a line ends on a leaf, it exchanges
//
//   x = w / (n_i e_j + n_j e_i)                                                        [unit^2]
//
// of area each way, w being its throughput over the chance of its way; over rough lobes, whose chance back is another,
// it counts at its start alone, with w A_i / (N_i e_j). Then
//
//   E_i = 1 / A_i  sum over j of s_i s_j x_ij B_j
//
// The factors s are found by symmetric scaling (Sinkhorn & Knopp): what a row sums to then agrees with the share of the
// leaf's own lines that end on leaves, which is exact where nothing escapes, so no row exceeds one and light in a
// closed room is kept to the last digit; and the exchange stays reciprocal, so no light is made or lost between two
// leaves. [lines.md]
//
// Lines of one pair are one entry: leaf, count, and count / (m_i + m_j) where m = n / e. Cost: 10 bytes an entry, half
// a nanosecond a pass on two threads. Sums over a row run in lanes, of every eighth entry each, so that processors do
// eight at once; the order is the same everywhere.
#include <array>

#include "lines/lines.hpp"

namespace deltalux::lines {

/// s / e times radiosity, as wide as registers.
struct alignas(16) LeafRecord {
  std::array<float, 4> B{};
};

class Exchange {
 public:
  Exchange(const Lines&, const hierarchy::Elements&, const hierarchy::LeafTable&, const LineTracer&,
           std::span<const std::uint32_t> covered);
  /// The same, to the last bit, from that over the lines from before: for the lines that are others. `known`: what was
  /// known of them.
  Exchange(const Exchange& before, const KnownLines& known, const Lines&, const hierarchy::Elements&,
           const hierarchy::LeafTable&, const LineTracer&, std::span<const std::uint32_t> covered);

  std::size_t leaves() const { return area_.size(); }
  /// Lit area [unit^2]; share of a leaf's own lines that end on leaves.
  float area(std::size_t leaf) const { return area_[leaf]; }
  float closed(std::size_t leaf) const { return closed_[leaf]; }

  /// Irradiance of every leaf from the radiosities of all [W/m2]. Sizes must agree.
  void gather(std::span<const Rgb> B, std::span<Rgb> E);
  /// The same of some leaves alone.
  void gather(std::span<const Rgb> B, std::span<Rgb> E, std::span<const std::uint32_t> leaves);
  /// The same of all that the radiosities of some leaves have to do with.
  void gatherAbout(std::span<const std::uint32_t> leaves, std::span<const Rgb> B, std::span<Rgb> E);
  /// Standard deviation of gather()'s gray irradiance, from the scatter of the leaf's lines [W/m2].
  void deviation(std::span<const Rgb> B, std::span<float> sigma);
  /// Share of what leaf j sends that arrives at leaves: column sums.
  void arriving(std::span<double> share) const;

  std::size_t memoryBytes() const;

 private:
  struct Special {
    std::uint32_t other;
    Rgb x{0.0f};  // as in the header, the scaling left out; rough ones per area of the leaf
    bool rough;
  };
  /// Whether no line ends there, since it sends nothing diffusely: its lines count at their start alone.
  bool onlyReceives(std::size_t leaf) const { return e_[leaf] < 1e-3f; }
  Exchange(const hierarchy::Elements&, const hierarchy::LeafTable&, const LineTracer&, const Lines&,
           std::span<const std::uint32_t> covered);
  void build(const Lines&);
  void build(const Exchange& before, const KnownLines&, const Lines&);
  void weigh();
  void addSpecials(const Lines&);
  void listOneWay();
  void setTargets(const Lines&, std::span<const std::uint32_t> covered);
  void scale();
  void fill(std::span<const Rgb> B);
  Rgb sentOver(std::size_t leaf) const;
  Rgb irradianceOf(std::size_t leaf, std::span<const Rgb> B) const;
  /// visit(other, x) of all symmetric exchange of a leaf, unscaled, gray.
  template <class Visit>
  void forEachExchange(std::size_t leaf, const Visit&) const;
  /// Sum of all symmetric exchange of a leaf, unscaled, gray, times a value of the other over its chance of ends.
  float exchangeWith(std::size_t leaf, std::span<const float> value, std::span<const float> valueOverE) const;

  std::vector<float> area_, m_, e_, closed_, target_, scale_;  // by leaf; m: n / e
  LargeArray<std::uint64_t> begin_;                            // of the entries of a leaf
  LargeArray<std::uint32_t> id_;
  LargeArray<std::uint16_t> count_;
  LargeArray<float> weight_;
  std::vector<std::uint32_t> specialBegin_;
  std::vector<Special> specials_;
  std::vector<std::uint32_t> oneWay_;  // leaves that may see such as have no entry of them
  std::vector<LeafRecord> records_;
};

}  // namespace deltalux::lines
