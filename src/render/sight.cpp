#include "render/sight.hpp"

#include <algorithm>
#include <array>

#include "base/morton.hpp"

namespace deltalux::rendering {

namespace {

constexpr float kUnseenShare = 0.25f;    // of the rays to begin with, to what no test ray of the leaf saw
constexpr float kMostShare = 0.25f;      // of the rays, to one square
constexpr int kRounds = 3;               // of learning: each looks where the one before saw light
constexpr float kDoubt = 0.5f;           // rays that what was thought before counts for
constexpr std::size_t kFewestLooks = 6;  // in a square, to divide it
constexpr double kUneven = 3;            // variance between quarters over that within, to divide
constexpr double kSmallest = 1.0 / 64;   // side of a square
constexpr float kFaintShare = 1e-3f;     // of all rays: squares that get fewer stay whole
constexpr int kFewestRays = 256;         // to learn from
constexpr int kFewestAround = 2048;      // the same, for all of a part of a picture
constexpr int kAroundShare = 2;          // rays of all sides over those that the whole part learns from

/// Senders side by side stand side by side; cells of a sky along a curve that fills it.
std::pair<std::uint32_t, std::uint64_t> placeInOrder(const hierarchy::Elements& elements, hierarchy::ElementId e) {
  if (!elements.isDistant(e)) return {0, e.value};
  const hierarchy::PatchDomain& d = elements.domain[e.index()];
  const auto bits = [](float x) { return static_cast<std::uint32_t>(static_cast<double>(x) * 0x1p30); };
  return {1 + elements.light[e.index()].value, morton(bits(d.u0), bits(d.v0))};
}

}  // namespace

Sight::Sight(const hierarchy::Elements& elements, const radiosity::SenderChoice& choice)
    : Sight(elements, std::array{&choice}) {}

Sight::Sight(const hierarchy::Elements& elements, std::span<const radiosity::SenderChoice* const> choices) {
  const auto add = [&](const radiosity::SenderList& list, float scale) {
    for (std::size_t i = 0; i < list.senders.size(); ++i) {
      const float share = scale * (list.cumulative[i] - (i > 0 ? list.cumulative[i - 1] : 0.0f));
      if (share > 0) squares_.push_back({list.senders[i], Vec2(0.0), 1.0, share, share});
    }
  };
  for (const radiosity::SenderChoice* choice : choices) {
    add(choice->seen, 1.0f);
    const float seen = choice->seen.total(), unseen = choice->unseen.total();
    add(choice->unseen, seen > 0 && unseen > 0 ? kUnseenShare / (1 - kUnseenShare) * seen / unseen : 1.0f);
  }
  std::sort(squares_.begin(), squares_.end(), [&](const Square& a, const Square& b) {
    if (a.sender == b.sender) return a.guess > b.guess;
    return placeInOrder(elements, a.sender) < placeInOrder(elements, b.sender);
  });
  const auto same = [](const Square& a, const Square& b) { return a.sender == b.sender; };
  squares_.erase(std::unique(squares_.begin(), squares_.end(), same), squares_.end());
  sumShares();
}

Sight Sight::of(const radiosity::SenderChoice& choice) const {
  std::vector<hierarchy::ElementId> senders = choice.seen.senders;
  senders.insert(senders.end(), choice.unseen.senders.begin(), choice.unseen.senders.end());
  std::sort(senders.begin(), senders.end());
  Sight part;
  for (const Square& s : squares_)
    if (std::binary_search(senders.begin(), senders.end(), s.sender)) part.squares_.push_back(s);
  part.sumShares();
  return part;
}

/// A light that outshines the rest is known by few rays: where it is hidden the others need theirs.
void Sight::limitBrightest() {
  const auto brightest = std::max_element(squares_.begin(), squares_.end(),
                                          [](const Square& a, const Square& b) { return a.share() < b.share(); });
  float rest = 0;
  for (auto s = squares_.begin(); s != squares_.end(); ++s)
    if (s != brightest) rest += s->share();
  if (rest > 0 && brightest->share() > kMostShare / (1 - kMostShare) * rest)
    brightest->strength = kMostShare / (1 - kMostShare) * rest / static_cast<float>(brightest->size * brightest->size);
}

void Sight::sumShares() {
  limitBrightest();
  cumulative_.clear();
  float sum = 0;
  for (const Square& s : squares_) cumulative_.push_back(sum += s.share());
}

std::size_t Sight::indexAt(float part) const {
  const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, part * total());
  return static_cast<std::size_t>(it - cumulative_.begin());
}

void Sight::learn(const radiosity::DirectLight& direct, std::span<const radiosity::Receiver> places, int rays,
                  std::uint64_t key) {
  std::vector<Look> looks;
  for (int round = 0; round < kRounds && !dark(); ++round) {
    look(direct, places, rays / kRounds, combineKeys(key, round), looks);
    judge(looks);
  }
}

void Sight::look(const radiosity::DirectLight& direct, std::span<const radiosity::Receiver> places, int rays,
                 std::uint64_t key, std::vector<Look>& looks) const {
  const double shift = toUnit(mix64(key));
  for (int k = 0; k < rays; ++k) {
    const std::size_t index = indexAt(static_cast<float>((k + shift) / rays));
    const Square& square = squares_[index];
    const auto i = static_cast<std::uint32_t>(k);
    const Vec2 u = square.at(scrambledSobol(i, combineKeys(key, 1)));
    const radiosity::Receiver& x =
        places[static_cast<std::size_t>(scrambledSobol(i, combineKeys(key, 2)).x * double(places.size()))];
    const auto arrival = direct.arrival(square.sender, x, u);
    const float E = arrival ? static_cast<float>(glm::dot(arrival->direction, x.normal)) * gray(arrival->E) : 0.0f;
    looks.push_back({static_cast<std::uint32_t>(index), u, E});
  }
}

void Sight::judge(std::vector<Look>& looks) {
  std::sort(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.square < b.square; });
  std::vector<Square> squares;
  std::vector<Look> kept;
  kept.reserve(looks.size());
  auto at = looks.begin();
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    const auto end = std::find_if(at, looks.end(), [&](const Look& l) { return l.square != i; });
    divide(squares_[i], {at, end}, squares, kept);
    at = end;
  }
  squares_ = std::move(squares), looks = std::move(kept);
  sumShares();
}

/// Whether the quarters bring different light, by more than chance would have it (analysis of variance).
bool Sight::uneven(const Square& square, std::span<const Look> looks) {
  if (looks.size() < kFewestLooks) return false;
  const Vec2 middle = square.lower + square.size / 2;
  double n[4] = {}, sum[4] = {}, squares = 0;
  for (const Look& l : looks) {
    const std::size_t q = (l.u.x < middle.x ? 0u : 1u) + (l.u.y < middle.y ? 0u : 2u);
    n[q] += 1, sum[q] += l.E, squares += double(l.E) * double(l.E);
  }
  double all = 0, between = 0, groups = 0;
  for (int q = 0; q < 4; ++q) {
    if (!(n[q] > 0)) continue;
    all += sum[q], between += sum[q] * sum[q] / n[q], groups += 1;
  }
  const double count = static_cast<double>(looks.size()), within = squares - between;
  between -= all * all / count;
  return between / std::max(groups - 1, 1.0) > kUneven * within / (count - groups) && between > 1e-6 * squares;
}

/// Appends the square as `looks` have it, or its quarters.
void Sight::divide(const Square& square, std::span<Look> looks, std::vector<Square>& squares,
                   std::vector<Look>& kept) const {
  float sum = 0;
  for (const Look& l : looks) sum += l.E * l.E;
  Square now = square;
  now.strength = std::sqrt((sum + kDoubt * square.guess * square.guess) / (static_cast<float>(looks.size()) + kDoubt));
  if (square.size <= kSmallest || now.share() < kFaintShare * total() || !uneven(square, looks)) {
    for (const Look& l : looks) kept.push_back({static_cast<std::uint32_t>(squares.size()), l.u, l.E});
    squares.push_back(now);
    return;
  }
  const double half = square.size / 2;
  const Vec2 middle = square.lower + half;
  const auto upper = std::partition(looks.begin(), looks.end(), [&](const Look& l) { return l.u.y < middle.y; });
  const auto left = [&](const Look& l) { return l.u.x < middle.x; };
  const auto a = std::partition(looks.begin(), upper, left), b = std::partition(upper, looks.end(), left);
  const auto quarter = [&](double x, double y, auto first, auto last) {
    divide({square.sender, square.lower + half * Vec2(x, y), half, now.strength, now.strength}, {first, last}, squares,
           kept);
  };
  quarter(0, 0, looks.begin(), a), quarter(1, 0, a, upper), quarter(0, 1, upper, b), quarter(1, 1, b, looks.end());
}

/// Alike for all leaves of it.
std::uint64_t Sights::sideOf(hierarchy::ElementId leaf) const {
  return 2 * std::uint64_t(elements_.domain[leaf.index()].primitive.value) + (elements_.at(leaf).front ? 1 : 0);
}

void Sights::learn(int raysOfPlace, int rays, std::uint64_t key) {
  std::stable_sort(places_.begin(), places_.end(), [&](const Place& a, const Place& b) {
    return std::pair(sideOf(a.leaf), a.leaf) < std::pair(sideOf(b.leaf), b.leaf);
  });
  if (reconstruction_.points) learnOverLines(raysOfPlace, rays, key);
  for (auto first = places_.begin(); first != places_.end() && !reconstruction_.points;) {
    const std::uint64_t side = sideOf(first->leaf);
    const auto last = std::find_if(first, places_.end(), [&](const Place& p) { return sideOf(p.leaf) != side; });
    const int learning = std::max(kFewestRays, raysOfPlace * static_cast<int>(last - first));
    learn({first, last}, learning, combineKeys(key, side));
    first = last;
  }
  places_ = {};
}

void Sights::learn(std::span<const Place> ofSide, int learning, std::uint64_t key) {
  std::vector<hierarchy::ElementId> leaves;
  std::vector<const radiosity::SenderChoice*> choices;
  std::vector<radiosity::Receiver> places;
  for (const Place& p : ofSide) {
    places.push_back(p.at);
    if (!leaves.empty() && leaves.back() == p.leaf) continue;
    leaves.push_back(p.leaf), choices.push_back(&reconstruction_.choices.at(p.leaf));
  }
  Sight all(elements_, choices);
  all.learn(reconstruction_.direct, places, learning, key);
  for (std::size_t i = 0; i < leaves.size(); ++i) known_.emplace(leaves[i], all.of(*choices[i]));
}

void Sights::learnOverLines(int raysOfPlace, int rays, std::uint64_t key) {
  if (places_.empty()) return;
  const PointSources& points = *reconstruction_.points;
  std::vector<direct::Receiver> receivers;
  std::vector<std::size_t> first;  // place of each leaf, and of the end
  std::vector<std::vector<direct::Source>> sources;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    receivers.push_back({places_[i].at.position, places_[i].at.normal});
    if (i > 0 && places_[i].leaf == places_[i - 1].leaf) continue;
    first.push_back(i), sources.push_back(points.at(places_[i].leaf));
  }
  first.push_back(places_.size());
  const int shared = std::max(kFewestAround, raysOfPlace * static_cast<int>(places_.size()) / kAroundShare);
  around_ = direct::Aim(direct::joined(sources));
  around_.learn(points.light(), receivers, shared, key);
  for (std::size_t begin = 0, end = 0; begin < sources.size(); begin = end) {
    const std::uint64_t side = sideOf(places_[first[begin]].leaf);
    for (end = begin + 1; end < sources.size() && sideOf(places_[first[end]].leaf) == side;) ++end;
    const auto own = std::span(receivers).subspan(first[begin], first[end] - first[begin]);
    direct::Aim all = around_.of(direct::joined(std::span(sources).subspan(begin, end - begin)));
    all.learn(points.light(), own, raysOfPlace * static_cast<int>(own.size()), combineKeys(key, side));
    for (std::size_t i = begin; i < end; ++i) {
      const hierarchy::ElementId leaf = places_[first[i]].leaf;
      aims_.emplace(leaf, all.at(sources[i], points.lightAt(leaf), rays));
    }
  }
}

const Sight& Sights::at(hierarchy::ElementId leaf) {
  if (const auto found = known_.find(leaf); found != known_.end()) return found->second;
  return known_.emplace(leaf, Sight(elements_, reconstruction_.choices.at(leaf))).first->second;
}

/// Of a leaf where no place was noted: as what is around it has it.
const direct::Aim& Sights::aimAt(hierarchy::ElementId leaf, int rays) {
  if (const auto found = aims_.find(leaf); found != aims_.end()) return found->second;
  const PointSources& points = *reconstruction_.points;
  const std::vector<direct::Source> sources = points.at(leaf);
  direct::Aim aim = around_.of(sources);
  // Too little of what shines there may be known from around.
  aim = aim.holds(sources) ? aim.at(sources, points.lightAt(leaf), rays) : points.aimAt(leaf, rays);
  return aims_.emplace(leaf, std::move(aim)).first->second;
}

}  // namespace deltalux::rendering
