#pragma once
// Owning handles of Embree's reference-counted objects, and its errors as exceptions.
#include <embree3/rtcore.h>

#include <memory>

namespace deltalux::tracing {

template <class Handle, void (*release)(Handle)>
struct EmbreeRelease {
  using pointer = Handle;
  void operator()(Handle handle) const { release(handle); }
};
using EmbreeDevice = std::unique_ptr<RTCDevice, EmbreeRelease<RTCDevice, rtcReleaseDevice>>;
using EmbreeScene = std::unique_ptr<RTCScene, EmbreeRelease<RTCScene, rtcReleaseScene>>;
using EmbreeGeometry = std::unique_ptr<RTCGeometry, EmbreeRelease<RTCGeometry, rtcReleaseGeometry>>;

/// Throws std::bad_alloc when Embree ran out of memory, std::runtime_error when it cannot run here.
EmbreeDevice makeEmbreeDevice();
/// The error that this thread's last calls left in the device, thrown as above; nothing when there is none.
void throwEmbreeError(RTCDevice);

}  // namespace deltalux::tracing
