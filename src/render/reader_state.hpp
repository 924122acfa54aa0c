#pragma once
// What a SolutionReader has ready: the reconstruction of the solution as it is, paths from the eye over it, and the
// snapshots and changes that it has told of so far.
#include <deltalux/solution_mesh.hpp>
#include <deltalux/solution_reader.hpp>
#include <memory>
#include <mutex>

#include "render/eye_path.hpp"
#include "render/light_meter.hpp"
#include "render/reconstruction.hpp"
#include "render/sample_changes.hpp"
#include "render/solution_mesh/mesher.hpp"
#include "solution/solution.hpp"

namespace deltalux::rendering {

struct ReaderState {
  explicit ReaderState(SolutionView v) : view(std::move(v)) {}

  SolutionView view;
  std::uint64_t version = 0;
  std::unique_ptr<Reconstruction> reconstruction;  // of the last refresh
  SolutionMesher mesher;
  SolutionMesh snapshot;  // the one that was asked for last
  std::mutex meterMaking;
  std::unique_ptr<const LightMeter> meter;  // made when first asked for
  std::shared_ptr<const SampleChanges> changes;
  NotedSolution noted;  // what `changes` are differences from

  const Solution& solution() const { return view.get(); }
  /// Made when first asked for, once a refresh.
  const LightMeter& lightMeter() {
    const std::lock_guard lock(meterMaking);
    if (!meter) meter = std::make_unique<const LightMeter>(solution(), *reconstruction);
    return *meter;
  }
};

/// Notes what differs from what was noted before (sample_changes.cpp).
std::shared_ptr<const SampleChanges> noteChanges(ReaderState&, const SampleChanges* before);

}  // namespace deltalux::rendering
