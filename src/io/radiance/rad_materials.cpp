#include "io/radiance/rad_materials.hpp"

#include <deltalux/math.hpp>

namespace deltalux::io::radiance {

namespace {

class Arguments {
 public:
  explicit Arguments(const RadObject& object) : object_(object) {}

  Rgb nonNegative(std::size_t at) const {
    for (std::size_t i = at; i < at + 3; ++i) {
      if (real(i) < 0) fail("a colour is negative");
    }
    return {real(at), real(at + 1), real(at + 2)};
  }

  Rgb reflectance(std::size_t at) const {
    const Rgb colour = nonNegative(at);
    if (maxChannel(colour) > 1) fail("a colour is above 1: it would return more light than it receives");
    return colour;
  }

  float fraction(std::size_t at, const char* what) const {
    if (!(real(at) >= 0 && real(at) <= 1)) fail(std::string(what) + " is not between 0 and 1");
    return static_cast<float>(real(at));
  }

  float roughness(std::size_t at) const {
    if (!(real(at) >= 0 && real(at) <= 10)) fail("its roughness is not between 0 and 10");
    return static_cast<float>(real(at));
  }

  /// Mean of the roughnesses along u and v.
  float meanRoughness(std::size_t at) const { return 0.5f * (roughness(at) + roughness(at + 1)); }

  float refractiveIndex(std::size_t at) const {
    if (!(real(at) >= 0.01 && real(at) <= 100)) fail("its refractive index is out of range");
    return static_cast<float>(real(at));
  }

  double real(std::size_t at) const { return object_.reals[at]; }

  [[noreturn]] void fail(const std::string& message) const {
    throw inputError(object_.where, object_.typeName + " '" + object_.name + "': " + message);
  }

 private:
  const RadObject& object_;
};

SpecularLobe lobe(const Rgb& reflectance, float roughness) {
  return {reflectance, roughness, SpecularLobe::Distribution::Ward};
}

Surface plastic(const Arguments& a, float roughness) {
  const float specular = a.fraction(3, "its specularity");
  return Opaque{(1 - specular) * a.reflectance(0), {}, lobe(Rgb(specular), roughness)};
}

Surface metal(const Arguments& a, float roughness) {
  const float specular = a.fraction(3, "its specularity");
  const Rgb colour = a.reflectance(0);
  return Opaque{(1 - specular) * colour, {}, lobe(specular * colour, roughness)};
}

/// `at` is where transmission and transmitted-specular stand.
Surface trans(const Arguments& a, float roughness, std::size_t at) {
  const float specular = a.fraction(3, "its specularity");
  const float transmission = a.fraction(at, "its transmission");
  const float straight = a.fraction(at + 1, "its transmitted specular part");
  const Rgb colour = a.reflectance(0);
  const float transmitted = (1 - specular) * transmission;
  return Trans{(1 - specular - transmitted) * colour, transmitted * (1 - straight) * colour,
               lobe(Rgb(specular), roughness), lobe(transmitted * straight * colour, roughness)};
}

Surface glass(const RadObject& object, const Arguments& a) {
  // Panes of full transmittance need a transmissivity above 1 in Radiance's formula; ours lose nothing at 1.
  const Rgb transmissivity = glm::min(a.nonNegative(0), Rgb(1.0f));
  return ThinGlass{transmissivity, object.reals.size() > 3 ? a.refractiveIndex(3) : 1.52f};
}

SpotCone spotCone(const Arguments& a) {
  const double degrees = a.real(3);
  const Vec3 direction(a.real(4), a.real(5), a.real(6));
  if (!(degrees > 0 && degrees <= 360)) a.fail("its cone's angle is not between 0 and 360 degrees");
  if (!(glm::length(direction) > 1e-12)) a.fail("its direction is zero");
  return {glm::radians(degrees), direction};
}

}  // namespace

Material makeMaterial(const RadObject& object, const Material* alternate) {
  const Arguments a(object);
  const auto reflecting = [&](Surface surface) { return Material{object.name, std::move(surface), std::nullopt}; };
  const auto emitting = [&](std::optional<SpotCone> cone) {
    return Material{object.name, Opaque{}, Emission{a.nonNegative(0), false, cone}};
  };
  if (alternate != nullptr) return {object.name, alternate->surface, alternate->emission};
  switch (object.type) {
    case Type::Plastic:
      return reflecting(plastic(a, a.roughness(4)));
    case Type::Plastic2:
      return reflecting(plastic(a, a.meanRoughness(4)));
    case Type::Metal:
      return reflecting(metal(a, a.roughness(4)));
    case Type::Metal2:
      return reflecting(metal(a, a.meanRoughness(4)));
    case Type::Trans:
      return reflecting(trans(a, a.roughness(4), 5));
    case Type::Trans2:
      return reflecting(trans(a, a.meanRoughness(4), 6));
    case Type::Glass:
      return reflecting(glass(object, a));
    case Type::Dielectric:
      return reflecting(Dielectric{a.reflectance(0), a.refractiveIndex(3)});
    case Type::Mirror:
      return reflecting(Mirror{a.reflectance(0)});
    case Type::Light:
    case Type::Illum:
      return emitting(std::nullopt);
    case Type::Glow: {
      Material glow = emitting(std::nullopt);
      glow.emission->seenOnly = a.real(3) < 0;  // [Radiance, glow]
      return glow;
    }
    case Type::Spotlight:
      return emitting(spotCone(a));
    default:
      a.fail("is no supported material");
  }
}

}  // namespace deltalux::io::radiance
