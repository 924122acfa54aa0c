#pragma once
// One ray through a pixel and what came back along it, for a Render Cache: light, the place it belongs to, and what it
// was read from, so that exactly the samples that an edit has made wrong can be told.
#include <array>
#include <cstdint>
#include <deltalux/ids.hpp>
#include <deltalux/math.hpp>
#include <deltalux/units.hpp>
#include <vector>

namespace deltalux {

struct PixelRay {
  Vec3f origin{0.0f}, direction{0.0f, 0.0f, 1.0f};  // unit
  std::uint32_t pixel = 0;                          // who asked for it; comes back with the sample
  std::uint32_t index = 0;                          // which of the pixel's stratified numbers it takes
};

struct PixelSample {
  Rgb radiance{0.0f};     // L towards the eye [W/(sr m2)]
  Vec3f position{0.0f};   // of the first surface; far along the ray where there is none
  Vec3f apparent{0.0f};   // where what is seen in it seems to be: behind flat mirrors and panes the image of what they
                          // show; `position` of all else
  PrimitiveId primitive;  // the first surface; invalid: none
  std::uint32_t pixel = 0;
  std::uint64_t version = 0;  // of the reader that traced it

  /// Where the path went, from the eye on: its corners, the surfaces there, and the patch that light was read from. A
  /// path may part at panes; a corner that reads two patches is there twice.
  static constexpr int kMost = 6;
  static constexpr std::uint8_t kEye = 0xff;
  struct Corner {
    Vec3f position{0.0f};
    PrimitiveId primitive;              // invalid: the path left the scene, on the way there
    std::uint32_t patch = 0xffffffffu;  // none
    std::uint8_t before = kEye;         // the corner that the path came from
  };
  std::uint8_t corners = 0;
  bool noisy = false;    // chance has had a say in where the path went: more rays of the pixel tell more
  bool complete = true;  // all of the path is in `path`; otherwise any change makes the sample stale
  Vec3f eye{0.0f};
  std::array<Corner, kMost> path{};
};

/// What has changed in a solution, and when: a value, which any thread may read.
struct SampleChanges {
  std::uint64_t version = 0;
  std::vector<std::uint64_t> patches;     // by patch: when its light last changed by more than a screen can show
  std::vector<std::uint64_t> primitives;  // when each last moved, or its material or emission changed
  struct Place {
    Box box;
    std::uint64_t version = 0;  // when something came to be there
  };
  std::vector<Place> places;     // ascending by version, few: old ones that lie together are merged
  std::uint64_t background = 0;  // when the light from infinity last changed
  std::uint64_t latest = 0;      // when anything last did
  std::uint64_t since = 0;       // samples older than this are stale: what changed before is no longer known

  /// Whether anything that the sample was read from has changed since.
  bool stale(const PixelSample&) const;
};

}  // namespace deltalux
