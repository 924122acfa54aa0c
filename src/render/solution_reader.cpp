#include <deltalux/solution_reader.hpp>

#include "base/check.hpp"
#include "render/reader_state.hpp"

namespace deltalux {

SolutionReader::SolutionReader(SolutionView view) : state_(std::make_unique<rendering::ReaderState>(std::move(view))) {
  refresh();
}
SolutionReader::~SolutionReader() = default;
SolutionReader::SolutionReader(SolutionReader&&) noexcept = default;
SolutionReader& SolutionReader::operator=(SolutionReader&&) noexcept = default;

void SolutionReader::refresh(float tolerance) {
  rendering::ReaderState& s = *state_;
  ++s.version;
  s.meter.reset();
  s.reconstruction = std::make_unique<rendering::Reconstruction>(s.solution(), s.reconstruction.get(), tolerance);
  s.changes = rendering::noteChanges(s, s.changes.get());
}

std::uint64_t SolutionReader::version() const { return state_->version; }
std::shared_ptr<const SampleChanges> SolutionReader::changes() const { return state_->changes; }

SolutionMesh SolutionReader::mesh() {
  rendering::ReaderState& s = *state_;
  if (s.snapshot.version != s.version)
    s.snapshot = s.mesher.snapshot(s.solution(), *s.reconstruction, s.snapshot, s.version);
  return s.snapshot;
}

std::optional<SurfaceHit> SolutionReader::pick(const Vec3& origin, const Vec3& direction) const {
  tracing::Ray ray;
  ray.origin = Vec3f(origin), ray.direction = Vec3f(glm::normalize(direction));
  const tracing::Hit hit = state_->solution().tracer->closestHit(ray);
  if (!hit) return std::nullopt;
  return SurfaceHit{hit.primitive, hit.front, Vec3(hit.position), Vec3(hit.front ? hit.normal : -hit.normal),
                    double(hit.t)};
}

std::vector<ProbeResult> SolutionReader::probe(std::span<const ProbePoint> points,
                                               const ProbeSettings& settings) const {
  DELTALUX_CHECK(settings.error > 0 && settings.error < 1, "the error is a fraction between 0 and 1");
  return rendering::measureAll(state_->lightMeter(), points, settings, nullptr);
}

}  // namespace deltalux
