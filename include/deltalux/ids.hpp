#pragma once
// Typed indices: an array is indexed only by its own id. Ids of one Scene are never reused within its life,
// so an edit recorded today names the same thing tomorrow.
#include <compare>
#include <cstdint>
#include <functional>

namespace deltalux {

template <class Tag>
struct Id {
  static constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t value = kNone;

  constexpr Id() = default;
  constexpr explicit Id(std::uint32_t v) : value(v) {}
  constexpr explicit Id(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr explicit Id(int v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr bool valid() const { return value != kNone; }
  constexpr std::size_t index() const { return value; }
  friend constexpr auto operator<=>(Id, Id) = default;
};

using PrimitiveId = Id<struct PrimitiveTag>;
using ObjectId = Id<struct ObjectTag>;
using MaterialId = Id<struct MaterialTag>;
using LightId = Id<struct LightTag>;
using TextureId = Id<struct TextureTag>;

}  // namespace deltalux

template <class Tag>
struct std::hash<deltalux::Id<Tag>> {
  std::size_t operator()(deltalux::Id<Tag> id) const noexcept { return std::hash<std::uint32_t>{}(id.value); }
};
