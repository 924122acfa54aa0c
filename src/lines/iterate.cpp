#include "lines/iterate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "base/usual_error.hpp"
#include "hierarchy/below.hpp"
#include "hierarchy/outline.hpp"
#include "hierarchy/patch.hpp"

namespace deltalux::lines {

namespace {

constexpr std::size_t kLeafBlock = 1024;  // [task]
/// Most that a leaf's radiosity changes in the last pass, relative.
constexpr double kLeafConverged = deltalux::tuning::kChangeMatters * kUsualError;

/// The faces of a fine mesh that a patch holds, or is part of.
hierarchy::FaceRange facesAround(const hierarchy::Elements& elements, hierarchy::ElementId patch,
                                 const hierarchy::FaceOrder& order) {
  if (elements.hasFaces(patch)) return elements.facesOf(patch);
  return {order.placeOf(elements.domain[patch.index()].triangle), 1};
}

/// Area that a patch of one side and a part of the other have in common, up to a factor.
double commonArea(const hierarchy::Elements& elements, hierarchy::ElementId a, hierarchy::ElementId b,
                  const hierarchy::FaceOrder* order) {
  double area = 1;
  if (order) {
    const hierarchy::FaceRange ra = facesAround(elements, a, *order), rb = facesAround(elements, b, *order);
    const std::uint32_t first = std::max(ra.first, rb.first), end = std::min(ra.first + ra.count, rb.first + rb.count);
    if (first >= end) return 0;
    area = order->area({first, end - first});
  }
  // Of patches of many faces the rectangle is everything.
  const hierarchy::PatchDomain &da = elements.domain[a.index()], &db = elements.domain[b.index()];
  if (elements.at(a).flat && elements.at(b).flat) {
    // Outlines are those of the whole within their rectangles.
    std::vector<Vec2> common(elements.outline(a).begin(), elements.outline(a).end());
    for (const int axis : {0, 1}) {
      common = hierarchy::clipOutline(common, axis, axis == 0 ? db.u0 : db.v0, false);
      common = hierarchy::clipOutline(common, axis, axis == 0 ? db.u1 : db.v1, true);
    }
    return common.size() < 3 ? 0 : area * std::abs(hierarchy::outlineArea(common));
  }
  const double u = std::min(da.u1, db.u1) - std::max(da.u0, db.u0), v = std::min(da.v1, db.v1) - std::max(da.v0, db.v0);
  return u > 0 && v > 0 ? area * u * v : 0;
}

/// Leaves of the other side that lie behind a leaf, by the share of its area that they take.
void addBehind(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves, std::uint32_t leaf,
               std::vector<LeafLight::Behind>& behind) {
  hierarchy::Side side = elements.sideOf(leaves[leaf]);
  side.front = !side.front;
  hierarchy::ElementId other = elements.sides.at(side);
  if (!other.valid() || !elements.receives(other)) return;
  other = hierarchy::surfaceOf(elements, other);
  const hierarchy::FaceOrder* order = elements.hasFaces(other) ? &elements.orderOf(other) : nullptr;
  const std::size_t first = behind.size();
  float all = 0;
  hierarchy::forEachBelow(elements, other, [&](hierarchy::ElementId e) {
    const auto area = static_cast<float>(commonArea(elements, leaves[leaf], e, order));
    if (!(area > 0)) return false;
    if (elements.isLeaf(e)) behind.push_back({leaf, leaves.indexOf[e.index()], area}), all += area;
    return true;
  });
  for (std::size_t i = first; i < behind.size(); ++i) behind[i].share /= all;
}

/// Of leaves in a pass: summed power, and the most relative to what a leaf has.
struct Change {
  RgbSum power{0.0};
  float most = 0;

  Change& operator+=(const Change& other) {
    power += other.power, most = std::max(most, other.most);
    return *this;
  }
};

/// By leaves together, gray.
struct Sent {
  double power = 0, area = 0;

  Sent& operator+=(const Sent& other) {
    power += other.power, area += other.area;
    return *this;
  }
  double mean() const { return area > 0 ? power / area : 0; }
};

/// What all passes to come will change, each less than the last by the same factor.
class PowerToCome {
 public:
  double after(double changed) {
    if (changed < last_) factor_ = changed / last_;
    last_ = changed;
    if (!(changed > 0)) return 0;
    return factor_ < 1 ? changed * factor_ / (1 - factor_) : std::numeric_limits<double>::infinity();
  }

 private:
  double last_ = 0, factor_ = 1;
};

/// Radiosity of a leaf by the irradiance of either side.
Rgb reflected(const LeafLight& light, std::uint32_t i) {
  Rgb B = light.rho[i] * (light.source[i] + light.indirect[i]);
  if (isBlack(light.tau[i])) return B;
  for (const LeafLight::Behind& b : std::ranges::equal_range(light.behind, i, {}, &LeafLight::Behind::leaf))
    B += b.share * light.tau[i] * (light.source[b.other] + light.indirect[b.other]);
  return B;
}

/// Change of a leaf's radiosity, relative to it, or to what would be `negligible` there: light that goes out for good
/// becomes less by the same share in every pass. None of what is too little for the digits of a number.
float relativeChange(const Rgb& before, const Rgb& now, float negligible) {
  const float light = gray(now);
  return light < std::numeric_limits<float>::min() ? 0.0f : gray(glm::abs(now - before)) / std::max(light, negligible);
}

/// Leaves of which the radiosity still changes, however little it is.
std::vector<std::uint32_t> fading(std::span<const Rgb> before, std::span<const Rgb> now) {
  std::vector<std::uint32_t> all;
  for (std::uint32_t i = 0; i < now.size(); ++i)
    if (relativeChange(before[i], now[i], 0) > kLeafConverged) all.push_back(i);
  return all;
}

/// Light by way of others, of which next to nothing is left on these leaves, and that becomes less in every pass: it
/// starts from nothing, so that there is none where none comes.
void putOut(LeafLight& light, std::span<const std::uint32_t> leaves, std::span<Rgb> B) {
  for (const std::uint32_t i : leaves) light.indirect[i] = Rgb(0.0f);
  for (const std::uint32_t i : leaves) B[i] = reflected(light, i);
}

/// Where light is still on its way when the rest has converged, as in dark rooms and on what an edit has moved: passes
/// over those leaves alone; the exchange knows light.B.
void iterateLate(Exchange& exchange, LeafLight& light, std::span<const std::uint32_t> late,
                 std::span<const float> negligible) {
  std::vector<Rgb> own(late.size());
  float most = std::numeric_limits<float>::max();
  for (int pass = 0; pass < kMostPasses && most > kLeafConverged; ++pass) {
    exchange.gatherAmong(late, light.B, light.indirect);
    most = 0;
    for (std::size_t k = 0; k < late.size(); ++k) {
      own[k] = reflected(light, late[k]);
      most = std::max(most, relativeChange(light.B[late[k]], own[k], negligible[late[k]]));
    }
    for (std::size_t k = 0; k < late.size(); ++k) light.B[late[k]] = own[k];
  }
  exchange.gatherAbout(late, light.B, light.indirect);
}

}  // namespace

LeafLight leafLight(const hierarchy::Elements& elements, const hierarchy::LeafTable& leaves) {
  LeafLight light;
  const std::size_t n = leaves.size();
  light.rho.resize(n), light.tau.resize(n);
  light.source.assign(n, Rgb(0.0f)), light.indirect.assign(n, Rgb(0.0f)), light.B.assign(n, Rgb(0.0f));
  for (std::size_t i = 0; i < n; ++i) {
    const hierarchy::ElementLight& r = elements.radiometry[leaves[i].index()];
    light.rho[i] = r.rho, light.tau[i] = r.tau;
    if (!isBlack(r.tau)) addBehind(elements, leaves, static_cast<std::uint32_t>(i), light.behind);
  }
  return light;
}

IterationReport iterate(Exchange& exchange, LeafLight& light, double converged, int most) {
  const std::size_t n = exchange.leaves();
  IterationReport report;
  std::vector<Rgb> next(n);
  parallelFor(n, kLeafBlock, [&](std::size_t i) { next[i] = light.rho[i] + light.tau[i]; });
  exchange.bound(next);
  parallelFor(n, kLeafBlock, [&](std::size_t i) { light.B[i] = reflected(light, static_cast<std::uint32_t>(i)); });
  const Sent sent = parallelSum<Sent>(n, kLeafBlock, [&](std::size_t i) {
    return Sent{double(exchange.area(i)) * gray(light.B[i]), double(exchange.area(i))};
  });
  std::vector<float> negligible(n);  // by leaf: of what it has to begin with, or of next to nothing
  parallelFor(n, kLeafBlock, [&](std::size_t i) {
    negligible[i] = static_cast<float>(converged * std::max<double>(gray(light.B[i]), converged * sent.mean()));
  });
  report.emitted = parallelSum<RgbSum>(n, kLeafBlock, [&](std::size_t i) {
    return double(exchange.area(i)) * RgbSum((light.rho[i] + light.tau[i]) * light.source[i]);
  });
  if (!(gray(report.emitted) > 0)) {  // what is still on its way would take long to be nothing
    std::ranges::fill(light.indirect, Rgb(0.0f)), std::ranges::fill(light.B, Rgb(0.0f));
    return report;
  }
  exchange.gather(light.B, light.indirect);
  PowerToCome toCome;
  std::vector<std::uint32_t> late;  // in the end, in the order in which they turned out to be
  std::vector<char> isLate(n, false);
  while (true) {
    std::vector<std::vector<std::uint32_t>> lateOf((n + kLeafBlock - 1) / kLeafBlock);
    const Change change = parallelSum<Change>(n, kLeafBlock, [&](std::size_t i) {
      next[i] = reflected(light, static_cast<std::uint32_t>(i));
      const float relative = relativeChange(light.B[i], next[i], negligible[i]);
      if (relative > kLeafConverged) lateOf[i / kLeafBlock].push_back(static_cast<std::uint32_t>(i));
      return Change{double(exchange.area(i)) * RgbSum(glm::abs(next[i] - light.B[i])), relative};
    });
    ++report.passes;
    report.residual = change.power, report.change = change.most;
    const bool power = toCome.after(gray(report.residual)) <= converged * gray(report.emitted),
               leaves = report.change <= kLeafConverged;
    if (report.passes == most) break;
    std::vector<std::uint32_t> more;
    if (power && leaves) {
      more = fading(light.B, next);
      if (more.empty()) break;
      putOut(light, more, next);
      std::ranges::fill(negligible, 0.0f);
    } else if (power) {
      for (const auto& block : lateOf) more.insert(more.end(), block.begin(), block.end());
    }
    for (const std::uint32_t i : more)
      if (!std::exchange(isLate[i], true)) late.push_back(i);
    light.B.swap(next);
    if (power) {
      exchange.send(light.B);  // by what is as good as there
      iterateLate(exchange, light, late, negligible);
    } else {
      exchange.gather(light.B, light.indirect);
    }
  }
  light.B.swap(next);
  return report;
}

}  // namespace deltalux::lines
