#include "tracing/embree_handles.hpp"

#include <new>
#include <stdexcept>
#include <string>

namespace deltalux::tracing {

EmbreeDevice makeEmbreeDevice() {
  EmbreeDevice device(rtcNewDevice(nullptr));
  throwEmbreeError(device.get());  // a null device holds the reason why it could not be made
  return device;
}

void throwEmbreeError(RTCDevice device) {
  switch (const RTCError error = rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_OUT_OF_MEMORY:
      throw std::bad_alloc();
    case RTC_ERROR_UNSUPPORTED_CPU:
      throw std::runtime_error("Embree does not support this processor (it needs SSE2)");
    default:
      throw std::runtime_error("Embree failed with its error " + std::to_string(error));
  }
}

}  // namespace deltalux::tracing
