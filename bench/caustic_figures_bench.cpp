// caustic_figures_bench reconstruction NAME SCENE OBJECT ERROR SAMPLES FOLDER
// caustic_figures_bench restriction NAME SCENE OBJECT ERROR FOLDER
//
// The figures of docs/textures.md, as pictures in FOLDER, and their numbers as CSV rows: scene, error, particles,
// measure, value, unit.
//   reconstruction  the same particles on an object's first surface, over the region of its busiest texture: flat (each
//                   patch of a mesh refined for particles its mean), mesh (that mesh smoothed) and texture, beside the
//                   reference integrator's light of SAMPLES paths at each of four points a pixel. All other light is
//                   the same in the three. Differences are root mean square, of a pixel's gray irradiance, over its
//                   mean, less the reference's own noise. [GD01 figure 2]
//   restriction     textures without restriction and with, of as many texels: the whole surface, regions outlined, and
//                   the busiest region. [GD01 figure 3]
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <deltalux/engine.hpp>
#include <deltalux/image_io.hpp>
#include <deltalux/io.hpp>
#include <deltalux/reference.hpp>
#include <deltalux/render.hpp>
#include <stdexcept>

#include "caustics/adaptive_textures.hpp"
#include "render/caustic_light.hpp"
#include "render/irradiance_field.hpp"
#include "solution/solution.hpp"

namespace deltalux::bench {
namespace {

constexpr double kPixels = 128 * 128;  // of a panel
constexpr int kPoints = 2;             // a side of a pixel: caustics are sharper than pixels
constexpr int kEnlarged = 2;
constexpr int kGap = 6;

void row(const std::string& scene, double error, std::uint64_t particles, const std::string& measure, double value,
         const char* unit) {
  fmt::print("{},{},{},{},{:.6g},{}\n", scene, error, particles, measure, value, unit);
  std::fflush(stdout);
}

Engine solved(const std::string& file, double error, bool textures) {
  SolveSettings settings;
  settings.error = error, settings.causticTextures = textures;
  Engine engine(loadScene({file}).scene, settings);
  engine.solve();
  return engine;
}

const caustics::SurfaceCaustics& texturesOf(const Solution& s, const std::string& object) {
  const std::vector<ObjectId> found = findObjects(s.scene, object);
  if (found.empty()) throw std::runtime_error("no object named " + object);
  const std::vector<PrimitiveId> primitives = primitivesOf(s.scene, found.front());
  const caustics::SurfaceCaustics* textures = primitives.empty() ? nullptr : s.caustics.of(primitives.front(), true);
  if (!textures) throw std::runtime_error("no caustic texture on " + object);
  if (!std::holds_alternative<caustics::PlaneChart>(textures->charts.all[0].map))
    throw std::runtime_error(object + " is not flat");
  return *textures;
}

const caustics::CausticTexture& busiest(const caustics::SurfaceCaustics& s) {
  return *std::max_element(s.textures.begin(), s.textures.end(),
                           [](const auto& a, const auto& b) { return a.particles < b.particles; });
}

/// Square pixels over a plane chart's rectangle, row by row from the top.
struct Raster {
  caustics::Region region;
  int width, height;

  explicit Raster(const caustics::Region& r) : region(r) {
    const double pixel = std::sqrt(r.size().x * r.size().y / kPixels);
    width = std::max(1, static_cast<int>(r.size().x / pixel)),
    height = std::max(1, static_cast<int>(r.size().y / pixel));
  }
  std::size_t count() const { return static_cast<std::size_t>(width) * height; }
  /// A point of a pixel, by parts of its side.
  Vec2 at(std::size_t pixel, const Vec2& part = Vec2(0.5)) const {
    const double x = static_cast<double>(pixel % width) + part.x,
                 y = height - static_cast<double>(pixel / width) - part.y;
    return region.lower + region.size() * Vec2(x / width, y / height);
  }
};

Vec3 onPlane(const caustics::Chart& chart, const Vec2& st) {
  const caustics::PlaneChart& plane = std::get<caustics::PlaneChart>(chart.map);
  return plane.origin + st.x * plane.alongS + st.y * plane.alongT;
}

Image imageOf(const Raster& raster, const std::vector<RgbSum>& E) {
  Image image;
  image.width = raster.width, image.height = raster.height;
  for (const RgbSum& e : E) image.pixels.push_back(Rgb(e / kPi));
  return image;
}

/// Panels side by side, all with one exposure.
void saveSheet(const std::string& file, const std::vector<Image>& panels, double ev) {
  int width = -kGap, height = 0;
  for (const Image& panel : panels)
    width += panel.width * kEnlarged + kGap, height = std::max(height, panel.height * kEnlarged);
  DisplayImage sheet{width, height, {}};
  sheet.pixels.assign(static_cast<std::size_t>(width) * height, {255, 255, 255});
  ToneMapping mapping;
  mapping.ev = ev;
  int left = 0;
  for (const Image& panel : panels) {
    const DisplayImage shown = toneMap(panel, mapping);
    for (int y = 0; y < panel.height * kEnlarged; ++y)
      for (int x = 0; x < panel.width * kEnlarged; ++x) sheet.at(left + x, y) = shown.at(x / kEnlarged, y / kEnlarged);
    left += panel.width * kEnlarged + kGap;
  }
  saveImage(file, sheet);
}

/// Light of pixels, and the variance of its gray.
struct Light {
  std::vector<RgbSum> E;
  std::vector<double> variance;

  explicit Light(std::size_t pixels) : E(pixels, RgbSum(0.0)), variance(pixels, 0.0) {}
  void add(std::size_t pixel, const RgbSum& e, double error = 0) {
    E[pixel] += e / double(kPoints * kPoints);
    variance[pixel] += error * error / std::pow(kPoints, 4);
  }
};

double difference(const Light& light, const Light& truth) {
  double squares = 0, mean = 0;
  for (std::size_t i = 0; i < truth.E.size(); ++i) {
    const double d = gray(light.E[i]) - gray(truth.E[i]);
    squares += d * d - truth.variance[i], mean += gray(truth.E[i]);
  }
  const double count = static_cast<double>(truth.E.size());
  return std::sqrt(std::max(squares, 0.0) / count) / (mean / count);
}

/// What a mesh shows of its particles' light.
class MeshLight {
 public:
  explicit MeshLight(const Solution& s)
      : solution_(s), locator_(s.elements, s.scene), field_(s.elements, s.scene, *s.tracer, particlesOf(s.elements)) {}

  RgbSum flat(PrimitiveId primitive, const Vec3& p) const {
    return RgbSum(solution_.elements.radiometry[leafAt(primitive, p).leaf.index()].particle);
  }
  RgbSum smooth(PrimitiveId primitive, const Vec3& p) const {
    return RgbSum(field_.indirect(leafAt(primitive, p), Vec3f(p)));
  }

 private:
  static std::vector<rendering::LeafIrradiance> particlesOf(const hierarchy::Elements& elements) {
    std::vector<rendering::LeafIrradiance> values(elements.size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i].indirect = elements.radiometry[i].particle;
    return values;
  }
  hierarchy::LeafPoint leafAt(PrimitiveId primitive, const Vec3& p) const {
    return locator_.locate(locator_.side(primitive, 0, true), p);
  }

  const Solution& solution_;
  hierarchy::SideLocator locator_;
  rendering::IrradianceField field_;
};

void drawReconstruction(const std::string& name, const std::string& file, const std::string& object, double error,
                        std::uint64_t samples, const std::string& folder) {
  const Engine engine = solved(file, error, true), onMesh = solved(file, error, false);
  const Solution& s = engine.solution().get();
  const caustics::SurfaceCaustics& textures = texturesOf(s, object);
  const Raster raster(busiest(textures).region);
  std::vector<ProbePoint> points;
  const Vec3 normal = pointAt(s.scene[textures.primitive].shape, {0.5, 0.5}).normal;
  for (std::size_t i = 0; i < raster.count(); ++i)
    for (int k = 0; k < kPoints * kPoints; ++k) {
      const Vec2 part = (Vec2(k % kPoints, k / kPoints) + 0.5) / double(kPoints);
      points.push_back({onPlane(textures.charts.all[0], raster.at(i, part)), normal});
    }

  ProbeSettings precise;
  precise.error = 0.01;
  const std::vector<ProbeResult> probed = probe(engine.solution(), points, precise);
  ReferenceSettings settings;
  settings.samples = samples;
  const std::vector<ProbeResult> reference = ReferenceIntegrator(s.scene, settings).probe(points);
  const MeshLight mesh(onMesh.solution().get());
  Light flat(raster.count()), smooth = flat, texture = flat, truth = flat;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t pixel = i / (kPoints * kPoints);
    const Vec3& p = points[i].position;
    const RgbSum all = probed[i].irradiance;
    const RgbSum other = all - RgbSum(*rendering::causticLight(s.caustics, s.scene, textures.primitive, 0, true, p));
    truth.add(pixel, reference[i].irradiance, gray(reference[i].standardError));
    texture.add(pixel, all);
    flat.add(pixel, other + mesh.flat(textures.primitive, p));
    smooth.add(pixel, other + mesh.smooth(textures.primitive, p));
  }
  const std::uint64_t particles = s.particles.arrived();
  row(name, error, particles, "flat: difference", difference(flat, truth), "");
  row(name, error, particles, "mesh: difference", difference(smooth, truth), "");
  row(name, error, particles, "texture: difference", difference(texture, truth), "");
  saveSheet(fmt::format("{}/{}-reconstruction.png", folder, name),
            {imageOf(raster, flat.E), imageOf(raster, smooth.E), imageOf(raster, texture.E), imageOf(raster, truth.E)},
            automaticEv(imageOf(raster, truth.E)));
}

/// A part of the chart; `outlined`: with the outlines of the textures' regions in white.
Image drawn(const caustics::SurfaceCaustics& s, const Shape& shape, const caustics::Region& part, bool outlined) {
  const caustics::Chart& chart = s.charts.all[0];
  const Raster raster(part);
  std::vector<RgbSum> E;
  for (std::size_t i = 0; i < raster.count(); ++i) {
    SurfacePoint p;
    p.position = onPlane(chart, raster.at(i));
    p.uv = parameterAt(shape, p.position);
    E.push_back(RgbSum(s.irradianceAt(p)));
  }
  Image image = imageOf(raster, E);
  const Vec2 pixel = raster.region.size() / Vec2(raster.width, raster.height);
  for (std::size_t i = 0; outlined && i < raster.count(); ++i)
    for (const caustics::CausticTexture& t : s.textures) {
      const Vec2 d = glm::min(glm::abs(raster.at(i) - t.region.lower), glm::abs(raster.at(i) - t.region.upper)) / pixel;
      if (t.region.contains(raster.at(i)) && std::min(d.x, d.y) < 1) image.pixels[i] = Rgb(1e6f);
    }
  return image;
}

std::size_t texelsOf(const caustics::SurfaceCaustics& s) {
  std::size_t sum = 0;
  for (const caustics::CausticTexture& t : s.textures) sum += t.texels.size();
  return sum;
}

void drawRestriction(const std::string& name, const std::string& file, const std::string& object, double error,
                     const std::string& folder) {
  const Engine engine = solved(file, error, true);
  const Solution& s = engine.solution().get();
  const caustics::SurfaceCaustics& restricted = texturesOf(s, object);
  const Shape& shape = s.scene[restricted.primitive].shape;
  std::vector<particles::Impact> deposited;
  for (const particles::Impact& impact : particles::impacts(s.particles, s.elements, s.scene))
    if (impact.primitive == restricted.primitive && impact.front) deposited.push_back(impact);
  const std::size_t side = 2 * restricted.primitive.index();
  caustics::SurfaceSides asked(2 * s.scene.primitives.size(), false);
  asked[side] = true;
  const caustics::OtherLight other = caustics::otherLight(s.scene, s.elements, asked);
  const caustics::SurfaceCaustics whole = caustics::makeUnrestrictedTextures(
      shape, deposited, {error, other.mean[side], other.darkest[side]}, static_cast<int>(texelsOf(restricted)));
  const caustics::Region all{Vec2(0), restricted.charts.all[0].size}, part = busiest(restricted).region;
  const Image close = drawn(restricted, shape, part, false);
  saveSheet(
      fmt::format("{}/{}-restriction.png", folder, name),
      {drawn(whole, shape, all, true), drawn(restricted, shape, all, true), drawn(whole, shape, part, false), close},
      automaticEv(close));
  row(name, error, s.particles.arrived(), "without: texels", static_cast<double>(texelsOf(whole)), "");
  row(name, error, s.particles.arrived(), "with: texels", static_cast<double>(texelsOf(restricted)), "");
  row(name, error, s.particles.arrived(), "with: textures", static_cast<double>(restricted.textures.size()), "");
}

int run(int argc, char** argv) {
  const std::vector<std::string> a(argv + 1, argv + argc);
  if (a.size() == 7 && a[0] == "reconstruction")
    drawReconstruction(a[1], a[2], a[3], std::stod(a[4]), std::stoull(a[5]), a[6]);
  else if (a.size() == 6 && a[0] == "restriction")
    drawRestriction(a[1], a[2], a[3], std::stod(a[4]), a[5]);
  else
    throw std::runtime_error("see the head of caustic_figures_bench.cpp for its arguments");
  return 0;
}

}  // namespace
}  // namespace deltalux::bench

int main(int argc, char** argv) {
  try {
    return deltalux::bench::run(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "caustic_figures_bench: {}\n", error.what());
    return 1;
  }
}
