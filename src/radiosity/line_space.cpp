#include "radiosity/line_space.hpp"

#include "base/parallel.hpp"
#include "radiosity/blockers.hpp"
#include "radiosity/visibility.hpp"

namespace deltalux {

struct LineSpace::Finding {
  bool met = false, touched = false, anew = false, lit = false;
};

LineSpace::LineSpace(const Links& links, const Elements& elements, const Scene& scene, const SpaceChange& change)
    : links_(links), elements_(elements), scene_(scene), change_(change), holds_(elements.size(), 0) {
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const ElementId e(i);
    if (!change.moved(e) || elements.at(e).depth > 0) continue;
    if (elements.isPatch(e) && !elements.at(e).emitter) blockers_.push_back(e);
    for (ElementId up = elements.at(e).parent; up.valid() && !holds_[up.index()]; up = elements.at(up).parent)
      holds_[up.index()] = 1;
  }
}

bool LineSpace::moves(const Link& l) const { return change_.moved(l.receiver) || change_.moved(l.sender); }

/// Whether what moved alone keeps the ends from seeing each other.
bool LineSpace::heldBack(const Link& l) const {
  return provablyBlocked(elements_, scene_, l.receiver, l.sender, blockers_.data(), blockers_.size());
}

LineSpace::Finding LineSpace::examine(LinkId id, const SpaceChange& space, bool arriving) const {
  const Link& l = links_[id];
  Finding f;
  const bool ends = moves(l);
  const bool within = holds_[l.receiver.index()] || holds_[l.sender.index()];
  f.met = ends || within || space.meets(Shaft(elements_.shape(l.receiver), elements_.shape(l.sender)));
  if (!f.met) return f;
  switch (l.state) {
    case LinkState::Free:
      break;
    case LinkState::Averted:
      f.anew = ends || within;
      break;
    case LinkState::Interior:
      // One that was refined for its shadow may no longer need to be.
      f.anew = ends || (l.visibility == Visibility::Sampled && samplesMeet(elements_, scene_, l, space));
      break;
    case LinkState::Active:
      f.touched = l.visibility != Visibility::Blocked;
      f.lit = elements_.at(l.sender).emitter && (holds_[l.sender.index()] || change_.moved(l.sender));
      f.anew = ends || within || (l.visibility == Visibility::Clear && arriving) ||
               (l.visibility == Visibility::Blocked && !arriving && heldBack(l)) ||
               (l.visibility == Visibility::Sampled && samplesMeet(elements_, scene_, l, space));
      break;
  }
  return f;
}

void LineSpace::visit(const SpaceChange& space, bool arriving, LinkMarks& marks) const {
  marks.changes.resize(links_.size(), LinkChange::None);
  marks.isAnew.resize(links_.size(), 0);
  std::vector<LinkId> level = links_.roots, next;
  std::vector<Finding> findings;
  while (!level.empty()) {
    findings.assign(level.size(), {});
    parallelFor(level.size(), 256, [&](std::size_t i) { findings[i] = examine(level[i], space, arriving); });
    marks.visited += level.size();
    next.clear();
    for (std::size_t i = 0; i < level.size(); ++i) {
      const Finding& f = findings[i];
      const LinkId id = level[i];
      if (!f.met) continue;
      if (f.touched && marks.changes[id.index()] == LinkChange::None) {
        marks.changes[id.index()] = LinkChange::Touched;
        marks.touched.push_back(id);
      }
      if (f.anew && !marks.isAnew[id.index()]) {
        marks.isAnew[id.index()] = 1;
        marks.anew.push_back(id);
        if (f.lit) marks.lit.push_back(id);
      }
      for (std::size_t c = 0; c < links_[id].childCount; ++c) next.push_back(links_.child(id, c));
    }
    std::swap(level, next);
  }
}

}  // namespace deltalux
