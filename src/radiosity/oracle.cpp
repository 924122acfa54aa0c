#include "radiosity/oracle.hpp"

#include <algorithm>
#include <cmath>

namespace deltalux {

namespace {

/// The sender's strength in the unit that K multiplies, gray, as seen from `from`.
double senderStrength(const Elements& elements, ElementId sender, const Vec3f& from) {
  if (!elements.isCluster(sender)) return gray(elements.radiometry[sender.index()].B);
  const Vec3f w = from - elements.shape(sender).center;
  const float length = glm::length(w);
  return length > 0 ? gray(elements.cluster(sender).intensity.at(w / length)) : 0.0f;
}

/// How far the radiosity of the sender's children departs from the sender's own.
double senderVariation(const Elements& elements, ElementId sender) {
  if (!elements.isPatch(sender) || elements.at(sender).emitter) return 0;
  const float B = gray(elements.radiometry[sender.index()].B);
  float most = 0;
  for (std::size_t i = 0; i < elements.at(sender).childCount; ++i)
    most = std::max(most, std::abs(gray(elements.radiometry[elements.child(sender, i).index()].B) - B));
  return most;
}

}  // namespace

Oracle::Oracle(const Elements& elements, const OracleSettings& settings) : elements_(elements), settings_(settings) {
  if (elements.sceneRoot.valid()) floor_ = settings.floor * elements.radiometry[elements.sceneRoot.index()].tolerance;
}

double Oracle::referenceArea(ElementId e) const {
  const double side = settings_.scale * elements_.shape(e).meanFreePath;
  return side * side;
}

double Oracle::budget(ElementId receiver) const {
  const double tolerance = std::max<double>(elements_.radiometry[receiver.index()].tolerance, floor_);
  const double area = std::max<double>(elements_.shape(receiver).area, referenceArea(receiver));
  return settings_.share * settings_.error * tolerance * area;
}

LinkError Oracle::judge(const Link& link) const {
  LinkError e;
  e.budget = budget(link.receiver);
  const double strength = senderStrength(elements_, link.sender, elements_.shape(link.receiver).center);
  // A cluster's surfaces see a direction at all angles: a quarter of their area faces it [Cauchy].
  const double area = elements_.shape(link.receiver).area * (elements_.isCluster(link.receiver) ? 0.25 : 1.0);
  const double V = link.visibility == Visibility::Unknown ? 1.0 : double(maxChannel(link.V));
  e.power = strength * link.K * area;
  e.receiver = strength * area * V * link.receiverSpread;
  e.sender = area * V * (strength * link.senderSpread + link.K * senderVariation(elements_, link.sender));
  if (link.visibility == Visibility::Sampled) e.visibility = e.power * link.visibilitySpread;
  return e;
}

}  // namespace deltalux
