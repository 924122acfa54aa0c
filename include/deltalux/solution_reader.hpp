#pragma once
// Reads a solution many times over: what render, probe, meshes and rays have to make ready is made ready once.
#include <deltalux/contributions.hpp>
#include <deltalux/pixel_sample.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution.hpp>
#include <deltalux/solution_mesh.hpp>
#include <memory>
#include <optional>
#include <span>

namespace deltalux {

namespace rendering {
struct ReaderState;
}

/// What a ray meets first.
struct SurfaceHit {
  PrimitiveId primitive;
  bool front = true;
  Vec3 position{0}, normal{0, 0, 1};  // unit, towards where the ray came from
  double distance = 0;
};

class SolutionReader {
 public:
  /// Cost: about a twentieth of a second for ten thousand patches.
  explicit SolutionReader(SolutionView);
  ~SolutionReader();
  SolutionReader(SolutionReader&&) noexcept;
  SolutionReader& operator=(SolutionReader&&) noexcept;

  /// Of irradiance: half a step of eight bits. Less does not show.
  static constexpr float kVisibleStep = 1.0f / 512;

  /// After every step, update or frame of the engine, before anything else is called: the solution has changed.
  /// `tolerance`, a fraction of irradiance (of a tenth of its mean, where there is less): what differs by less from
  /// what was read before is left as that, which is several times as fast while something moves. 0: all is read.
  void refresh(float tolerance = 0.0f);
  /// The number of refreshes so far, from 1.
  std::uint64_t version() const;

  /// The solution as it was at the last refresh. Shares with the snapshot before what did not change.
  SolutionMesh mesh();

  /// What rays meet first; nullopt: nothing.
  std::optional<SurfaceHit> pick(const Vec3& origin, const Vec3& direction) const;
  /// Light along rays, with what each has read (pixel_sample.hpp). Direct light from the mesh: no shadow rays.
  std::vector<PixelSample> trace(std::span<const PixelRay>) const;
  /// What has changed from refresh to refresh: tells which samples are stale.
  std::shared_ptr<const SampleChanges> changes() const;

  /// As deltalux::probe().
  std::vector<ProbeResult> probe(std::span<const ProbePoint>, const ProbeSettings& = {}) const;
  /// Where the light at a point comes from (contributions.hpp).
  Contributions contributions(const ProbePoint&, const ContributionSettings& = {}) const;

  const rendering::ReaderState& state() const { return *state_; }

 private:
  std::unique_ptr<rendering::ReaderState> state_;
};

}  // namespace deltalux
