#include "paper/line_space.hpp"

#include "base/parallel.hpp"
#include "paper/blockers.hpp"
#include "paper/link_samples.hpp"
#include "paper/visibility.hpp"

namespace deltalux::paper {

namespace {

template <class T>
void append(const std::vector<T>& from, std::vector<T>& to) {
  to.insert(to.end(), from.begin(), from.end());
}

constexpr float kBesideCell = 1.05f;  // of the angle of a sky's cell: none of it is farther from its centre [rounding]
}  // namespace

struct LineSpace::Finding {
  bool met = false, moved = false, anew = false;
  std::uint32_t rays = 0;  // that sampled it and may fare otherwise
};

LineSpace::LineSpace(const hierarchy::Links& links, const hierarchy::Elements& elements, const Scene& scene,
                     const SpaceChange& change, const SpaceChange& before, const SpaceChange& after)
    : links_(links),
      elements_(elements),
      scene_(scene),
      change_(change),
      before_(before),
      after_(after),
      above_(elements.size(), 0) {
  for (const hierarchy::ElementId e : change.inputs()) {
    if (elements.isPatch(e) && !elements.at(e).emitter) blockers_.push_back(e);
    for (hierarchy::ElementId up = elements.at(e).parent; up.valid() && !above_[up.index()];
         up = elements.at(up).parent)
      above_.at(up.index()) = 1;
  }
}

/// Whether what moved alone keeps the ends from seeing each other.
bool LineSpace::heldBack(const hierarchy::Link& l) const {
  return provablyBlocked(elements_, scene_, l.receiver, l.sender, blockers_.data(), blockers_.size());
}

LineSpace::Finding LineSpace::examine(hierarchy::LinkId id) const {
  const hierarchy::Link& l = links_[id];
  Finding f;
  f.moved = involved(l.receiver) || involved(l.sender);
  bool left = false, arrives = false;
  if (!f.moved) {
    const hierarchy::ElementGeometry &r = elements_.shape(l.receiver), &s = elements_.shape(l.sender);
    if (elements_.isDistant(l.sender) ? !change_.meetsBeam(r, s.center, kBesideCell * s.radius)
                                      : !change_.meets(r.center, r.radius, s.center, s.radius))
      return f;
    if (change_.hiddenFrom(l.receiver) || change_.hiddenFrom(l.sender)) return f;
    const Shaft shaft(r, s);
    left = before_.meets(shaft), arrives = after_.meets(shaft);
  }
  f.met = f.moved || left || arrives;
  if (!f.met) return f;
  // What samples tell stands as long as no ray of theirs meets what moved.
  if (!f.moved && l.visibility == hierarchy::Visibility::Sampled && (left || l.sampleMask != 0))
    f.rays = LinkSamples(elements_, scene_, l.receiver, l.sender).meeting(l.samples, l.sampleMask, change_, before_);
  switch (l.state) {
    case hierarchy::LinkState::Free:
      f.moved = false;
      break;
    case hierarchy::LinkState::Averted:
      break;
    case hierarchy::LinkState::Interior:
      // One that was refined for its shadow may no longer need to be; clusters with what moved stay refined.
      f.anew = f.rays != 0;
      f.moved = f.moved && (change_.moved(l.receiver) || change_.moved(l.sender));
      break;
    case hierarchy::LinkState::Active:
      f.anew = (l.visibility == hierarchy::Visibility::Clear && arrives) ||
               (l.visibility == hierarchy::Visibility::Blocked && left && heldBack(l)) || f.rays != 0;
      break;
  }
  return f;
}

/// What there is among some links of a level.
struct LineSpace::Block {
  std::vector<hierarchy::LinkId> next, moved;
  std::vector<DisturbedLink> between;
};

void LineSpace::examine(std::span<const hierarchy::LinkId> links, Block& found) const {
  for (const hierarchy::LinkId id : links) {
    const Finding f = examine(id);
    if (!f.met) continue;
    if (f.moved)
      found.moved.push_back(id);
    else if (f.anew)
      found.between.push_back({id, f.rays});
    for (std::size_t c = 0; c < links_[id].childCount; ++c) found.next.push_back(links_.child(id, c));
  }
}

LinkMarks LineSpace::visit() const {
  constexpr std::size_t kBlock = 256;  // [task]
  LinkMarks marks;
  std::vector<hierarchy::LinkId> level = links_.roots, next;
  while (!level.empty()) {
    std::vector<Block> blocks((level.size() + kBlock - 1) / kBlock);
    parallelBlocks(level.size(), kBlock, [&](std::size_t begin, std::size_t end) {
      examine(std::span(level).subspan(begin, end - begin), blocks[begin / kBlock]);
    });
    marks.visited += level.size();
    next.clear();
    for (const Block& b : blocks) append(b.next, next), append(b.moved, marks.moved), append(b.between, marks.between);
    std::swap(level, next);
  }
  return marks;
}

void add(const LinkMarks& more, LinkMarks& marks) {
  append(more.between, marks.between), append(more.moved, marks.moved);
  marks.visited += more.visited;
}

}  // namespace deltalux::paper
