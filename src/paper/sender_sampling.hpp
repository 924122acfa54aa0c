#pragma once
// Points of elements and rays between them: what visibility and final gathering sample alike.
#include <array>
#include <span>

#include "base/random.hpp"
#include "hierarchy/patch.hpp"
#include "tracing/ray.hpp"

namespace deltalux::paper {

/// One sequence of samples. Those of a group are stratified together, too, each at its place (leaf_group.hpp).
struct SampleKey {
  SampleKey(std::uint64_t alone, unsigned at = 0) : key(alone), place(at) {}

  std::uint64_t key;
  unsigned place;

  SampleKey with(std::uint64_t more) const { return {combineKeys(key, more), place}; }
};

/// A four-dimensional sequence shifted by the key: stratified for any prefix (additive recurrence with the powers of
/// the generalised golden ratio [Roberts18]), and over the first places of a group.
class Stratified4 {
 public:
  explicit Stratified4(SampleKey);
  /// Sample i, from 0.
  std::array<double, 4> operator[](int i) const;

 private:
  std::array<double, 4> start_;
};
inline std::array<double, 4> stratified4(SampleKey key, int i) { return Stratified4(key)[i]; }

/// The item whose weight holds `u`, in [0,1), of the weights' sum `total`; null where none is above 0.
template <class Item>
Item* pickByWeight(std::span<Item> items, double total, double u) {
  Item* picked = nullptr;
  double rest = u * total;
  for (Item& item : items) {
    if (!(item.weight > 0)) continue;
    picked = &item;
    rest -= item.weight;
    if (rest < 0) break;
  }
  return picked;
}

/// The child that holds the share `a` of the area, in [0,1); `a` is used up in part. Invalid when nothing has area.
hierarchy::ElementId childByArea(const hierarchy::Elements&, hierarchy::ElementId, double& a);

/// A surface point of any element by two numbers in [0,1), uniform by area; clusters pick surfaces by area.
hierarchy::PatchPoint samplePoint(const hierarchy::Elements&, const Scene&, hierarchy::ElementId, double a, double b);

/// One ray from a receiving point to a point of a sender.
struct SenderSample {
  tracing::Ray ray;
  hierarchy::ElementId leaf;  // the patch below the sender that the point lies on
  double weight = 0;          // kernel between the points, per sender area; not above 0: they do not face each other
  bool measures = false;      // the weight is to be taken for the kernel, also of a flat sender
};

/// To the leaf that holds the sampled point of `sender`, a cluster or patch.
SenderSample sampleLeafOf(const hierarchy::Elements&, const Scene&, const hierarchy::PatchPoint& x,
                          hierarchy::ElementId sender, double a, double b);

}  // namespace deltalux::paper
