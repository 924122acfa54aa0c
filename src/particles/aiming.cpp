#include "particles/aiming.hpp"

#include <algorithm>
#include <cmath>

#include "base/cosine_direction.hpp"
#include "base/square.hpp"
#include "base/tuning.hpp"
#include "particles/solid_angle_rectangle.hpp"
#include "particles/tuning.hpp"

namespace deltalux::particles {

namespace {

constexpr double kLeeway = 1.05;  // times a sphere's radius: those of curved cells are found by samples [rounding]

bool seenBySolidAngle(const Vec3& from, const Rectangle& r) {
  const Vec3 toCenter = r.at({0.5, 0.5}) - from;
  const double longest = std::max(r.lengthA, r.lengthB), height = std::abs(glm::dot(toCenter, r.normal()));
  const double squared = glm::dot(toCenter, toCenter);
  // Far away area is as good; at a grazing angle the solid angle has lost its digits.
  return squared < square(deltalux::tuning::kFar * longest) && height * r.area() > 1e-7 * squared * std::sqrt(squared);
}

/// 1 - cos of the cone that a sphere fills; 2 from inside.
double coneDepth(const Vec3& toCenter, double radius) {
  const double squared = glm::dot(toCenter, toCenter), r2 = square(radius * (1 + 1e-6));
  if (!(squared > r2)) return 2;
  const double sin2 = r2 / squared;
  return sin2 / (1 + std::sqrt(1 - sin2));
}

bool isBehind(const SendingPoint& y, const BoundingSphere& ball) {
  return glm::dot(ball.center - y.position, y.normal) + kLeeway * std::max(ball.radius, 0.0) <= 0;
}

}  // namespace

std::optional<double> Aiming::behind(const SendingPoint& y, std::uint32_t at) const {
  const BoundingSphere& ball = receivers_.bound(at);
  if (!isBehind(y, ball) || !receivers_.holdsAll(at)) return std::nullopt;
  const Vec3 d = ball.center - y.position;
  return kPi * square(ball.radius) / glm::dot(d, d);
}

void Aiming::aim(const SendingPoint& y, std::uint32_t at, double choice, const Vec2& u, Aim& a) const {
  const RadixNode& node = receivers_.nodes()[at];
  const BoundingSphere& ball = receivers_.bound(at);
  if (ball.empty()) return;
  const bool flat = node.isLeaf() && receivers_.isFlat(node.begin);
  if (flat || glm::distance(y.position, ball.center) > deltalux::tuning::kFar * ball.radius)
    return aimAtCell(y.position, node, choice, u, a);
  if (choice < 0.5) {
    aimAround(y, ball, u, a);
    a.density *= 0.5;
    return;
  }
  aimAtCell(y.position, node, 2 * choice - 1, u, a);
  if (a.density > 0) {
    const double other = densityAround(y, ball, a.direction);
    a.balance = a.density / (a.density + other);  // [Veach97 9.8]
    a.density *= 0.5;
  }
}

void Aiming::aimAtCell(const Vec3& from, const RadixNode& node, double choice, const Vec2& u, Aim& a) const {
  const std::uint32_t cell = node.isLeaf() ? node.begin : receivers_.choose(node, choice);
  if (!(receivers_.area(cell) > 0)) return;
  if (receivers_.isFlat(cell))
    aimAtFlat(from, cell, u, a);
  else
    aimAtCurved(from, cell, u, a);
  if (!node.isLeaf()) a.density *= receivers_.weight(cell) / receivers_.weightOf(node);
}

void Aiming::aimAtFlat(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim& a) const {
  a.cell = cell;
  const Rectangle r = receivers_.rectangle(cell);
  const double height = std::abs(glm::dot(r.corner - from, r.normal()));
  double omega = 0;
  Vec2 at = u;
  if (seenBySolidAngle(from, r)) {
    const SolidAngleRectangle seen(r, from);
    omega = seen.solidAngle();
    at = seen.sample(u);
  }
  const Vec3 x = r.at(at), d = x - from;
  const double distance = glm::length(d);
  if (!(height > 1e-7 * distance) || !(distance > 0)) return;  // edge on
  a.direction = d / distance, a.distance = distance;
  a.density = omega > 0 ? 1 / omega : distance * distance * distance / (r.area() * height);
  const auto point = receivers_.flatPoint(cell, x);
  if (!point) return;
  a.kind = Aim::Kind::Target;
  a.target = x, a.normal = point->normal;
}

void Aiming::aimAtCurved(const Vec3& from, std::uint32_t cell, const Vec2& u, Aim& a) const {
  a.cell = cell;
  const ReceiverPoint x = receivers_.curvedPoint(cell, u);
  const Vec3 d = x.position - from;
  const double distance = glm::length(d);
  if (!(distance > 0)) return;
  a.direction = d / distance, a.distance = distance;
  const double cosine = std::abs(glm::dot(a.direction, x.normal));
  if (!(cosine > 0)) return;
  a.density = distance * distance / (receivers_.area(cell) * cosine);
  if (hidesItself(cell, x.position, -a.direction, &from)) return;
  a.kind = Aim::Kind::Target;
  a.target = x.position, a.normal = x.normal;
}

double Aiming::densityAtCell(const Vec3& from, const RadixNode& node, std::uint32_t cell, const Vec3& at,
                             const Vec3& normal) const {
  const double chance = node.isLeaf() ? 1.0 : receivers_.weight(cell) / receivers_.weightOf(node);
  const Vec3 d = at - from;
  const double squared = glm::dot(d, d), distance = std::sqrt(squared);
  if (receivers_.isFlat(cell)) {
    const Rectangle r = receivers_.rectangle(cell);
    const double height = std::abs(glm::dot(r.corner - from, r.normal()));
    if (!(height > 1e-7 * distance)) return 0;
    if (seenBySolidAngle(from, r)) return chance / SolidAngleRectangle(r, from).solidAngle();
    return chance * squared * distance / (r.area() * height);
  }
  const double cosine = std::abs(glm::dot(d, normal)) / distance;
  return cosine > 0 ? chance * squared / (receivers_.area(cell) * cosine) : 0.0;
}

void Aiming::aimAround(const SendingPoint& y, const BoundingSphere& ball, const Vec2& u, Aim& a) const {
  a.kind = Aim::Kind::Open;
  const Vec3 toCenter = ball.center - y.position;
  const double depth = coneDepth(toCenter, ball.radius);
  if (2 * kPi * depth > kPi && y.lambertian) {  // nowhere denser than by cosines
    a.direction = cosineDirection(Frame(y.normal), u.x, u.y);
  } else {
    const double down = u.x * depth, r = std::sqrt(std::max(0.0, down * (2 - down)));
    const double length = glm::length(toCenter);
    const Vec3 axis = length > 0 ? toCenter / length : Vec3(0, 0, 1);
    a.direction = Frame(axis).toWorld(Vec3(r * onUnitCircle(u.y), 1 - down));
  }
  a.density = densityAround(y, ball, a.direction);
}

double Aiming::densityAround(const SendingPoint& y, const BoundingSphere& ball, const Vec3& direction) const {
  const Vec3 toCenter = ball.center - y.position;
  const double depth = coneDepth(toCenter, ball.radius), omega = 2 * kPi * depth;
  if (omega > kPi && y.lambertian) {
    // Whether all of the node is in its ball (behind()) must not decide where a path goes.
    if (isBehind(y, ball)) return 0;
    return std::max(0.0, glm::dot(direction, y.normal)) / kPi;
  }
  // What an edit has moved away from its neighbours may be outside.
  const bool inCone = glm::dot(direction, toCenter) >= (1 - depth - 1e-9) * glm::length(toCenter);
  return inCone ? 1 / omega : 0;
}

bool Aiming::hidesItself(std::uint32_t cell, const Vec3& position, const Vec3& towardsLight, const Vec3* from) const {
  const Primitive& p = scene_[receivers_.primitive(cell)];
  const auto* ball = std::get_if<Sphere>(&p.shape);
  if (!ball || passesStraight(scene_[p.material])) return false;
  if (from && glm::distance(*from, ball->center) <= ball->radius) return false;
  return glm::dot(position - ball->center, towardsLight) < 0;
}

}  // namespace deltalux::particles
