#pragma once
// A light meter in free space: paths from the point, as the reference integrator's, that end where they meet diffuse
// surfaces, whose light the solution knows. What suns and lamps send by way of mirrors, panes and glass is connected to
// and not left to luck (light_connections.hpp). Cost: a table of connections for the scene, once; 1 to 2 microseconds a
// path.
#include <deltalux/render.hpp>

#include "render/eye_path.hpp"
#include "render/reference/path_tracer.hpp"

namespace deltalux::rendering {

class SpaceMeter {
 public:
  /// Both must outlive this. `paths`: how the solution is read.
  SpaceMeter(const Solution&, const EyePaths& paths);
  /// Of a scene with other lights than the solution's, whose surfaces send what the solution has.
  SpaceMeter(const Scene&, bool diffuseOnly, std::shared_ptr<const tracing::RayTracer>, const EyePaths& paths);

  /// Irradiance at a point, to the error that the settings ask for.
  ProbeResult at(const ProbePoint&, const ProbeSettings&, std::uint64_t key) const;

 private:
  ReferenceScene scene_;
  LightConnections connections_;
  ConnectionTable table_;
  PathTracer tracer_;
};

}  // namespace deltalux::rendering
