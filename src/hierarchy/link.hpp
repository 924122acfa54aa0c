#pragma once
// Links: transfers from a sender to a receiver element, and the tree that refinement makes of them, which is the
// line-space hierarchy [GD01 5, DS97]. Refined links stay as interior nodes; the leaves carry light. Links that carry
// nothing (facing away, fully occluded) are kept too, so that every pair of leaves is covered by exactly one leaf link
// and the removal of a blocker is noticed.
#include <functional>
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
  LinkId nextArriving, previousArriving;  // at the same receiver
  float K = 0.0f;                         // unoccluded transfer; its unit by kind of sender is in paper/kernel.hpp
  Rgb V{0.0f};                            // mean transmittance of the sample rays
  float receiverSpread = 0.0f;            // bound on |K(x) - K| over the receiver
  float senderSpread = 0.0f;              // bound on |K(y) - K| over the sender
  float visibilitySpread = 0.0f;          // bound on |V(x) - V|
  std::uint32_t sampleMask = 0;           // bit i: sample ray i passed
  std::uint16_t childCount = 0;
  std::uint8_t samples = 0;
  LinkState state = LinkState::Active;
  Visibility visibility = Visibility::Unknown;
  bool fromLight = false;   // the sender is an emitter
  bool listed = false;      // among those that arrive at its receiver
  std::uint8_t hidden = 0;  // links above it in a row of whose sample rays none passed, when it was judged; or kHidden

  static constexpr std::uint8_t kHidden = 255;  // it was proven blocked, and nothing has been seen of it since

  /// Whether rays were sent and none passed.
  bool unseen() const { return visibility == Visibility::Sampled && sampleMask == 0 && isBlack(V); }
  /// Whether it can bring its receiver light.
  bool carries() const { return state == LinkState::Active && visibility != Visibility::Blocked; }
};

class Links {
 public:
  std::vector<Link> all;
  std::vector<LinkId> roots;              // scene <- scene, scene <- lights, scene <- each distant sender
  std::vector<LinkId> arriving;           // by element: the first link of which it is the receiver
  std::vector<std::vector<LinkId>> free;  // blocks of free links, by their number

  Link& operator[](LinkId id) { return all[id.index()]; }
  const Link& operator[](LinkId id) const { return all[id.index()]; }
  std::size_t size() const { return all.size(); }
  LinkId child(LinkId id, std::size_t i) const {
    return LinkId(all[id.index()].firstChild.value + static_cast<std::uint32_t>(i));
  }
  /// The links that carry light to a receiver from surfaces, or from lights, last made first:
  /// for (id = first(e, lights); id.valid(); id = links[id].nextArriving).
  LinkId first(ElementId receiver, bool fromLights) const {
    const std::size_t at = 2 * receiver.index() + fromLights;
    return at < arriving.size() ? arriving[at] : LinkId();
  }

  /// A link without a parent.
  LinkId addRoot(ElementId receiver, ElementId sender, bool fromLight);
  /// `count` contiguous links below `parent`, which becomes Interior. The caller sets their ends by setEnds.
  LinkId addChildren(LinkId parent, std::size_t count);
  void setEnds(LinkId, ElementId receiver, ElementId sender);
  /// How many links above one, in a row, have sample rays of which none passed.
  std::uint8_t hiddenAbove(LinkId) const;
  /// Gives a link what it was judged to be; its place in the tree stays. The one way to change links.
  void judged(LinkId, const Link&);
  /// Frees all links below an interior link, which becomes Active. Calls `gone` with each.
  void collapse(LinkId, const std::function<void(LinkId)>& gone = {});
  /// Makes the lists of links that arrive anew, in the order of the links.
  void listArriving();
  std::size_t memoryBytes() const;

 private:
  void list(LinkId);
  void unlist(LinkId);
};

/// Checks the tree: children cover exactly the pairs of their parent, transfers are finite and not negative, leaves
/// have no children. Throws std::logic_error with the first violation.
void validate(const Links&, const Elements&);

}  // namespace deltalux::hierarchy
