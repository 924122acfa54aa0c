#pragma once
// Links: transfers from a sender to a receiver element, and the tree that refinement makes of them, which is the
// line-space hierarchy [GD01 5, DS97]. Refined links stay as interior nodes; the leaves carry light. Links that carry
// nothing (facing away, fully occluded) are kept too, so that every pair of leaves is covered by exactly one leaf link
// and the removal of a blocker is noticed.
#include <vector>

#include "hierarchy/element.hpp"

namespace deltalux::hierarchy {

using LinkId = Id<struct LinkTag>;

enum class LinkState : std::uint8_t {
  Active,    // E(receiver) += K V B(sender)
  Interior,  // refined: its children carry the light
  Averted,   // the ends do not face each other; nothing between them matters until one of them moves
  Free,      // no link: what a collapsed link's children leave, for the next ones of their number
};

enum class Visibility : std::uint8_t { Unknown, Clear, Blocked, Sampled };

struct Link {
  ElementId receiver, sender;
  LinkId parent, firstChild;
  float K = 0.0f;                 // unoccluded transfer; its unit by kind of sender is in paper/kernel.hpp
  Rgb V{0.0f};                    // mean transmittance of the sample rays
  float receiverSpread = 0.0f;    // bound on |K(x) - K| over the receiver
  float senderSpread = 0.0f;      // bound on |K(y) - K| over the sender
  float visibilitySpread = 0.0f;  // bound on |V(x) - V|
  std::uint32_t sampleMask = 0;   // bit i: sample ray i passed
  std::uint16_t childCount = 0;
  std::uint8_t samples = 0;
  LinkState state = LinkState::Active;
  Visibility visibility = Visibility::Unknown;

  /// Whether rays were sent and none passed.
  bool unseen() const { return visibility == Visibility::Sampled && sampleMask == 0 && isBlack(V); }
  /// Whether it can bring its receiver light.
  bool carries() const { return state == LinkState::Active && visibility != Visibility::Blocked; }
};

class Links {
 public:
  std::vector<Link> all;
  std::vector<LinkId> roots;              // scene <- scene, scene <- lights, scene <- each distant sender
  std::vector<std::vector<LinkId>> free;  // blocks of free links, by their number

  Link& operator[](LinkId id) { return all[id.index()]; }
  const Link& operator[](LinkId id) const { return all[id.index()]; }
  std::size_t size() const { return all.size(); }
  LinkId child(LinkId id, std::size_t i) const {
    return LinkId(all[id.index()].firstChild.value + static_cast<std::uint32_t>(i));
  }
  /// A link without a parent.
  LinkId addRoot(ElementId receiver, ElementId sender);
  /// `count` contiguous links below `parent`, which becomes Interior. The caller sets their ends by setEnds.
  LinkId addChildren(LinkId parent, std::size_t count);
  void setEnds(LinkId, ElementId receiver, ElementId sender);
  /// Gives a link what it was evaluated to be; its place in the tree stays. The one way to change links.
  void evaluated(LinkId, const Link&);
  /// Frees all links below an interior link, which becomes Active.
  void collapse(LinkId);
  std::size_t memoryBytes() const { return all.capacity() * sizeof(Link); }
};

/// Checks the tree: children cover exactly the pairs of their parent, transfers are finite and not negative, leaves
/// have no children. Throws std::logic_error with the first violation.
void validate(const Links&, const Elements&);

}  // namespace deltalux::hierarchy
