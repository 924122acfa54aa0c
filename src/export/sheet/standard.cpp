#include <algorithm>
#include <array>
#include <deltalux/sheet.hpp>

namespace deltalux {

namespace {

struct Kind {
  const char* name;
  AreaRequirements required;
};

/// [EN12464 tables 10 to 45]
const std::array<Kind, 8>& kinds() {
  const auto office = [](double mean, double uniformity, double glare) {
    return AreaRequirements{mean, uniformity, glare, 150.0, 150.0, 100.0, 0.10};
  };
  const auto plain = [](double mean, double uniformity, double glare) {
    return AreaRequirements{mean, uniformity, glare, {}, {}, {}, {}};
  };
  static const std::array<Kind, 8> all{{{"office", office(500, 0.60, 19)},
                                        {"office-raised", office(1000, 0.60, 19)},
                                        {"drawing", office(750, 0.70, 16)},
                                        {"conference", office(500, 0.60, 19)},
                                        {"classroom", office(500, 0.60, 19)},
                                        {"reception", plain(300, 0.60, 22)},
                                        {"archive", plain(200, 0.40, 25)},
                                        {"corridor", plain(100, 0.40, 28)}}};
  return all;
}

}  // namespace

std::optional<AreaRequirements> en12464(std::string_view kind) {
  const auto found = std::ranges::find_if(kinds(), [&](const Kind& k) { return kind == k.name; });
  return found == kinds().end() ? std::nullopt : std::optional(found->required);
}

std::vector<std::string> en12464Kinds() {
  std::vector<std::string> names;
  for (const Kind& kind : kinds()) names.emplace_back(kind.name);
  return names;
}

}  // namespace deltalux
