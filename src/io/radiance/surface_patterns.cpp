#include "io/radiance/surface_patterns.hpp"

#include <algorithm>
#include <cmath>

#include "base/tuning.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr double kSeen = 0.005;                            // of the mean; what varies by less is constant [shown]
constexpr int kTexelsAlong = 256, kFewTexels = 64;         // of a polygon's longer side [limit]
constexpr std::size_t kManyTexels = std::size_t{1} << 22;  // of a scene; polygons beyond have few each [limit]

std::vector<SurfacePoint> spreadOver(const Shape& shape) {
  std::vector<SurfacePoint> points;
  const int n = deltalux::tuning::kPilots;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) points.push_back(samplePoint(shape, {(i + 0.5) / n, (j + 0.5) / n}));
  return points;
}

PatternPoint lookedAt(const Vec3& position, const Vec3& normal) {
  PatternPoint p;
  p.position = position, p.normal = normal, p.direction = -normal;
  return p;
}

}  // namespace

/// What a place reflects.
struct SurfacePatterns::Look {
  glm::dvec3 diffuse{0.0}, specular{0.0};
};

/// A material under its patterns, or two of those mixed.
struct SurfacePatterns::Paint {
  Look plain;
  bool coloursSpecular = false;  // of metal
  std::vector<const PatternFunction*> patterns;
  std::shared_ptr<const Paint> first, second;  // null: `plain`
  const PatternFunction* share = nullptr;      // of the first
  std::vector<const RadObject*> objects;       // all that went into it
  bool usesPosition = false, usesNormal = false;

  Look at(const PatternPoint& p) const {
    Look look = plain;
    if (share) {
      const Look a = first->at(p), b = second->at(p);
      const double c = std::clamp((*share)(p).x, 0.0, 1.0);
      look = {glm::mix(b.diffuse, a.diffuse, c), glm::mix(b.specular, a.specular, c)};
    }
    for (const PatternFunction* f : patterns) {
      const glm::dvec3 factor = glm::max((*f)(p), glm::dvec3(0.0));
      look.diffuse *= factor;
      if (coloursSpecular) look.specular *= factor;
    }
    for (int i = 0; i < 3; ++i) {
      if (!std::isfinite(look.diffuse[i]) || !std::isfinite(look.specular[i]))
        throw InputError("", 0, "its values are not finite");
      look.specular[i] = std::min(look.specular[i], 1.0);
      look.diffuse[i] = std::min(look.diffuse[i], 1 - look.specular[i]);
    }
    return look;
  }
};

SurfacePatterns::SurfacePatterns(Scene& scene, ImportReport& report, FileAccess& files, long calls)
    : scene_(scene), report_(report), functions_("surface", report, files, calls) {}
SurfacePatterns::~SurfacePatterns() = default;

const PatternFunction* SurfacePatterns::functionOf(const RadObject& object) {
  return functions_.of(object, [&](const PatternFunction& function) {
    if (function.usesCosine() || function.usesDistance()) note("directions and distances in patterns of surfaces");
  });
}

std::shared_ptr<const SurfacePatterns::Paint> SurfacePatterns::paintOf(const Modifier& modifier) {
  auto paint = std::make_shared<Paint>();
  if (modifier.mixture) {
    const Mixture& mixture = *modifier.mixture;
    paint->first = paintOf(mixture.first), paint->second = paintOf(mixture.second);
    if (paint->first && paint->second) paint->share = functionOf(*mixture.object);
    if (!paint->share) paint->first.reset(), paint->second.reset();
  }
  if (paint->share) {
    paint->objects.push_back(modifier.mixture->object);
    for (const auto& part : {paint->first, paint->second}) {
      paint->objects.insert(paint->objects.end(), part->objects.begin(), part->objects.end());
      paint->usesPosition |= part->usesPosition, paint->usesNormal |= part->usesNormal;
    }
    paint->usesPosition |= paint->share->usesPosition(), paint->usesNormal |= paint->share->usesNormal();
  } else {
    if (!modifier.material.valid()) return nullptr;
    const auto* opaque = std::get_if<Opaque>(&scene_[modifier.material].surface);
    if (!opaque || scene_[modifier.material].emission) return nullptr;
    paint->plain = {glm::dvec3(opaque->diffuse), glm::dvec3(opaque->specular.reflectance)};
    paint->coloursSpecular = modifier.materialType == Type::Metal || modifier.materialType == Type::Metal2;
  }
  for (const RadObject* pattern : modifier.patterns) {
    if (isSkyPattern(*pattern) || !PatternFunction::understands(*pattern)) continue;
    const PatternFunction* function = functionOf(*pattern);
    if (!function) continue;
    paint->patterns.push_back(function), paint->objects.push_back(pattern);
    paint->usesPosition |= function->usesPosition(), paint->usesNormal |= function->usesNormal();
  }
  return paint;
}

Material SurfacePatterns::painted(const Paint&, MaterialId base, const Look& mean) const {
  Material material = scene_[base];
  auto& opaque = std::get<Opaque>(material.surface);
  opaque.diffuse = Rgb(mean.diffuse), opaque.specular.reflectance = Rgb(mean.specular);
  return material;
}

std::pair<Shape, MaterialId> SurfacePatterns::textured(const Paint& paint, MaterialId base, const Polygon& polygon,
                                                       const Look& mean) {
  const Vec3 u = glm::normalize(polygon.edgeU), v = glm::cross(polygon.normal, u);
  Vec2 low(kInfinity), high(-kInfinity);
  for (const Vec3& vertex : polygon.vertices) {
    const Vec2 at(glm::dot(vertex, u), glm::dot(vertex, v));
    low = glm::min(low, at), high = glm::max(high, at);
  }
  const Vec2 size = high - low;
  const int most = texels_ < kManyTexels ? kTexelsAlong : kFewTexels;
  const double step = std::max(size.x, size.y) / (most - 1);
  Texture texture;
  texture.name = paint.objects.front()->name;
  texture.width = std::clamp(static_cast<int>(std::ceil(size.x / step)) + 1, 2, most);
  texture.height = std::clamp(static_cast<int>(std::ceil(size.y / step)) + 1, 2, most);
  const double away = glm::dot(polygon.vertices[0], polygon.normal);
  // The outermost texels' centres stand on the outline: what is beyond them is not asked for.
  for (int row = 0; row < texture.height; ++row)
    for (int column = 0; column < texture.width; ++column) {
      const Vec2 at = low + size * Vec2(double(column) / (texture.width - 1), double(row) / (texture.height - 1));
      const Look look = paint.at(lookedAt(at.x * u + at.y * v + away * polygon.normal, polygon.normal));
      Rgb texel(0.0f);
      for (int c = 0; c < 3; ++c)
        if (mean.diffuse[c] > 0) texel[c] = static_cast<float>(look.diffuse[c] / mean.diffuse[c]);
      texture.texels.push_back(texel);
    }
  std::vector<Vec2> texcoords;
  const Vec2 texels(texture.width, texture.height);
  for (const Vec3& vertex : polygon.vertices) {
    const Vec2 share = (Vec2(glm::dot(vertex, u), glm::dot(vertex, v)) - low) / glm::max(size, Vec2(1e-300));
    texcoords.push_back((Vec2(0.5) + share * (texels - 1.0)) / texels);
  }
  auto mesh = makeMesh(polygon.vertices, polygon.triangles, {}, std::move(texcoords));
  if (!mesh) return {polygon, base};
  texels_ += texture.texels.size();
  Material material = painted(paint, base, mean);
  std::get<Opaque>(material.surface).diffuseTexture = TextureId(scene_.textures.size());
  scene_.textures.push_back(std::move(texture));
  scene_.materials.push_back(std::move(material));
  return {std::move(*mesh), MaterialId(scene_.materials.size() - 1)};
}

std::pair<Shape, MaterialId> SurfacePatterns::apply(const Modifier& modifier, Shape shape) {
  if (!modifier.material.valid() || (modifier.patterns.empty() && !modifier.mixture))
    return {std::move(shape), modifier.material};
  try {
    const std::shared_ptr<const Paint> paint = paintOf(modifier);
    if (!paint || paint->objects.empty()) return {std::move(shape), modifier.material};
    const bool everywhere = !paint->usesPosition && !paint->usesNormal;
    const Key key(modifier.material, paint->objects);
    if (everywhere)
      if (const auto known = made_.find(key); known != made_.end()) return {std::move(shape), known->second};
    Look mean;
    std::vector<Look> looks;
    for (const SurfacePoint& point : spreadOver(shape))
      looks.push_back(paint->at(lookedAt(point.position, point.normal)));
    for (const Look& look : looks) mean.diffuse += look.diffuse, mean.specular += look.specular;
    const double count = static_cast<double>(looks.size());
    mean.diffuse /= count, mean.specular /= count;
    double off = 0;
    for (const Look& look : looks)
      for (int c = 0; c < 3; ++c) off = std::max(off, std::abs(look.diffuse[c] - mean.diffuse[c]));
    const bool varies = off > kSeen * std::max({mean.diffuse.x, mean.diffuse.y, mean.diffuse.z});
    if (const auto* polygon = std::get_if<Polygon>(&shape); polygon && varies)
      return textured(*paint, modifier.material, *polygon, mean);
    if (varies) note("patterns over curved surfaces (average used)");
    const MaterialId id(scene_.materials.size());
    scene_.materials.push_back(painted(*paint, modifier.material, mean));
    if (everywhere) made_[key] = id;
    return {std::move(shape), id};
  } catch (const InputError& error) {
    note("patterns of a surface (" + error.message() + ")");
    return {std::move(shape), modifier.material};
  }
}

}  // namespace deltalux::io::radiance
