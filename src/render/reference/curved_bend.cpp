#include "render/reference/curved_bend.hpp"

#include <cmath>

namespace deltalux::rendering {

namespace {

void findMirrorTurns(const ReferenceScene& scene, PrimitiveId surface, const Vec3& from, const LightPlace& light,
                     Turns& turns) {
  const Shape& shape = scene.scene()[surface].shape;
  const MirrorPoints points = mirrorPoints(shape, from, light);
  for (int i = 0; i < points.count; ++i) {
    const MirrorPoint& m = points.points[i];
    if (!scene.isConnectableMirror(surface, m.front)) continue;
    const Vec3 d = light.at - m.position;
    Turn& turn = turns.list[turns.count++];
    turn.in = turn.out = m.position, turn.inNormal = turn.outNormal = m.normal;
    turn.after = light.infinite ? kInfinity : glm::length(d);
    turn.onward = light.infinite ? light.at : d / turn.after;
    turn.spread = reflectedSpread(shape, from, m.position, turn.after);
    turn.passed = scene::mirrorReflectance(scene.bsdf(surface, m.front), std::abs(glm::dot(turn.onward, m.normal)));
  }
}

void findBallTurns(const ReferenceScene& scene, const Bend& bend, const Vec3& from, const LightPlace& light,
                   Turns& turns) {
  const auto& ball = std::get<Sphere>(scene.scene()[bend.surface].shape);
  const Dielectric& body = *scene.body(bend.surface);
  const BallPassages passages = ballPassages(ball, body.ior, bend.inner, from, light);
  for (int i = 0; i < passages.count; ++i) {
    const BallPassage& p = passages.list[i];
    Turn& turn = turns.list[turns.count++];
    turn.in = p.entry, turn.inNormal = (p.entry - ball.center) / ball.radius;
    turn.out = p.exit, turn.outNormal = (p.exit - ball.center) / ball.radius;
    for (int k = 0; k < bend.inner; ++k) turn.inner[k] = p.corners[k];
    turn.innerCount = bend.inner;
    turn.onward = p.direction;
    turn.after = light.infinite ? kInfinity : glm::length(light.at - p.exit);
    turn.spread = passageSpread(ball, body.ior, bend.inner, from, p, turn.after);
    const double F = fresnelDielectric(p.cosIncidence, body.ior);  // the same inside, at the refracted angle
    turn.passed = glm::pow(body.transmission, Rgb(static_cast<float>(p.inside))) *
                  static_cast<float>((1 - F) * (1 - F) * std::pow(F, bend.inner));
  }
}

}  // namespace

Turns findTurns(const ReferenceScene& scene, const Bend& bend, const Vec3& from, const LightPlace& light) {
  Turns turns;
  if (bend.kind == Bend::Kind::Curved) findMirrorTurns(scene, bend.surface, from, light, turns);
  if (bend.kind == Bend::Kind::Ball) findBallTurns(scene, bend, from, light, turns);
  return turns;
}

}  // namespace deltalux::rendering
