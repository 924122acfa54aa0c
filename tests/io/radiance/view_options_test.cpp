#include "io/radiance/view_options.hpp"

#include <gtest/gtest.h>

namespace deltalux::io::radiance {
namespace {

TEST(ViewOptions, ReadsWhatRvuPrints) {
  const View view = parseView(" -vtl -vp 1 2 3 -vd 0 0 -1 -vu 0 1 0 -vh 4 -vv 3 -vs 0 -vl 0 -vo 0 -va 0", {});
  EXPECT_EQ(view.kind, View::Kind::Parallel);
  EXPECT_EQ(view.position, Vec3(1, 2, 3));
  EXPECT_EQ(view.direction, Vec3(0, 0, -1));
  EXPECT_EQ(view.up, Vec3(0, 1, 0));
  EXPECT_EQ(view.horizontal, 4);
  EXPECT_EQ(view.vertical, 3);
}

TEST(ViewOptions, RefusesWhatItCannotShow) {
  for (const char* options : {"-vth", "-vta", "-vs .5", "-vp 1 2", "-vp 1 2 x", "-vd 0 0 1", "-vd 0 0 0", "-vh 0",
                              "-vh 180", "-vf other.vf"}) {
    EXPECT_THROW(parseView(options, {}), InputError) << options;
  }
}

}  // namespace
}  // namespace deltalux::io::radiance
