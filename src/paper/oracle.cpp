#include "paper/oracle.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "paper/tuning.hpp"

namespace deltalux::paper {

namespace {

/// The sender's strength in the unit that K multiplies, gray: for a cluster the most that it sends towards any part of
/// the receiver, and never less than a share of its mean, since harmonics blur what faces away.
double senderStrength(const hierarchy::Elements& elements, hierarchy::ElementId sender, hierarchy::ElementId receiver) {
  if (!elements.isCluster(sender)) return gray(elements.radiometry[sender.index()].B);
  const hierarchy::DirectionalRgb& intensity = elements.cluster(sender).intensity;
  float most = tuning::kClusterSpread * hierarchy::kConstantHarmonic * std::max(0.0f, gray(intensity.c[0]));
  for (const Vec3f& x : elements.nodes[receiver.index()].position) {
    const Vec3f w = x - elements.shape(sender).center;
    const float length = glm::length(w);
    if (length > 0) most = std::max(most, gray(intensity.at(w / length)));
  }
  return most;
}

/// How far the radiosity of the sender's children departs from the sender's own.
double senderVariation(const hierarchy::Elements& elements, hierarchy::ElementId sender) {
  if (!elements.isPatch(sender) || elements.at(sender).emitter) return 0;
  const float B = gray(elements.radiometry[sender.index()].B);
  float most = 0;
  for (std::size_t i = 0; i < elements.at(sender).childCount; ++i)
    most = std::max(most, std::abs(gray(elements.radiometry[elements.child(sender, i).index()].B) - B));
  return most;
}

/// A cluster's surfaces see a direction at all angles: a quarter of their area faces it [Cauchy].
double facingArea(const hierarchy::Elements& elements, hierarchy::ElementId receiver) {
  return elements.shape(receiver).area * (elements.isCluster(receiver) ? 0.25 : 1.0);
}

}  // namespace

Oracle::Oracle(const hierarchy::Elements& elements, const OracleSettings& settings)
    : elements_(elements), settings_(settings) {
  // Where nothing lit is seen, a thousandth of the scene's mean is dark enough.
  if (elements.sceneRoot.valid()) {
    const hierarchy::ElementLight& root = elements.radiometry[elements.sceneRoot.index()];
    floor_ = deltalux::tuning::kNegligible * gray(root.direct + root.indirect);
  }
}

double Oracle::referenceArea(hierarchy::ElementId e) const {
  const double side = settings_.scale * elements_.shape(e).meanFreePath;
  return side * side;
}

double Oracle::tolerance(hierarchy::ElementId receiver) const {
  return std::max(double(elements_.radiometry[receiver.index()].tolerance), floor_);
}

double Oracle::budget(hierarchy::ElementId receiver) const {
  const double area = std::max<double>(elements_.shape(receiver).area, referenceArea(receiver));
  return settings_.share * settings_.error * tolerance(receiver) * area;
}

bool Oracle::divisible(hierarchy::ElementId e) const {
  if (!elements_.isPatch(e)) return !elements_.isPoint(e);
  return elements_.shape(e).area > settings_.finest * settings_.error * referenceArea(e);
}

LinkError Oracle::evaluate(const hierarchy::Link& link) const {
  LinkError e;
  e.budget = budget(link.receiver) *
             (elements_.at(link.sender).emitter && elements_.isPatch(link.receiver) ? settings_.direct : 1.0);
  const double strength = senderStrength(elements_, link.sender, link.receiver);
  const double area = facingArea(elements_, link.receiver);
  const double V = link.visibility == hierarchy::Visibility::Unknown
                       ? 1.0
                       : std::min(1.0, double(maxChannel(link.V)) + double(link.visibilitySpread));
  e.power = strength * link.K * area;
  e.receiver = strength * area * V * link.receiverSpread;
  e.sender = area * V * (strength * link.senderSpread + link.K * senderVariation(elements_, link.sender));
  if (link.visibility == hierarchy::Visibility::Sampled)
    e.visibility = settings_.doubt * e.power * link.visibilitySpread;
  return e;
}

}  // namespace deltalux::paper
