#pragma once
// A solution made ready for looking at: where a ray meets a surface side, the irradiance there. Built once a picture or
// a set of probes, then read by all threads.
#include <unordered_map>

#include "render/direct_light.hpp"
#include "render/irradiance_field.hpp"
#include "render/side_locator.hpp"

namespace deltalux {

struct Solution;

struct Reconstruction {
  /// The solution must outlive this.
  explicit Reconstruction(const Solution&);

  SideLocator locator;
  IrradianceField field;
  DirectLight direct;
};

/// Sender choices of the leaves that one thread meets; leaves recur, so most choices are made once.
class ChoiceCache {
 public:
  explicit ChoiceCache(const DirectLight& direct) : direct_(direct) {}
  const SenderChoice& at(ElementId leaf) {
    const auto [it, isNew] = choices_.try_emplace(leaf);
    if (isNew) it->second = direct_.choiceAt(leaf);
    return it->second;
  }

 private:
  const DirectLight& direct_;
  std::unordered_map<ElementId, SenderChoice> choices_;
};

}  // namespace deltalux
