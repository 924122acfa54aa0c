#include "hierarchy/outline.hpp"

#include <cmath>

namespace deltalux::hierarchy {

namespace {
double cross(const Vec2& a, const Vec2& b) { return a.x * b.y - a.y * b.x; }
}  // namespace

double outlineArea(std::span<const Vec2> p) {
  double twice = 0;
  for (std::size_t i = 2; i < p.size(); ++i) twice += cross(p[i - 1] - p[0], p[i] - p[0]);
  return 0.5 * twice;
}

Vec2 outlineCentroid(std::span<const Vec2> p) {
  double twice = 0;
  Vec2 moment(0.0), mean(0.0);
  for (const Vec2& q : p) mean += q / static_cast<double>(p.size());
  for (std::size_t i = 2; i < p.size(); ++i) {
    const double a = cross(p[i - 1] - p[0], p[i] - p[0]);
    twice += a;
    moment += a / 3.0 * (p[i - 1] + p[i] - 2.0 * p[0]);
  }
  return std::abs(twice) > 1e-300 ? p[0] + moment / twice : mean;
}

bool outlineContains(std::span<const Vec2> p, const Vec2& q) {
  bool inside = false;
  for (std::size_t i = 0, j = p.size() - 1; i < p.size(); j = i++) {
    if ((p[i].y > q.y) != (p[j].y > q.y)) {
      const double x = p[j].x + (q.y - p[j].y) / (p[i].y - p[j].y) * (p[i].x - p[j].x);
      if (q.x < x) inside = !inside;
    }
  }
  return inside;
}

bool outlineFills(std::span<const Vec2> outline, double area) {
  return outline.size() == 4 && std::abs(outlineArea(outline)) > 0.9999 * area;
}

std::vector<Vec2> clipOutline(std::span<const Vec2> p, int axis, double limit, bool below) {
  const double sign = below ? 1.0 : -1.0;
  const auto excess = [&](const Vec2& q) { return sign * (q[axis] - limit); };
  std::vector<Vec2> out;
  out.reserve(p.size() + 2);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vec2 &a = p[i], &b = p[(i + 1) % p.size()];
    const double ea = excess(a), eb = excess(b);
    if (ea <= 0) out.push_back(a);
    if ((ea < 0 && eb > 0) || (ea > 0 && eb < 0)) {
      Vec2 q = a + ea / (ea - eb) * (b - a);
      q[axis] = limit;
      out.push_back(q);
    }
  }
  return out;
}

}  // namespace deltalux::hierarchy
