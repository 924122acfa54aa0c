#include "paper/link_news.hpp"

#include <cmath>

#include "paper/visibility.hpp"

namespace deltalux::paper {

namespace {

constexpr float kSameKernel = 2.0f;  // factors within which rays are still well shared out
constexpr float kMoreOpen = 6.0f;    // the same of openness, upwards

}  // namespace

bool sameTransfer(const hierarchy::Link& before, const hierarchy::Link& after, float sameKernel) {
  return std::abs(before.K - after.K) <= sameKernel * before.K && before.V == after.V &&
         before.visibility == after.visibility &&
         (before.state == hierarchy::LinkState::Averted) == (after.state == hierarchy::LinkState::Averted);
}

bool hiddenAsBefore(const hierarchy::Link& before, const hierarchy::Link& after) {
  return (before.visibility == hierarchy::Visibility::Blocked || before.hidden == hierarchy::Link::kHidden) &&
         after.unseen();
}

bool samePlan(const hierarchy::Link& before, const hierarchy::Link& after) {
  // What was proven clear was sampled by no ray, what was proven blocked or averted not at all.
  if (before.visibility == hierarchy::Visibility::Clear && after.visibility != hierarchy::Visibility::Clear)
    return false;
  if (!after.carries()) return true;
  if (!before.carries() || before.visibility != after.visibility) return false;
  if (!(after.K <= kSameKernel * before.K && before.K <= kSameKernel * after.K)) return false;
  if (before.fromLight) return true;  // every light in sight gets rays
  // Where less passes, some rays are spent in vain: no noise comes of it.
  return openness(after) <= kMoreOpen * openness(before);
}

}  // namespace deltalux::paper
