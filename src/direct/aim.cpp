#include "direct/aim.hpp"

#include <algorithm>

#include "base/batch_mean.hpp"
#include "base/tuning.hpp"
#include "direct/tuning.hpp"

namespace deltalux::direct {

namespace {
/// Of the variance within the quarters of a square, what that between them exceeds by chance in one case of twenty: the
/// F distribution of three degrees of freedom, by many.
constexpr double kUneven = 2.605;  // [defined]
/// As many as there may be two in each quarter, which is what a variance within them takes.
constexpr std::size_t kFewestLooks = 8;  // [defined]
}  // namespace

Aim::Aim(std::span<const Source> sources) {
  squares_.reserve(sources.size());
  for (const Source& s : sources) {
    const float strength = s.potential * std::sqrt(s.open);
    squares_.push_back({s.id, Vec2(0.0), 1.0, s.potential, strength, strength, strength});
  }
  share();
}

Aim Aim::of(std::span<const Source> places) const {
  Aim own;
  auto s = places.begin();
  for (const Square& square : squares_) {
    while (s != places.end() && s->id < square.source) ++s;
    if (s == places.end()) break;
    if (s->id != square.source) continue;
    Square& q = own.squares_.emplace_back(square);
    q.strength *= s->potential / q.potential;
    q.guess = q.strength, q.potential = s->potential;
  }
  own.share();
  return own;
}

Aim Aim::at(std::span<const Source> place, float light, int rays) const {
  Aim own = of(place);
  own.rays_ = rays;
  if (!own.dark()) own.keepFromSpecks(light, rays);
  return own;
}

bool Aim::holds(std::span<const Source> sources) const {
  auto q = squares_.begin();
  for (const Source& s : sources) {
    while (q != squares_.end() && q->source < s.id) ++q;
    if (q == squares_.end() || q->source != s.id) return false;
  }
  return true;
}

/// More rays, of about `rays` now and up to as many again, so that none brings more than a few times `light`.
void Aim::keepFromSpecks(float light, int rays) {
  const float before = total(), each = before / static_cast<float>(rays);
  const float least = each / (deltalux::tuning::kFewRays * std::max(light, 1e-20f));
  const auto lacks = [&](const Square& q) {
    return std::max(0.0f, std::min(q.potential * least, each / q.area()) - q.weight);
  };
  float lack = 0;
  for (const Square& q : squares_) lack += q.area() * lacks(q);
  const float given = std::min(1.0f, before / std::max(lack, 1e-20f));
  for (Square& q : squares_) q.weight += given * lacks(q);
  sumWeights();
  rays_ = static_cast<int>(std::lround(total() / each + 0.499f));
}

/// Weights as the strengths have it, but for a light that outshines the rest: it is known by few rays, and where it is
/// hidden the others need theirs.
void Aim::share() {
  float all = 0;
  Square* brightest = nullptr;
  for (Square& s : squares_) {
    s.weight = s.strength, all += s.share();
    if (!brightest || s.share() > brightest->share()) brightest = &s;
  }
  if (brightest) {
    const float own = brightest->share(), others = all - own;
    if (others > 0 && own > others) brightest->weight *= others / own;
  }
  sumWeights();
}

void Aim::sumWeights() {
  cumulative_.clear();
  cumulative_.reserve(squares_.size());
  float sum = 0;
  for (const Square& s : squares_) cumulative_.push_back(sum += s.area() * s.weight);
}

std::size_t Aim::indexAt(float part) const {
  const auto it = std::upper_bound(cumulative_.begin(), cumulative_.end() - 1, part * total());
  return static_cast<std::size_t>(it - cumulative_.begin());
}

void Aim::learn(const PointSampler& light, std::span<const Receiver> places, int rays, std::uint64_t key) {
  std::vector<Look> looks;
  for (int round = 0; round < deltalux::tuning::kEverCloser && !dark(); ++round) {
    look(light, places, rays / deltalux::tuning::kEverCloser, combineKeys(key, static_cast<std::uint64_t>(round)),
         looks);
    evaluate(looks);
  }
}

void Aim::look(const PointSampler& light, std::span<const Receiver> places, int rays, std::uint64_t key,
               std::vector<Look>& looks) const {
  const double shift = toUnit(mix64(key));
  const ScrambledSobol numbers(combineKeys(key, 1)), choices(combineKeys(key, 2));
  for (int k = 0; k < rays; ++k) {
    const std::size_t index = indexAt(static_cast<float>((k + shift) / rays));
    const Square& square = squares_[index];
    const auto i = static_cast<std::uint32_t>(k);
    const Vec2 u = square.at(numbers(i));
    const Receiver& x = places[static_cast<std::size_t>(choices(i).x * double(places.size()))];
    const auto arrival = light.arrival(square.source, x, u);
    const float E = arrival ? static_cast<float>(glm::dot(arrival->direction, x.normal)) * gray(arrival->E) : 0.0f;
    looks.push_back({static_cast<std::uint32_t>(index), u, E});
  }
}

void Aim::evaluate(std::vector<Look>& looks) {
  std::sort(looks.begin(), looks.end(), [](const Look& a, const Look& b) { return a.square < b.square; });
  std::vector<Square> squares;
  std::vector<Look> kept;
  squares.reserve(squares_.size());
  kept.reserve(looks.size());
  auto at = looks.begin();
  for (std::size_t i = 0; i < squares_.size(); ++i) {
    const auto end = std::find_if(at, looks.end(), [&](const Look& l) { return l.square != i; });
    divide(squares_[i], {at, end}, squares, kept);
    at = end;
  }
  squares_ = std::move(squares), looks = std::move(kept);
  share();
}

/// Whether the quarters bring different light, by more than chance would have it (analysis of variance).
bool Aim::uneven(const Square& square, std::span<const Look> looks) {
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
void Aim::divide(const Square& square, std::span<Look> looks, std::vector<Square>& squares,
                 std::vector<Look>& kept) const {
  Square now = square;
  float sum = 0;
  for (const Look& l : looks) sum += l.E * l.E;
  now.strength = std::sqrt((sum + tuning::kPrior * square.guess * square.guess) /
                           (static_cast<float>(looks.size()) + tuning::kPrior));
  if (now.share() < deltalux::tuning::kNegligible * total() || !uneven(square, looks)) {
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
    Square part = now;
    part.lower = square.lower + half * Vec2(x, y), part.size = half, part.guess = now.strength;
    divide(part, {first, last}, squares, kept);
  };
  quarter(0, 0, looks.begin(), a), quarter(1, 0, a, upper), quarter(0, 1, upper, b), quarter(1, 1, b, looks.end());
}

std::vector<Source> joined(std::span<const std::vector<Source>> places) {
  std::vector<Source> all;
  for (const std::vector<Source>& place : places) all.insert(all.end(), place.begin(), place.end());
  std::stable_sort(all.begin(), all.end(), [](const Source& a, const Source& b) { return a.id < b.id; });
  std::vector<Source> out;
  for (const Source& s : all) {
    if (out.empty() || out.back().id != s.id)
      out.push_back(s);
    else
      out.back().potential = std::max(out.back().potential, s.potential),
      out.back().open = std::max(out.back().open, s.open);
  }
  return out;
}

ProbeResult measure(const PointSampler& light, std::span<const Source> sources, const Receiver& x, float level,
                    const Rgb& ambient, double error, int maxSamples, std::uint64_t key) {
  ProbeResult result;
  Aim aim(sources);
  aim.learn(light, {&x, 1}, kLearnAtPoint, combineKeys(key, 1));
  aim = aim.at(sources, level / kEstimateRays,
               kEstimateRays);  // no ray may outweigh a whole estimate: few of them would not know
  if (aim.dark()) return result;
  BatchMean mean;
  while (mean.count() < deltalux::tuning::kFewestEstimates || result.samples < static_cast<std::uint64_t>(maxSamples)) {
    RgbSum E(0.0);
    aim.sample(light, x, 0, combineKeys(key, 2 + static_cast<std::uint64_t>(mean.count())),
               [&](const Arrival& a) { E += RgbSum(static_cast<float>(glm::dot(a.direction, x.normal)) * a.E); });
    mean.add(E);
    result.samples += static_cast<std::uint64_t>(aim.rays());
    if (mean.count() >= deltalux::tuning::kFewestEstimates &&
        gray(mean.standardError()) <= error * (gray(mean.mean()) + gray(RgbSum(ambient))))
      break;
  }
  result.irradiance = mean.mean(), result.standardError = mean.standardError();
  return result;
}

}  // namespace deltalux::direct
