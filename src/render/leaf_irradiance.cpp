#include "render/leaf_irradiance.hpp"

#include "hierarchy/leaf_table.hpp"

namespace deltalux::rendering {

std::vector<LeafIrradiance> meshIrradiance(const hierarchy::Elements& elements, const caustics::Caustics& caustics,
                                           std::span<const float> deviation) {
  std::vector<LeafIrradiance> values(elements.size());
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const hierarchy::ElementLight& l = elements.radiometry[i];
    const bool textured = elements.isPatch(hierarchy::ElementId(i)) && elements.domain[i].primitive.valid() &&
                          caustics.of(elements.domain[i].primitive, elements.topology[i].front) != nullptr;
    values[i] = {l.direct, textured ? l.indirect : l.indirect + l.particle, 0, textured ? Rgb(0.0f) : l.particle};
  }
  if (deviation.empty()) return values;
  const hierarchy::LeafTable leaves(elements);
  for (std::size_t i = 0; i < leaves.size() && i < deviation.size(); ++i)
    values[leaves[i].index()].noise = deviation[i];
  return values;
}

}  // namespace deltalux::rendering
