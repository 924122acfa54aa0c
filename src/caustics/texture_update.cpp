#include "caustics/texture_update.hpp"

#include <algorithm>
#include <utility>

#include "base/check.hpp"
#include "base/parallel.hpp"
#include "base/tuning.hpp"
#include "caustics/choice.hpp"
#include "caustics/resolution.hpp"
#include "caustics/tuning.hpp"
#include "particles/side_index.hpp"

namespace deltalux::caustics {

namespace {

constexpr std::uint32_t kNone = 0xffffffffu;  // [sentinel]
constexpr std::size_t kParts = 8;             // of all impacts, summed apart [task]

/// 1 for impacts at one place, 0 for those that textures tell apart.
float sameness(const particles::Particles& p, std::uint32_t a, std::uint32_t b) {
  if (p.primitive[a] != p.primitive[b] || p.triangleAndSide[a] != p.triangleAndSide[b]) return 0.0f;
  const glm::vec2 d = glm::abs(p.uv[a] - p.uv[b]);
  return std::max(0.0f, 1 - float(kFineSide) * std::max(d.x, d.y));
}

/// body(part, begin, end) over kParts ranges of [0, count), in parallel.
template <class Body>
void inParts(std::size_t count, const Body& body) {
  const std::size_t size = (count + kParts - 1) / kParts;
  if (size > 0)
    parallelBlocks(count, size, [&](std::size_t begin, std::size_t end) { body(begin / size, begin, end); });
}

}  // namespace

/// Tiles of twice the size.
std::vector<TextureUpdate::Tile> TextureUpdate::halved(const std::vector<Tile>& tiles, std::uint32_t across) {
  std::vector<Tile> result(tiles.size() / 4);
  for (std::uint32_t y = 0; y < across; ++y)
    for (std::uint32_t x = 0; x < across; ++x) {
      Tile& to = result[y / 2 * (across / 2) + x / 2];
      const Tile& from = tiles[y * across + x];
      to.now += from.now, to.difference += from.difference, to.squares += from.squares;
    }
  return result;
}

TextureUpdate::TextureUpdate(const Parts& parts, const particles::ParticleTransfer& transfer, double error)
    : parts_(parts), error_(error), tiles_(parts.scene, parts.particles) {
  const particles::Particles& p = parts_.particles;
  tileOf_.assign(p.impactSlots(), kNone);
  for (std::size_t path = 0; path < p.paths(); ++path)
    for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) tileOf_[i] = tiles_.tileOf(p, i);
  weigh(transfer);
  then_.assign(now_.size(), 0.0f);
  looks_.resize(tiles_.sides().size());
  remember(std::vector<char>(looks_.size(), 1), meanOtherLight(parts_.scene, parts_.elements));
}

TextureUpdate::Report TextureUpdate::follow(const particles::ParticleUpdate& update,
                                            const particles::ParticleTransfer& transfer, Caustics& caustics) {
  DELTALUX_CHECK(!update.all, "the particles of before");
  takeIn(update);
  const LargeArray<Rgb> powers = weigh(transfer);
  compare();
  const std::vector<double> background = meanOtherLight(parts_.scene, parts_.elements);
  std::vector<char> sides(looks_.size(), 0);
  parallelFor(sides.size(), 64, [&](std::size_t side) {
    sides[side] = changed(side, background[side], caustics.of(PrimitiveId(side / 2), side % 2 == 0));
  });
  Report report;
  report.evaluated = static_cast<std::uint64_t>(std::count(sides.begin(), sides.end(), 1));
  for (SurfaceCaustics& s : caustics.surfaces)
    if (const std::size_t side = particles::sideIndex(s.primitive, s.front); !sides[side])
      report.scaled += rescale(s, fluxOf(side), deltalux::tuning::kChangeMatters * error_);
  report.rebuilt = remakeCaustics(caustics, parts_.scene, parts_.elements, depositsOn(sides, powers), error_, sides);
  remember(sides, background);
  return report;
}

/// Impacts that came out where they were keep what is known of them; the others' light was taken away, or is new. What
/// moved by a part of a texel is so in part.
void TextureUpdate::takeIn(const particles::ParticleUpdate& update) {
  const particles::Particles& p = parts_.particles;
  tileOf_.resize(p.impactSlots(), kNone), then_.resize(p.impactSlots(), 0.0f), now_.resize(p.impactSlots(), 0.0f);
  for (const particles::RetracedPath& r : update.paths) {
    const std::uint32_t first = p.firstImpact(r.path), before = r.range.impact;
    for (std::uint32_t i = first; i < p.endImpact(r.path); ++i) {
      tileOf_[i] = tiles_.tileOf(p, i);
      const std::uint32_t old = before + (i - first);
      const float same = i - first < r.range.impacts ? sameness(p, i, old) : 0.0f;
      then_[i] = same * then_[old], then_[old] -= then_[i];
    }
    std::fill_n(now_.begin() + before, r.range.impacts, 0.0f);
  }
}

/// Today's flux of every impact and tile. What every path carries.
LargeArray<Rgb> TextureUpdate::weigh(const particles::ParticleTransfer& transfer) {
  const particles::Particles& p = parts_.particles;
  now_.resize(p.impactSlots(), 0.0f);
  LargeArray<Rgb> powers(p.paths());
  std::vector<std::vector<RgbSum>> sums(kParts, std::vector<RgbSum>(tiles_.size(), RgbSum(0.0)));
  inParts(p.paths(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    for (std::size_t path = begin; path < end; ++path) {
      powers[path] = Rgb(0.0f);
      if (p.range[path].impacts == 0) continue;
      const Rgb power = p.links[p.link[path]].scale * transfer.power(path, parts_.elements, parts_.scene);
      powers[path] = power;
      for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i) {
        const Rgb flux = power * p.throughput[i];
        now_[i] = gray(flux);
        sums[part][tileOf_[i]] += RgbSum(flux);
      }
    }
  });
  tile_.assign(tiles_.size(), {});
  for (std::size_t t = 0; t < tile_.size(); ++t)
    for (const auto& part : sums) tile_[t].now += part[t];
  return powers;
}

RgbSum TextureUpdate::fluxOf(std::size_t side) const {
  const SurfaceTiles::Side& s = tiles_.sides()[side];
  RgbSum sum(0.0);
  for (std::uint32_t t = s.first; t < s.first + s.count(); ++t) sum += tile_[t].now;
  return sum;
}

/// Today's light against that of then, times the common factor of each side.
void TextureUpdate::compare() {
  std::vector<float> factor(tiles_.size(), 1.0f);
  for (std::size_t side = 0; side < looks_.size(); ++side) {
    const SurfaceTiles::Side& s = tiles_.sides()[side];
    const double then = gray(looks_[side].flux);
    if (then > 0) std::fill_n(factor.begin() + s.first, s.count(), static_cast<float>(gray(fluxOf(side)) / then));
  }
  struct Sums {
    double difference = 0, squares = 0;
  };
  std::vector<std::vector<Sums>> sums(kParts, std::vector<Sums>(tiles_.size()));
  inParts(now_.size(), [&](std::size_t part, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if (tileOf_[i] == kNone) continue;
      Sums& s = sums[part][tileOf_[i]];
      s.difference += std::abs(now_[i] - factor[tileOf_[i]] * then_[i]);
      s.squares += double(now_[i]) * now_[i];
    }
  });
  for (std::size_t t = 0; t < tile_.size(); ++t)
    for (const auto& part : sums) tile_[t].difference += part[t].difference, tile_[t].squares += part[t].squares;
}

bool TextureUpdate::fewParticles(const SurfaceTiles::Side& side) const {
  double flux = 0, squares = 0;
  for (std::uint32_t t = side.first; t < side.first + side.count(); ++t)
    flux += gray(tile_[t].now), squares += tile_[t].squares;
  return tooFew(flux, squares);
}

bool TextureUpdate::changed(std::size_t side, double background, bool textured) const {
  const SurfaceTiles::Side& s = tiles_.sides()[side];
  if (s.across == 0 || (!textured && fewParticles(s))) return false;
  const double error = (textured ? deltalux::tuning::kChangeMatters : tuning::kMatters) * error_;
  std::vector<Tile> level(tile_.begin() + s.first, tile_.begin() + s.first + s.count());
  double area = s.area;
  for (std::uint32_t across = s.across;; across /= 2, area *= 4) {
    const auto differs = [&](const Tile& t) {
      const double now = gray(t.now), grain = now > 0 ? t.squares / now : 0.0;
      const double noise = std::max(tuning::kMatters * std::sqrt(t.squares), tuning::kStray * grain);
      return t.difference > std::max(error * (now + background * area), noise);
    };
    if (std::any_of(level.begin(), level.end(), differs)) return true;
    if (across == 1) break;
    level = halved(level, across);
  }
  const RgbSum now = level[0].now, then = looks_[side].flux;
  if (!(gray(then) > 0)) return false;
  const double factor = gray(now) / gray(then), other = background * area;
  if (gray(glm::abs(now - factor * then)) > error * (gray(now) + other)) return true;  // another colour
  const double noisier = (gray(now) + other) / (factor * (gray(then) + looks_[side].background * area));
  return std::max(noisier, 1 / noisier) > 1 + tuning::kMatters;
}

/// By side; on each in the order of the particles.
std::vector<particles::Impact> TextureUpdate::depositsOn(const std::vector<char>& sides,
                                                         const LargeArray<Rgb>& powers) const {
  const particles::Particles& p = parts_.particles;
  std::vector<std::vector<std::uint32_t>> places(kParts, std::vector<std::uint32_t>(sides.size(), 0));
  const auto forEach = [&](const auto& body) {
    inParts(p.paths(), [&](std::size_t part, std::size_t begin, std::size_t end) {
      for (std::size_t path = begin; path < end; ++path)
        for (std::uint32_t i = p.firstImpact(path); i < p.endImpact(path); ++i)
          if (const std::size_t side = particles::sideIndex(p, i); sides[side]) body(path, i, places[part][side]);
    });
  };
  forEach([](std::size_t, std::uint32_t, std::uint32_t& count) { ++count; });
  std::uint32_t next = 0;
  for (std::size_t side = 0; side < sides.size(); ++side)
    for (auto& part : places) part[side] = std::exchange(next, next + part[side]);
  std::vector<particles::Impact> all(next);
  forEach([&](std::size_t path, std::uint32_t i, std::uint32_t& place) {
    all[place++] = {p.primitive[i], p.triangleAndSide[i] >> 1, (p.triangleAndSide[i] & 1) == 0, p.uv[i],
                    powers[path] * p.throughput[i]};
  });
  return all;
}

void TextureUpdate::remember(const std::vector<char>& sides, const std::vector<double>& background) {
  std::vector<char> tiles(tiles_.size(), 0);
  for (std::size_t side = 0; side < sides.size(); ++side) {
    if (!sides[side]) continue;
    const SurfaceTiles::Side& s = tiles_.sides()[side];
    std::fill_n(tiles.begin() + s.first, s.count(), 1);
    looks_[side] = {fluxOf(side), background[side]};
  }
  parallelFor(now_.size(), 16384, [&](std::size_t i) {
    if (tileOf_[i] != kNone && tiles[tileOf_[i]]) then_[i] = now_[i];
  });
}

std::size_t TextureUpdate::memoryBytes() const {
  return tileOf_.capacity() * sizeof tileOf_[0] + (then_.capacity() + now_.capacity()) * sizeof(float) +
         looks_.capacity() * sizeof(Look) + tile_.capacity() * sizeof(Tile) +
         tiles_.sides().capacity() * sizeof(SurfaceTiles::Side);
}

}  // namespace deltalux::caustics
