#include "io/radiance/emission_patterns.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"
#include "base/unit_circle.hpp"
#include "io/radiance/sky_pattern.hpp"
#include "io/radiance/tabulate.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kLeastCosine = 1e-6;     // of a flat source's intensity, seen edge-on [rounding]
constexpr double kNoticed = 0.01;         // relative; what is averaged away and differs by less is not reported [shown]
constexpr long kEvaluationsOfACall = 50;  // of a table, that take as long as a call of an expression [limit]

std::optional<Vec3> normalOfFlat(const Shape& shape) {
  if (const auto* polygon = std::get_if<Polygon>(&shape)) return polygon->normal;
  if (const auto* ring = std::get_if<Ring>(&shape)) return ring->normal;
  return std::nullopt;
}

std::vector<SurfacePoint> placesOn(const Shape& shape, int n) {
  std::vector<SurfacePoint> points;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) points.push_back(samplePoint(shape, {(i + 0.5) / n, (j + 0.5) / n}));
  return points;
}

Rgb scaled(const Rgb& radiance, const glm::dvec3& factor) {
  constexpr double kLargest = 1e30;  // [limit]
  const glm::dvec3 result = glm::dvec3(radiance) * factor;
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(result[c]) <= kLargest)) throw InputError("", 0, "its values are too large");
  return Rgb(result);
}

[[noreturn]] void failNotFinite() { throw InputError("", 0, "its values are not finite"); }

}  // namespace

/// The patterns of a chain, multiplied.
struct EmissionPatterns::Product {
  std::vector<const PatternFunction*> functions;
  glm::dmat3 frame{1.0};  // of the first: its angles are the table's
  bool usesNormal = false, usesCosine = false, usesPosition = false;
  bool isIntensity = false;  // value * cosine depends on direction alone
  std::unique_ptr<Sampled> shared;

  glm::dvec3 operator()(const PatternPoint& p) const {
    glm::dvec3 result(1.0);
    for (const PatternFunction* f : functions) result *= (*f)(p);
    return glm::max(result, glm::dvec3(0.0));  // NaN stays
  }
  bool byDirectionAlone() const { return !usesPosition && !usesNormal && (!usesCosine || isIntensity); }
};

/// A product's values over directions: luminance as a table, colour in the mean.
struct EmissionPatterns::Sampled {
  std::shared_ptr<const DirectionTable> table;
  glm::dvec3 peak{0.0};  // of the table's 1, each channel
  bool constant = false;
};

EmissionPatterns::EmissionPatterns(Scene& scene, ImportReport& report, FileAccess& files, long calls)
    : scene_(scene), report_(report), functions_("light", report, files, calls) {}
EmissionPatterns::~EmissionPatterns() = default;

const PatternFunction* EmissionPatterns::functionOf(const RadObject& object) {
  return functions_.of(object, [&](const PatternFunction& function) {
    if (function.usesDistance()) note("distance in patterns of lights");
  });
}

EmissionPatterns::Chain EmissionPatterns::readable(const Modifier& modifier) {
  Chain chain;
  for (const RadObject* pattern : modifier.patterns)
    if (PatternFunction::understands(*pattern) && functionOf(*pattern) != nullptr) chain.push_back(pattern);
  return chain;
}

EmissionPatterns::Product& EmissionPatterns::productOf(const Chain& chain) {
  std::unique_ptr<Product>& product = products_[chain];
  if (product) return *product;
  product = std::make_unique<Product>();
  for (const RadObject* object : chain) {
    const PatternFunction* f = functionOf(*object);
    product->functions.push_back(f);
    product->usesNormal |= f->usesNormal(), product->usesCosine |= f->usesCosine();
    product->usesPosition |= f->usesPosition();
  }
  product->frame = product->functions[0]->frame();
  if (product->usesCosine && !product->usesNormal) {
    product->isIntensity = true;
    for (int i = 0; i < 16; ++i) {
      const double z = (i + 0.5) / 8 - 1, r = std::sqrt(1 - z * z);
      PatternPoint p;
      p.direction = Vec3(r * onUnitCircle(0.618034 * i), z);
      const double whole = gray((*product)(p));
      p.cosine = 0.25;
      product->isIntensity &= std::abs(0.25 * gray((*product)(p)) - whole) <= 1e-9 * whole;
    }
  }
  return *product;
}

EmissionPatterns::Sampled EmissionPatterns::sample(const Product& product, std::span<const SurfacePoint> places,
                                                   bool intensity) {
  const bool flat = places.empty() || std::all_of(places.begin(), places.end(),
                                                  [&](const SurfacePoint& p) { return p.normal == places[0].normal; });
  double weights = 0, deviation = 0;  // over places
  const auto at = [&](const Vec3& w) {
    PatternPoint p;
    p.direction = -w, p.normal = w;
    if (places.empty()) return product(p);
    glm::dvec3 sum(0.0);
    std::vector<std::pair<double, double>> values;  // weight, value
    double cosines = 0;
    for (const SurfacePoint& place : places) {
      const double cosine = glm::dot(place.normal, w);
      if (!flat && cosine < deltalux::tuning::kNegligible) continue;
      p.normal = place.normal, p.position = place.position;
      p.cosine = std::max(std::abs(cosine), kLeastCosine);
      const double weight = flat && !intensity ? 1.0 : p.cosine;
      const glm::dvec3 value = product(p);
      sum += weight * value, cosines += flat ? 1.0 : weight;
      values.emplace_back(weight, gray(value));
    }
    if (!(cosines > 0)) return glm::dvec3(0.0);
    const double mean = gray(sum) / cosines;
    for (const auto& [weight, value] : values)
      weights += mean, deviation += std::abs(value * (flat ? weight : 1) - mean);
    return sum / cosines;
  };
  glm::dvec3 sums(0.0), squares(0.0);  // of each channel, and of its square over luminance
  double luminance = 0;
  const Tabulated tabulated = tabulate(
      [&](const Vec3& local) {
        const glm::dvec3 value = at(product.frame * local);
        const double y = gray(value), weight = std::hypot(local.x, local.y);
        if (y > 0) sums += weight * value, squares += weight / y * value * value, luminance += weight * y;
        return y;
      },
      failNotFinite, places.size() <= 1);
  if (tabulated.error > kNoticed) note("details of lights' patterns finer than half a degree");
  if (product.usesPosition && deviation > kNoticed * weights) note("position in patterns of lights");
  Sampled result{std::make_shared<const DirectionTable>(tabulated.table), glm::dvec3(0.0), tabulated.constant};
  if (!(luminance > 0)) return result;
  const glm::dvec3 colour = sums / luminance;
  const glm::dvec3 variance = squares / luminance - colour * colour;
  if (std::max({variance.x, variance.y, variance.z}) > kNoticed * kNoticed)
    note("colour by direction in patterns of lights");
  result.peak = tabulated.peak * colour;
  return result;
}

double EmissionPatterns::meanFactor(const DirectionTable& table, const glm::dmat3& frame,
                                    std::span<const SurfacePoint> places, bool intensity) {
  const bool around = places.size() == 1 && std::abs(glm::dot(frame[2], places[0].normal)) > 1 - 1e-12;
  const std::size_t columns = table.columns > 1 ? table.columns
                              : around          ? 1
                                                : 2 * (table.rows - 1);  // as tables have them
  functions_.spend(static_cast<long>(table.rows * columns * places.size()) / kEvaluationsOfACall);
  const double step = kPi / static_cast<double>(table.rows - 1);
  double sum = 0;
  for (std::size_t row = 0; row + 1 < table.rows; ++row) {
    const double theta = (static_cast<double>(row) + 0.5) * step;
    for (std::size_t column = 0; column < columns; ++column) {
      const double turn = (static_cast<double>(column) + 0.5) / static_cast<double>(columns);
      const Vec3 local(std::sin(theta) * onUnitCircle(turn), std::cos(theta)), w = frame * local;
      double facing = 0;
      for (const SurfacePoint& place : places) {
        const double cosine = glm::dot(place.normal, w);
        facing += cosine <= 0 ? 0.0 : intensity ? 1.0 : cosine;
      }
      sum += std::sin(theta) * facing * valueAt(table, local);
    }
  }
  return sum * step * 2 / (static_cast<double>(columns) * static_cast<double>(places.size()));
}

Emission EmissionPatterns::emissionOver(Product& product, const Shape& shape, const Emission& plain) {
  const auto normal = normalOfFlat(shape);
  const bool intensity = normal && product.usesCosine;
  const bool shared = product.byDirectionAlone() && (normal || !product.usesCosine);
  const int count = normal && !product.usesPosition ? 1 : deltalux::tuning::kPilots;
  const std::vector<SurfacePoint> places = placesOn(shape, count);
  Sampled own;
  if (!shared) own = sample(product, places, intensity);
  if (shared && !product.shared) product.shared = std::make_unique<Sampled>(sample(product, {}, intensity));
  const Sampled& sampled = shared ? *product.shared : own;
  Emission emission = plain;
  if (sampled.constant && !intensity) {
    emission.radiance = scaled(plain.radiance, sampled.peak);
    return emission;
  }
  const double mean = meanFactor(*sampled.table, product.frame, places, intensity);
  emission.radiance = scaled(plain.radiance, mean * sampled.peak);
  if (!(mean > 0)) return emission;
  emission.pattern = EmissionPattern{sampled.table, product.frame, 1 / mean, {}};
  if (intensity) emission.pattern->normal = normal;
  return emission;
}

MaterialId EmissionPatterns::materialFor(const Modifier& modifier, const Shape& shape) {
  if (!modifier.material.valid() || modifier.patterns.empty() || !scene_[modifier.material].emission)
    return modifier.material;
  const Chain chain = readable(modifier);
  if (chain.empty()) return modifier.material;
  try {
    Product& product = productOf(chain);
    const auto normal = normalOfFlat(shape);
    const auto* sphere = std::get_if<Sphere>(&shape);
    std::optional<std::tuple<MaterialId, Chain, std::array<double, 3>>> key;
    if (normal && !product.usesPosition)
      key.emplace(modifier.material, chain, std::array{normal->x, normal->y, normal->z});
    if (sphere && !product.usesPosition)
      key.emplace(modifier.material, chain, std::array{0.0, 0.0, sphere->inward ? -2.0 : 2.0});
    if (key)
      if (const auto known = made_.find(*key); known != made_.end()) return known->second;
    Material material = scene_[modifier.material];
    material.emission = emissionOver(product, shape, *material.emission);
    const MaterialId id(scene_.materials.size());
    scene_.materials.push_back(std::move(material));
    if (key) made_[*key] = id;
    return id;
  } catch (const InputError& error) {
    note("patterns of a light (" + error.message() + ")");
    return modifier.material;
  }
}

void EmissionPatterns::apply(const Modifier& modifier, Light& light) {
  const Chain chain = modifier.patterns.empty() ? Chain{} : readable(modifier);
  if (chain.empty()) return;
  auto* const dome = std::get_if<DomeLight>(&light.emitter);
  if (dome && chain.size() == 1 && isSkyPattern(*chain[0])) {
    std::visit([&](const auto& sky) { dome->distribution = sky; }, skyOf(*chain[0]));
    dome->up = zenithOf(*chain[0]);
    return;
  }
  try {
    Product& product = productOf(chain);
    if (auto* const sun = std::get_if<SunLight>(&light.emitter)) {
      PatternPoint p;
      p.direction = sun->direction, p.normal = -sun->direction;
      sun->radiance = scaled(sun->radiance, product(p));
    } else if (dome) {
      const Sampled sampled = sample(product, {}, false);
      dome->scale = scaled(dome->scale, sampled.peak);
      // The table is over leaving directions; what arrives comes from the opposite ones.
      dome->distribution = TabulatedSky{sampled.table, -product.frame};
    }
  } catch (const InputError& error) {
    note("patterns of a light (" + error.message() + ")");
  }
}

}  // namespace deltalux::io::radiance
