#include <cmath>
#include <set>
#include <stdexcept>
#include <string>

#include "hierarchy/link.hpp"

namespace deltalux::hierarchy {

namespace {
void requireOfLink(bool holds, std::size_t link, const char* what) {
  if (!holds) throw std::logic_error("link " + std::to_string(link) + ": " + what);
}
}  // namespace

void validate(const Links& links, const Elements& elements) {
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Link& l = links.all[i];
    if (l.state == LinkState::Free) continue;
    requireOfLink(l.receiver.index() < elements.size() && l.sender.index() < elements.size(), i, "its ends exist");
    requireOfLink(std::isfinite(l.K) && l.K >= 0, i, "K is finite and not negative");
    requireOfLink(glm::all(glm::greaterThanEqual(l.V, Rgb(0.0f))) && glm::all(glm::lessThanEqual(l.V, Rgb(1.0001f))), i,
                  "V is a fraction");
    requireOfLink((l.state == LinkState::Interior) == (l.childCount > 0), i, "exactly interior links have children");
    if (l.state != LinkState::Interior) continue;
    // Children cover every pair of (parts of) the ends once.
    std::set<std::pair<std::uint32_t, std::uint32_t>> pairs;
    const bool splitReceiver = links[links.child(LinkId(i), 0)].receiver != l.receiver;
    const bool splitSender = links[links.child(LinkId(i), 0)].sender != l.sender;
    for (std::size_t c = 0; c < l.childCount; ++c) {
      const Link& child = links[links.child(LinkId(i), c)];
      requireOfLink(child.parent == LinkId(i), i, "its children know it");
      requireOfLink(splitReceiver ? elements.at(child.receiver).parent == l.receiver : child.receiver == l.receiver, i,
                    "receivers refine its own");
      requireOfLink(splitSender ? elements.at(child.sender).parent == l.sender : child.sender == l.sender, i,
                    "senders refine its own");
      requireOfLink(pairs.emplace(child.receiver.value, child.sender.value).second, i, "no pair is covered twice");
    }
    const std::size_t receivers = splitReceiver ? elements.at(l.receiver).childCount : 1;
    const std::size_t senders = splitSender ? elements.at(l.sender).childCount : 1;
    requireOfLink(pairs.size() == receivers * senders, i, "no pair is left out");
  }
}

}  // namespace deltalux::hierarchy
