#pragma once
// A solution made ready for looking at: where a ray meets a surface side, the irradiance there. Built once a picture or
// a set of probes, then read by all threads.
#include <atomic>
#include <memory>
#include <vector>

#include "hierarchy/side_locator.hpp"
#include "radiosity/direct_light.hpp"
#include "render/irradiance_field.hpp"
#include "render/point_sources.hpp"

namespace deltalux {

struct Solution;

}  // namespace deltalux

namespace deltalux::rendering {

/// Sender choices of the leaves that were met, each made once, whichever thread comes first.
class ChoiceCache {
 public:
  ChoiceCache(const radiosity::DirectLight& direct, std::size_t elements) : direct_(direct), choices_(elements) {}
  ~ChoiceCache() {
    for (auto& c : choices_) delete c.load();
  }
  ChoiceCache(const ChoiceCache&) = delete;
  ChoiceCache& operator=(const ChoiceCache&) = delete;

  const radiosity::SenderChoice& at(hierarchy::ElementId leaf) const {
    auto& place = choices_[leaf.index()];
    if (const radiosity::SenderChoice* known = place.load(std::memory_order_acquire)) return *known;
    auto made = std::make_unique<radiosity::SenderChoice>(direct_.choiceAt(leaf));
    const radiosity::SenderChoice* expected = nullptr;
    // Choices depend on the leaf alone: when two threads make one, either serves.
    if (place.compare_exchange_strong(expected, made.get(), std::memory_order_acq_rel)) return *made.release();
    return *expected;
  }

 private:
  const radiosity::DirectLight& direct_;
  mutable std::vector<std::atomic<const radiosity::SenderChoice*>> choices_;
};

struct Reconstruction {
  /// The solution must outlive this. `before`: of the same solution, as it was; what has not changed is taken over.
  explicit Reconstruction(const Solution&, const Reconstruction* before = nullptr);

  hierarchy::SideLocator locator;
  IrradianceField field;
  radiosity::DirectLight direct;
  ChoiceCache choices;
  std::unique_ptr<const PointSources> points;  // of a solution over lines, in place of both
};

}  // namespace deltalux::rendering
