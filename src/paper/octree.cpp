#include "paper/octree.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/sort_unique.hpp"
#include "particles/segment_box.hpp"

namespace deltalux::paper {

namespace {

constexpr int kMaxDepth = 24;  // of an object next to nothing in a large scene [limit]

std::vector<Box> grown(std::span<const Box> boxes, double by) {
  std::vector<Box> result;
  for (const Box& b : boxes)
    if (!b.empty()) result.push_back({b.lower - by, b.upper + by});
  return result;
}

double largestExtent(const std::vector<Box>& boxes) {
  Box all;
  for (const Box& b : boxes) all.extend(b);
  const Vec3 extent = all.extent();
  return std::max({extent.x, extent.y, extent.z});
}

}  // namespace

Octree::Place Octree::Place::child(std::uint32_t i) const {
  const double half = 0.5 * side;
  return {lower + half * Vec3(i & 1, i >> 1 & 1, i >> 2), half, depth + 1};
}

Octree::Octree(const particles::Particles& p, const Box& scene, std::span<const Box> object, double margin,
               const OctreeSettings& settings)
    : margin_(margin), object_(grown(object, margin)), cells_(1) {
  Box all = scene;
  for (const Box& b : object_) all.extend(b);
  const Vec3 extent = all.extent();
  root_.side = std::max({extent.x, extent.y, extent.z, 1e-6}) + 2 * margin_;
  root_.lower = all.center() - 0.5 * root_.side;
  const double finest = object_.empty() ? root_.side : settings.finest * largestExtent(object_);
  deepest_ = static_cast<int>(std::clamp(std::ceil(std::log2(root_.side / finest)), 0.0, double(kMaxDepth)));
  hold(0, root_, {}, object_, p, nullptr);  // while it is empty
  for (std::uint32_t link = 0; link < p.links.size(); ++link)
    for (std::uint32_t path = 0; path < p.links[link].paths; ++path)
      insert(p, link, p.verticesOf(p.links[link].firstPath + std::size_t(path)));
}

bool Octree::hold(const particles::Particles& p, std::span<const Box> object, OctreeChange& change) {
  Boxes now = grown(object, margin_);
  const Box whole = root_.box();
  for (const Box& b : now)
    if (!whole.contains(b.lower) || !whole.contains(b.upper)) return false;
  hold(0, root_, object_, now, p, &change);
  object_ = std::move(now);
  sortUnique(change.links);
  return true;
}

Octree::Boxes Octree::touching(const Place& place, const Boxes& boxes) const {
  Boxes found;
  const Box cell = place.box();
  for (const Box& b : boxes)
    if (b.overlaps(cell)) found.push_back(b);
  return found;
}

/// The object is re-inserted: each cell is unaffected, or has come to hold the object, or holds it no longer, or holds
/// it elsewhere. [GD01 4.2] `before` and `now`: what of the object is in the cell.
void Octree::hold(std::uint32_t cell, const Place& place, const Boxes& before, const Boxes& now,
                  const particles::Particles& p, OctreeChange* change) {
  if (before.empty() && now.empty()) return;
  if (place.depth == deepest_) {
    if (!change) return;
    ++(before.empty() ? change->gained : now.empty() ? change->lost : change->kept);
    cells_[cell].links.forEach([&](std::uint32_t link) { change->links.push_back(link); });
    return;
  }
  if (cells_[cell].firstChild == 0) split(cell, place, p);
  const std::uint32_t first = cells_[cell].firstChild;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const Place child = place.child(i);
    hold(first + i, child, touching(child, before), touching(child, now), p, change);
  }
  if (now.empty()) simplify(cell, p);
}

std::uint32_t Octree::allocate() {
  if (!free_.empty()) {
    const std::uint32_t first = free_.back();
    free_.pop_back();
    return first;
  }
  const auto first = static_cast<std::uint32_t>(cells_.size());
  cells_.resize(cells_.size() + 8);
  return first;
}

/// Its links go to those of its parts that they cross.
void Octree::split(std::uint32_t cell, const Place& place, const particles::Particles& p) {
  const std::uint32_t first = allocate();
  const LinkTable links = std::move(cells_[cell].links);
  cells_[cell].links.clear();
  cells_[cell].firstChild = first;
  links.forEach([&](std::uint32_t link) {
    for (std::uint32_t path = 0; path < p.links[link].paths; ++path) {
      const std::span<const Vec3f> v = p.verticesOf(p.links[link].firstPath + std::size_t(path));
      for (std::size_t i = 0; i + 1 < v.size(); ++i)
        crossed(cell, place, margin_, v[i], v[i + 1], [&](std::uint32_t c) { cells_[c].links.insert(link, p.links); });
    }
  });
}

/// Its parts, which are not subdivided, become one.
void Octree::simplify(std::uint32_t cell, const particles::Particles& p) {
  const std::uint32_t first = cells_[cell].firstChild;
  for (std::uint32_t i = 0; i < 8; ++i) {
    cells_[first + i].links.forEach([&](std::uint32_t link) { cells_[cell].links.insert(link, p.links); });
    cells_[first + i].links.clear();
  }
  free_.push_back(first);
  cells_[cell].firstChild = 0;
}

/// visit(cell) of all below that are not subdivided and that the segment crosses.
template <class Visit>
void Octree::crossed(std::uint32_t cell, const Place& place, double margin, const Vec3f& a, const Vec3f& b,
                     const Visit& visit) const {
  if (!particles::SegmentBox(place.box(), margin).meets(a, b)) return;
  const std::uint32_t first = cells_[cell].firstChild;
  if (first == 0) return visit(cell);
  for (std::uint32_t i = 0; i < 8; ++i) crossed(first + i, place.child(i), margin, a, b, visit);
}

template <class Visit>
void Octree::forPath(std::span<const Vec3f> v, double margin, const Visit& visit) const {
  for (std::size_t i = 0; i + 1 < v.size(); ++i) crossed(0, root_, margin, v[i], v[i + 1], visit);
}

void Octree::erase(const particles::Particles& p, std::uint32_t link, std::span<const Vec3f> vertices) {
  forPath(vertices, margin_, [&](std::uint32_t cell) { cells_[cell].links.erase(link, p.links); });
}

void Octree::insert(const particles::Particles& p, std::uint32_t link, std::span<const Vec3f> vertices) {
  forPath(vertices, margin_, [&](std::uint32_t cell) { cells_[cell].links.insert(link, p.links); });
}

std::size_t Octree::cells() const { return cells_.size() - 8 * free_.size(); }

std::size_t Octree::memoryBytes() const {
  std::size_t bytes = sizeof *this + cells_.capacity() * sizeof(Cell) + free_.capacity() * sizeof free_[0] +
                      object_.capacity() * sizeof(Box);
  for (const Cell& c : cells_) bytes += c.links.memoryBytes();
  return bytes;
}

/// By cell: the links whose paths cross it, ascending.
Octree::LinksOfCells Octree::crossings(const particles::Particles& p, double margin) const {
  LinksOfCells links(cells_.size());
  for (std::uint32_t link = 0; link < p.links.size(); ++link)
    for (std::uint32_t path = 0; path < p.links[link].paths; ++path)
      forPath(p.verticesOf(p.links[link].firstPath + std::size_t(path)), margin, [&](std::uint32_t cell) {
        if (links[cell].empty() || links[cell].back() != link) links[cell].push_back(link);
      });
  return links;
}

void Octree::validate(const particles::Particles& p) const {
  validateCells();
  const LinksOfCells least = crossings(p, 0.5 * margin_), most = crossings(p, margin_);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    std::vector<std::uint32_t> known;
    cells_[c].links.forEach([&](std::uint32_t link) { known.push_back(link); });
    std::sort(known.begin(), known.end());
    if (!std::ranges::includes(known, least[c])) throw std::logic_error("octree: a cell misses a link that crosses it");
    if (!std::ranges::includes(most[c], known)) throw std::logic_error("octree: a cell knows a link that passes it by");
  }
}

/// Where the object is, and nowhere else, cells are subdivided.
void Octree::validateCells() const {
  std::vector<std::pair<std::uint32_t, Place>> open{{0, root_}};
  std::size_t count = 1;
  while (!open.empty()) {
    const auto [cell, place] = open.back();
    open.pop_back();
    const std::uint32_t first = cells_[cell].firstChild;
    if ((first != 0) != (place.depth < deepest_ && !touching(place, object_).empty()))
      throw std::logic_error("octree: cells are subdivided where the object is, and only there");
    if (first == 0) continue;
    count += 8;
    for (std::uint32_t i = 0; i < 8; ++i) open.emplace_back(first + i, place.child(i));
  }
  if (count != cells()) throw std::logic_error("octree: cells that are not in the tree");
}

}  // namespace deltalux::paper
