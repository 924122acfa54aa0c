#include "io/pbrt/state.hpp"

#include <algorithm>
#include <array>

namespace deltalux::io::pbrt {

Entity takeEntity(Tokens& tokens, const State& state, std::string type, std::string_view target) {
  Entity entity{std::move(type), {}, tokens.place()};
  entity.parameters = takeParameters(tokens);
  if (state.defaults)
    if (const auto own = state.defaults->find(target); own != state.defaults->end()) entity.defaults = own->second;
  return entity;
}

void takeDefaults(Tokens& tokens, State& state, const Place& at) {
  constexpr std::size_t kMost = 100;  // of one target [limit]
  constexpr std::array<std::string_view, 5> kTargets{"shape", "light", "material", "medium", "texture"};
  const std::string target = tokens.takeText("what attributes are for");
  if (std::ranges::find(kTargets, target) == kTargets.end()) fail(at, shown(target) + " has no attributes");
  DefaultsOf all = state.defaults ? *state.defaults : DefaultsOf{};
  Defaults own = all[target] ? *all[target] : Defaults{};
  for (Parameter& fresh : takeParameters(tokens)) {
    std::erase_if(own, [&](const auto& p) { return p->name == fresh.name; });
    own.push_back(std::make_shared<const Parameter>(std::move(fresh)));
  }
  if (own.size() > kMost) fail(at, "there are too many attributes");
  all[target] = std::make_shared<const Defaults>(std::move(own));
  state.defaults = std::make_shared<const DefaultsOf>(std::move(all));
}

}  // namespace deltalux::io::pbrt
