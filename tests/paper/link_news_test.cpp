// What of a link that is judged anew is news to the rows over it.
#include "paper/link_news.hpp"

#include <gtest/gtest.h>

namespace deltalux {
using namespace paper;

namespace {

hierarchy::Link sampled(float V) {
  hierarchy::Link link;
  link.state = hierarchy::LinkState::Active;
  link.visibility = hierarchy::Visibility::Sampled;
  link.K = 0.1f;
  link.V = Rgb(V);
  link.samples = 16, link.sampleMask = 0xffff;
  return link;
}

TEST(LinkNews, RaysStandWhereLessPasses) {
  EXPECT_TRUE(samePlan(sampled(0.9f), sampled(0.7f)));
  EXPECT_TRUE(samePlan(sampled(0.9f), sampled(0.05f)));
}

TEST(LinkNews, TooFewRaysDoNotStandWhereMuchMorePasses) {
  EXPECT_TRUE(samePlan(sampled(0.3f), sampled(0.9f)));
  EXPECT_FALSE(samePlan(sampled(0.05f), sampled(0.9f)));
}

TEST(LinkNews, WhatNeededNoRayNeedsOneWhenItIsNoLongerClear) {
  hierarchy::Link clear = sampled(1.0f);
  clear.visibility = hierarchy::Visibility::Clear;
  EXPECT_FALSE(samePlan(clear, sampled(0.9f)));
}

TEST(LinkNews, RaysDoNotStandWhereTheKernelIsAnother) {
  hierarchy::Link near = sampled(0.9f);
  near.K = 0.4f;
  EXPECT_FALSE(samePlan(sampled(0.9f), near));
  EXPECT_FALSE(samePlan(near, sampled(0.9f)));
}

}  // namespace
}  // namespace deltalux
