#include "lines/follow_line.hpp"

#include "base/tuning.hpp"

namespace deltalux::lines {

namespace {

constexpr int kMostSegments = 64;  // panes included, where surfaces overlap without end [limit]

/// Passes the surface straight on: direction and position stay on the line.
void passStraight(tracing::Ray& ray, const tracing::Hit& hit) {
  ray.origin = tracing::offsetOrigin(hit.position, hit.normal, ray.direction);
}

}  // namespace

LineEnd LineTracer::follow(tracing::Ray ray, tracing::Hit hit, Rng random, std::vector<LineSegment>* way) const {
  LineEnd end;
  const Dielectric* medium = nullptr;
  float passed = 0;  // length of straight passages before the first other surface
  int events = 0;
  for (int segment = 0; segment < kMostSegments; ++segment) {
    if (segment > 0) hit = tracer_.closestHit(ray);
    if (way) way->push_back({ray.origin, ray.direction, hit ? hit.t : std::numeric_limits<float>::infinity()});
    if (!hit) {
      end.termination = LineTermination::Escaped;
      return end;
    }
    const SurfaceResponse& surface = responses_.at(hit.primitive, hit.front);
    if (medium) {
      const Rgb before = end.weight;
      end.weight *= glm::pow(medium->transmission, Rgb(hit.t)), end.dimmed = true;
      end.absorbed += before - end.weight;
    }
    const Vec3 outward = hit.front ? Vec3(hit.normal) : -Vec3(hit.normal);
    const double cosine = std::min(1.0, -glm::dot(outward, Vec3(ray.direction)));
    if (!(cosine > 0)) return end;

    if (segment == 0) end.met = surface.ends > 0;
    float passes = surface.passes;
    Rgb passage = surface.passage, mirror(0.0f);
    if (surface.pane) {
      passage = scene::passageTransmittance(surface.specular, cosine);
      mirror = scene::mirrorReflectance(surface.specular, cosine);
      const float both = gray(passage) + gray(mirror);
      if (!(both > 0)) return end;
      passes = gray(passage) / both;
      end.absorbed += end.weight * (Rgb(1.0f) - passage - mirror);
    } else if (surface.ends <= 0 && !surface.body) {
      end.absorbed += end.weight * (Rgb(1.0f) - surface.passage - surface.specular.reflection.reflectance -
                                    surface.specular.transmission.reflectance);
    }
    const bool last = events >= deltalux::tuning::kRouletteFrom;
    const double choice = surface.ends >= 1 ? 0.0 : random.uniform();
    if (choice < surface.ends) {
      if (!end.turned) end.distance = passed + hit.t;
      end.termination = LineTermination::Ended;
      end.side = {hit.primitive, hit.triangle, hit.front}, end.position = hit.position, end.normal = Vec3f(outward);
      return end;
    }
    if (choice < surface.ends + passes) {
      end.weight *= passage / passes, end.dimmed = true;
      if (!end.turned) passed += hit.t, end.chance *= passes;
      if (isBlack(end.weight)) return end;
      passStraight(ray, hit);
      continue;
    }
    if (last) {
      end.absorbed += end.weight;
      return end;
    }
    if (!end.turned) end.distance = passed + hit.t, end.straight = static_cast<std::uint32_t>(segment) + 1;
    const float onward = 1 - surface.ends - passes;
    const Frame frame(outward);
    const Vec3 wo = frame.toLocal(-Vec3(ray.direction));
    Vec3 wi(-wo.x, -wo.y, wo.z);
    if (surface.pane) {
      end.weight *= mirror / onward;
    } else {
      const double u = random.uniform(), v = random.uniform(), w = random.uniform();
      const auto s = scene::sample(surface.specular, wo, {u, v, w});
      // What facets of a rough lobe send below the surface is lost to it.
      if (!surface.body)
        end.absorbed += end.weight *
                        (surface.specular.reflection.reflectance + surface.specular.transmission.reflectance -
                         (s ? s->weight : Rgb(0.0f))) /
                        onward;
      if (!s) return end;
      end.weight *= s->weight / onward;
      end.rough = end.rough || !scene::isDirac(s->event);
      if (s->event == scene::ScatterEvent::Refraction) medium = hit.front ? surface.body : nullptr;
      wi = s->direction;
    }
    end.turned = end.dimmed = true;
    ++events;
    if (isBlack(end.weight)) return end;
    ray.direction = Vec3f(glm::normalize(frame.toWorld(wi)));
    ray.origin = tracing::offsetOrigin(hit.position, hit.normal, ray.direction);
  }
  return end;
}

}  // namespace deltalux::lines
