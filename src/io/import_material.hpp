#pragma once
// Metals, coats and gloss of formats that describe them by physics.
#include <deltalux/material.hpp>
#include <optional>
#include <string_view>

namespace deltalux::io {

/// Reflectance at normal incidence of a metal by its symbol in any case ("Cu"; "none" reflects all); nullopt for one
/// that is not known.
std::optional<Rgb> reflectanceOfMetal(std::string_view symbol);
/// That of a conductor in air, of refractive index n + ik.
Rgb reflectanceOfConductor(const Rgb& n, const Rgb& k);
/// That of a clear body of refractive index `index`.
float reflectanceOfDielectric(float index);

/// The colour within [0, 1].
Rgb asReflectance(const Rgb&);
/// GGX's lobe of roughness `alpha`, within [0, 1]; a mirror where that is next to nothing.
SpecularLobe ggxLobe(const Rgb& reflectance, double alpha);
/// A clear coat, its reflection multiplied by `gloss`, over a diffuse base.
Opaque coatedDiffuse(const Rgb& base, float index, const Rgb& gloss, double alpha);

}  // namespace deltalux::io
