#include <cmath>
#include <deltalux/material.hpp>

namespace deltalux {

namespace {

bool reflects(const SpecularLobe& lobe) { return !isBlack(lobe.reflectance); }

/// Fresnel reflectances of one interface, s- and p-polarised, and the cosine behind it.
struct Interface {
  double s, p, cosInside;
};

Interface paneInterface(double cosIncidence, double ior) {
  const double c = std::clamp(std::abs(cosIncidence), 1e-6, 1.0);
  const double cosInside = std::sqrt(1.0 - (1.0 - c * c) / (ior * ior));
  const double s = (c - ior * cosInside) / (c + ior * cosInside);
  const double p = (cosInside - ior * c) / (cosInside + ior * c);
  return {s * s, p * p, cosInside};
}

/// Sums of all internal reflections in a slab whose faces reflect r and whose inside passes a per crossing.
double slabTransmittance(double r, double a) { return (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a); }
double slabReflectance(double r, double a) { return r * (1.0 + (1.0 - 2.0 * r) * a * a) / (1.0 - r * r * a * a); }

template <class Slab>
Rgb overPolarisations(const ThinGlass& glass, double cosIncidence, const Slab& slab) {
  const Interface face = paneInterface(cosIncidence, glass.ior);
  Rgb result;
  for (int i = 0; i < 3; ++i) {
    if (i > 0 && glass.transmissivity[i] == glass.transmissivity[i - 1]) {
      result[i] = result[i - 1];
      continue;
    }
    // The path inside is longer by 1 / cos than at normal incidence.
    const double a = std::pow(std::clamp<double>(glass.transmissivity[i], 0.0, 1.0), 1.0 / face.cosInside);
    result[i] = static_cast<float>(0.5 * (slab(face.s, a) + slab(face.p, a)));
  }
  return result;
}

}  // namespace

Rgb diffuseReflectance(const Material& material, bool /*front*/) {
  const float share = material.coverage;
  if (const auto* opaque = std::get_if<Opaque>(&material.surface)) return share * opaque->diffuse;
  if (const auto* trans = std::get_if<Trans>(&material.surface)) return share * trans->diffuseReflectance;
  return Rgb(0.0f);
}

Rgb diffuseTransmittance(const Material& material) {
  const auto* trans = std::get_if<Trans>(&material.surface);
  return trans ? material.coverage * trans->diffuseTransmittance : Rgb(0.0f);
}

bool isSpecular(const Material& material) {
  if (!(material.coverage > 0)) return false;
  if (const auto* opaque = std::get_if<Opaque>(&material.surface)) return reflects(opaque->specular);
  if (const auto* trans = std::get_if<Trans>(&material.surface)) {
    return reflects(trans->reflection) || reflects(trans->transmission);
  }
  if (const auto* mirror = std::get_if<Mirror>(&material.surface)) return !isBlack(mirror->reflectance);
  return true;  // panes and refracting bodies
}

namespace {

Rgb besideCover(const Material& material) { return (1 - material.coverage) * material.filter; }
bool isThinGlass(const Material& material) { return std::holds_alternative<ThinGlass>(material.surface); }

}  // namespace

bool passesStraight(const Material& material) { return isThinGlass(material) || !isBlack(besideCover(material)); }

Rgb straightTransmittance(const Material& material, double cosIncidence) {
  const auto* glass = std::get_if<ThinGlass>(&material.surface);
  return besideCover(material) + (glass ? material.coverage * transmittance(*glass, cosIncidence) : Rgb(0.0f));
}

bool isClear(const Material& material) {
  return isThinGlass(material) || std::holds_alternative<Dielectric>(material.surface) || !(material.coverage > 0);
}

bool isPane(const Material& material) { return isClear(material) && passesStraight(material); }

Rgb transmittance(const ThinGlass& glass, double cosIncidence) {
  return overPolarisations(glass, cosIncidence, slabTransmittance);
}

Rgb reflectance(const ThinGlass& glass, double cosIncidence) {
  return overPolarisations(glass, cosIncidence, slabReflectance);
}

double fresnelDielectric(double cosIncidence, double ior) {
  const double c = std::clamp(std::abs(cosIncidence), 0.0, 1.0);
  const double cosSquared = 1.0 - (1.0 - c * c) / (ior * ior);
  if (cosSquared <= 0.0) return 1.0;
  const double cosInside = std::sqrt(cosSquared);
  const double s = (c - ior * cosInside) / (c + ior * cosInside);
  const double p = (cosInside - ior * c) / (cosInside + ior * c);
  return 0.5 * (s * s + p * p);
}

}  // namespace deltalux
