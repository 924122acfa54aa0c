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
// Lines of one pair are one entry: the other leaf, their number, and that over (m_i + m_j) where m = n / e. Cost: 10
// bytes an entry, half a nanosecond a pass on two threads. Sums over a row run in lanes, of every eighth entry each, so
// that processors do eight at once; the order is the same everywhere.
#include <array>

#include "base/tuning.hpp"
#include "lines/lines.hpp"
#include "lines/tuning.hpp"

namespace deltalux::lines {

/// How much the factor of a leaf's exchange may differ from what an update goes on with, relative: as much as its
/// iteration leaves of light.
inline constexpr auto kFollowed = static_cast<float>(deltalux::tuning::kConverged);

/// s / e times radiosity, as wide as registers.
struct alignas(16) LeafRecord {
  std::array<float, 4> B{};
};

class Exchange {
 public:
  Exchange(const Lines&, const hierarchy::Elements&, const hierarchy::LeafTable&, const LineTracer&);
  /// Becomes that over the lines there are, as if it had been made of them, within kFollowed: by those that are others.
  /// `known`: what was known of the lines that it was of.
  void follow(const KnownLines& known, const Lines&, const hierarchy::Elements&, const hierarchy::LeafTable&,
              const LineTracer&);
  /// Knows leaves by what their elements are now; to follow() then. `now`: by element, kNone where it is no more.
  void renumber(std::span<const std::uint32_t> now, std::size_t elements);

  std::size_t leaves() const { return leaves_.size(); }
  /// Lit area [unit^2]; share of a leaf's own lines that end on leaves. Leaves are in the order of LeafTable.
  float area(std::size_t leaf) const { return area_[slot_[leaf]]; }
  float closed(std::size_t leaf) const { return closed_[slot_[leaf]]; }

  /// Keeps light between leaves and mirrors from growing: by what leaves reflect and let through, those that get more
  /// than all around them send, in a channel, get no more than returns to it with kMostSurvival. Sums of a few coloured
  /// lines, scaled by gray ones, may say so. Holds until rows are others.
  void bound(std::span<const Rgb> returned);
  /// Irradiance of every leaf from the radiosities of all [W/m2]. Sizes must agree.
  void gather(std::span<const Rgb> B, std::span<Rgb> E);
  /// Takes in radiosities, and gathers nothing by them.
  void send(std::span<const Rgb> B);
  /// The same of some leaves alone, of which the radiosities are others than were taken in last, and no others.
  void gatherAmong(std::span<const std::uint32_t> leaves, std::span<const Rgb> B, std::span<Rgb> E);
  /// The same of all that the radiosities of those have to do with.
  void gatherAbout(std::span<const std::uint32_t> leaves, std::span<const Rgb> B, std::span<Rgb> E);
  /// Standard deviation of gather()'s gray irradiance, from the scatter of the leaf's lines [W/m2].
  void deviation(std::span<const Rgb> B, std::span<float> sigma);
  /// Share of what leaf j sends that arrives at leaves: column sums.
  void arriving(std::span<double> share) const;

  std::size_t memoryBytes() const;

 private:
  /// Where the entries of a leaf are, and the room for more of them behind.
  struct Row {
    std::uint64_t first = 0;
    std::uint32_t count = 0, room = 0;

    std::uint64_t end() const { return first + count; }
  };
  struct Special {
    std::uint32_t other;
    Rgb x{0.0f};  // as in the header, the scaling left out; rough ones per area of the leaf
    bool rough;
  };
  /// Slots that see others which have no entry of them, by what they see.
  struct Seers {
    std::vector<std::uint32_t> begin, seers;  // of all slots, and one more for the end

    std::span<const std::uint32_t> of(std::uint32_t seen) const {
      return std::span(seers).subspan(begin[seen], begin[seen + 1] - begin[seen]);
    }
  };
  /// What a leaf's own straight lines meet and end on, by which its row is scaled.
  struct OwnLines {
    float met = 0, ended = 0;
  };
  /// Whether no line ends there, since it sends nothing diffusely: its lines count at their start alone.
  bool onlyReceives(std::uint32_t slot) const { return e_[slot] < 1e-3f; }
  /// The factor s of a leaf.
  float scaleOf(std::uint32_t slot) const { return passes_.back()[slot] * e_[slot]; }
  void setLeaves(const Lines&, const hierarchy::Elements&, const hierarchy::LeafTable&, const LineTracer&);
  void build(const Lines&);
  /// Rows of the changed lines; marks those whose entries are others.
  void change(const KnownLines&, const Lines&, std::vector<char>& changed);
  /// Slots of what is no leaf any more become free; marks what exchanged with them.
  void freeSlots(std::vector<char>& changed);
  void freeSlot(std::uint32_t slot, std::vector<char>& changed);
  /// Marks what exchanges something with a slot otherwise than over straight lines.
  void markSpecials(std::uint32_t slot, std::vector<char>& marked) const;
  /// The same with leaves that only receive.
  void markOthers(std::uint32_t slot, std::vector<char>& marked) const;
  void tidy();
  void weigh(std::uint32_t slot);
  void addSpecials(const Lines&);
  void listSeers();
  void countOwn(const Lines&, hierarchy::ElementId leaf);
  void setShare(const Lines&, hierarchy::ElementId leaf);
  /// Factors of rows that are `changed`, and of those that they have to do with; becomes those of which what they bring
  /// is another.
  void scale(std::vector<char>& changed);
  /// A slot whose factor is another, and by how much.
  struct Other {
    std::uint32_t slot;
    float by;
  };
  /// Adds that to what others are owed over their lines; marks those that exchange with them otherwise, as leaves that
  /// only receive do, and themselves. Returns whether they are so many that it is as well to take all rows.
  bool owe(std::span<const Other> others, std::vector<float>& owed, std::vector<char>& marked) const;
  LeafRecord sentBy(std::uint32_t slot, const Rgb& B) const;
  Rgb sentOver(std::uint32_t slot) const;
  Rgb irradianceOf(std::uint32_t slot, std::span<const Rgb> B) const;
  /// visit(other, x) of all symmetric exchange of a leaf, unscaled, gray.
  template <class Visit>
  void forEachExchange(std::uint32_t slot, const Visit&) const;
  /// Sum of all symmetric exchange of a leaf, unscaled, gray, times a value of the other, given over its chance of
  /// ends.
  float exchangeWith(std::uint32_t slot, std::span<const float> valueOverE) const;

  static constexpr std::uint32_t kNone = hierarchy::LeafTable::kNone;
  // Leaves keep their slots: at first they are in order, and what is read together lies together.
  std::vector<hierarchy::ElementId> leaves_;  // in order
  std::vector<std::uint32_t> slot_;           // of these
  std::vector<std::uint32_t> slotOf_;         // by element, kNone of what is no leaf
  std::vector<std::uint32_t> numberOf_;       // by slot: of its leaf in the order, kNone of free ones
  std::vector<std::uint32_t> free_;
  std::vector<float> area_, m_, e_, closed_, target_, share_;  // by slot; m: n / e
  std::vector<Rgb> bound_;                                     // by slot: of irradiance
  std::vector<OwnLines> own_;
  std::vector<Row> row_;
  std::array<std::vector<float>, tuning::kScalingPasses + 1> passes_;      // s / e after each pass
  std::array<std::vector<float>, tuning::kScalingPasses + 2> owedFactor_;  // to each, and in the end: see owe()
  std::vector<LeafRecord> records_;
  std::vector<char> shortened_;              // rows that have lost entries since they were scaled
  std::vector<std::uint32_t> specialBegin_;  // one more for the end
  std::vector<Special> specials_;
  LargeArray<std::uint32_t> id_;  // slots
  LargeArray<std::uint16_t> count_;
  LargeArray<float> weight_;
  Seers roughly_;    // over rough lobes
  Seers receiving_;  // leaves that only receive, all that they see else
};

}  // namespace deltalux::lines
