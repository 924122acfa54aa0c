#pragma once
#include <deltalux/material.hpp>

namespace deltalux::scene {

/// Whether nothing is lit through a surface: what lies behind it is in the dark.
inline bool stopsLight(const Material& m) {
  return (std::holds_alternative<Opaque>(m.surface) || std::holds_alternative<Mirror>(m.surface)) && !passesStraight(m);
}

}  // namespace deltalux::scene
