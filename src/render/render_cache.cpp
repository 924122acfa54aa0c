#include <deltalux/render_cache.hpp>

#include <algorithm>
#include <limits>

#include "base/check.hpp"
#include "base/prefetch.hpp"
#include "base/tuning.hpp"
#include "direct/aim.hpp"
#include "direct/tuning.hpp"
#include "render/cache_filling.hpp"
#include "render/error_diffusion.hpp"
#include "render/tuning.hpp"
#include "render/view_projection.hpp"

namespace deltalux {

namespace {

/// Rays of a pixel that are averaged at most, and frames until a sample is old.
constexpr std::uint16_t kMostRays = direct::kEstimateRays;
/// Depth of a neighbour over a sample's from which it stands before it. [WDP99 4.2]
constexpr auto kNearer = static_cast<float>(1 - deltalux::tuning::kChangeMatters);  // [defined]
constexpr std::uint32_t kNobody = 0xffffffffu;                                      // [sentinel]
constexpr std::size_t kAhead = 16;  // pixels whose samples are fetched ahead [task]
constexpr std::size_t kGroup = 8;   // samples of which the oldest makes room [WDP99] [defined]
constexpr float kOffCentre = 1.0f;  // [pixels] by which a ray's hit may miss its pixel by rounding [rounding]
constexpr int kPredicted = 4;       // pixels a side of the cells that are looked at ahead [WDG02] [defined]
constexpr float kEmpty = 1.0f;      // priority of a pixel where nothing is: those of others are shares of it [defined]

constexpr float kOutdated = 0.5f * std::numeric_limits<float>::max();  // depth: all else is before it [sentinel]

bool sameView(const View& a, const View& b) {
  return a.kind == b.kind && a.position == b.position && a.direction == b.direction && a.up == b.up &&
         a.horizontal == b.horizontal && a.vertical == b.vertical;
}

}  // namespace

struct RenderCache::State {
  /// What projecting needs of a sample.
  struct Point {
    Vec3f apparent{0.0f};
    std::uint32_t surface = 0;  // of the first one: primitive + 1
    Rgb radiance{0.0f};
    std::uint32_t pixel = 0;
    std::uint32_t view = 0;           // in which it is that pixel's own; 0: none
    std::uint32_t born = 0;           // frame
    std::uint32_t shownAt = kNobody;  // pixel of the frame
    std::uint16_t rays = 1;           // that it is the mean of
    bool noisy = false;
    bool outdated = false;  // an edit has made it wrong; nothing better is there yet
  };

  RenderCacheSettings settings;
  std::vector<PixelSample> samples;
  std::vector<Point> points;  // as the samples
  std::size_t hand = 0;       // where room is made next

  View view;
  rendering::ViewProjection projection;
  std::uint32_t viewNumber = 0, frameNumber = 0;
  bool stands = false;  // nothing came or went since the frame was made
  CacheFrame frame;
  std::vector<std::uint32_t> surfaces;  // of the frame

  /// What a pixel shows.
  struct Shown {
    float depth = std::numeric_limits<float>::infinity();  // negative for a pixel's own
    std::uint32_t point = kNobody;
  };
  // By pixel of the frame.
  std::vector<Shown> shown;
  std::vector<float> standing;         // how much a pixel with a sample wants another
  std::vector<std::uint16_t> streams;  // rays asked for in this view
  std::vector<std::uint32_t> asked;    // in which frame last; 0: not, or it came back
  std::vector<char> answered;          // its ray came back
  rendering::HeldPixels held;

  std::size_t pixels() const { return shown.size(); }
  bool own(std::uint32_t point) const { return points[point].view == viewNumber; }

  void begin(const View& v, int width, int height, std::span<const std::uint32_t> seen);
  void project();
  void cull();
  void show();

  void insert(const PixelSample&);
  bool answers(const PixelSample&) const;
  bool average(std::uint32_t at, const PixelSample&);
  std::uint32_t room();
  void evict(std::uint32_t point);

  float standingOf(const Point&) const;
  float priority(std::size_t pixel) const;
  PixelRay ray(const View& from, std::size_t pixel) const;
  void predict(std::size_t count, const View& next, std::vector<PixelRay>& rays) const;
};

RenderCache::RenderCache(RenderCacheSettings settings) : state_(std::make_unique<State>()) {
  DELTALUX_CHECK(settings.samplesPerPixel > 0 && settings.prediction >= 0 && settings.prediction <= 1,
                 "a store has room, a share is one");
  state_->settings = settings;
}
RenderCache::~RenderCache() = default;
RenderCache::RenderCache(RenderCache&&) noexcept = default;
RenderCache& RenderCache::operator=(RenderCache&&) noexcept = default;

// The store.

/// Whether it is what the present view asked for in its pixel.
bool RenderCache::State::answers(const PixelSample& s) const {
  if (s.pixel >= pixels() || asked[s.pixel] == 0) return false;
  if (view.kind == View::Kind::Perspective && s.eye != Vec3f(view.position)) return false;
  if (!s.primitive.valid()) return true;
  const rendering::PixelPlace at = projection(s.position);
  const auto off = [](float x, std::uint32_t centre) { return std::abs(x - (static_cast<float>(centre) + 0.5f)); };
  const std::uint32_t width = static_cast<std::uint32_t>(frame.width);
  return at.depth > 0 && off(at.x, s.pixel % width) < kOffCentre && off(at.y, s.pixel / width) < kOffCentre;
}

/// Takes the sample into the mean of its pixel. Of that only one path is known then, so that any change makes it stale.
bool RenderCache::State::average(std::uint32_t at, const PixelSample& s) {
  Point& p = points[at];
  PixelSample& mean = samples[at];
  if (!own(at) || !s.noisy || !p.noisy || p.surface != s.primitive.value + 1) return false;
  const float n = p.rays;
  if (p.rays < kMostRays) ++p.rays;
  p.radiance = mean.radiance = (n * p.radiance + s.radiance) / (n + 1);
  mean.version = std::min(mean.version, s.version);
  mean.complete = false;
  p.born = frameNumber;
  standing[s.pixel] = standingOf(p);
  return true;
}

void RenderCache::State::evict(std::uint32_t i) {
  const Point& p = points[i];
  if (own(i) && p.pixel < pixels()) answered[p.pixel] = 0;
  if (p.shownAt < pixels() && shown[p.shownAt].point == i) shown[p.shownAt] = {};
}

/// A place for a new sample: at the end, or that of the oldest of the next few.
std::uint32_t RenderCache::State::room() {
  const auto most = static_cast<std::size_t>(settings.samplesPerPixel * static_cast<double>(pixels()));
  if (points.size() < std::max(most, kGroup)) {
    points.emplace_back(), samples.emplace_back();
    return static_cast<std::uint32_t>(points.size() - 1);
  }
  std::size_t oldest = hand % points.size();
  for (std::size_t k = 0; k < kGroup; ++k, ++hand)
    if (const std::size_t i = hand % points.size(); points[i].born < points[oldest].born) oldest = i;
  const auto at = static_cast<std::uint32_t>(oldest);
  evict(at);
  return at;
}

void RenderCache::State::insert(const PixelSample& s) {
  const bool answer = answers(s);
  if (answer) asked[s.pixel] = 0, answered[s.pixel] = 1;
  if (!s.primitive.valid()) return;
  std::uint32_t at = answer ? shown[s.pixel].point : kNobody;
  if (at != kNobody && average(at, s)) return;
  if (at == kNobody || points[at].surface != s.primitive.value + 1) at = room();
  samples[at] = s;
  Point& p = points[at];
  p = {s.apparent, s.primitive.value + 1, s.radiance, s.pixel, answer ? viewNumber : 0, frameNumber};
  p.noisy = s.noisy;
  if (!answer || surfaces[s.pixel] != p.surface) return;
  p.shownAt = s.pixel;
  shown[s.pixel] = {-projection(s.apparent).depth, at};
  standing[s.pixel] = standingOf(p);
}

void RenderCache::insert(std::span<const PixelSample> samples) {
  state_->stands = state_->stands && samples.empty();
  for (const PixelSample& s : samples) state_->insert(s);
}

std::size_t RenderCache::retire(const SampleChanges& changes) {
  State& s = *state_;
  std::size_t count = 0;
  for (std::size_t i = 0; i < s.points.size(); ++i) {
    State::Point& p = s.points[i];
    if (!p.outdated && changes.stale(s.samples[i])) {
      p.outdated = true;
      p.view = p.born = 0;
      if (p.pixel < s.pixels()) s.answered[p.pixel] = 0, s.asked[p.pixel] = 0;
      ++count;
    } else if (!p.outdated) {
      s.samples[i].version = std::max(s.samples[i].version, changes.version);
    }
  }
  s.stands = s.stands && count == 0;
  return count;
}

std::span<const PixelSample> RenderCache::samples() const { return state_->samples; }

void RenderCache::clear() {
  State fresh;
  fresh.settings = state_->settings;
  *state_ = std::move(fresh);
}

// Frames.

void RenderCache::State::begin(const View& v, int width, int height, std::span<const std::uint32_t> seen) {
  const auto count = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  DELTALUX_CHECK(width > 0 && height > 0 && seen.size() == count, "a frame has a surface for each of its pixels");
  ++frameNumber;
  const bool sameSize = width == frame.width && height == frame.height;
  if (viewNumber == 0 || !sameSize || !sameView(v, view)) {
    ++viewNumber;
    view = v, projection = rendering::ViewProjection(v, width, height);
    streams.assign(count, 0), asked.assign(count, 0), answered.assign(count, 0);
  } else {
    for (std::size_t p = 0; p < count; ++p)
      if (surfaces[p] != seen[p]) answered[p] = 0;
  }
  surfaces.assign(seen.begin(), seen.end());
  frame.width = width, frame.height = height;
  frame.pixels.assign(count, glm::vec4(0.0f));
  shown.assign(count, {});
  standing.assign(count, 0.0f);
  held.resize(width, height);
}

/// A pixel's own sample comes first, then the nearest, and what is outdated last.
void RenderCache::State::project() {
  const float width = static_cast<float>(frame.width), height = static_cast<float>(frame.height);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& point = points[i];
    std::size_t pixel = point.pixel;
    const rendering::PixelPlace at = projection(point.apparent);
    float depth = -at.depth;
    if (point.view != viewNumber) {
      // Not so written that what is no number passes.
      if (!(at.depth > 0 && at.x >= 0 && at.x < width && at.y >= 0 && at.y < height)) continue;
      pixel = static_cast<std::size_t>(at.y) * frame.width + static_cast<std::size_t>(at.x);
      depth = at.depth;
    }
    if (point.outdated) depth = kOutdated;
    if (surfaces[pixel] == point.surface && depth < shown[pixel].depth)
      shown[pixel] = {depth, static_cast<std::uint32_t>(i)};
  }
}

/// Takes samples away that shine through what is before them. [WDP99 4.2]
void RenderCache::State::cull() {
  std::vector<std::size_t> hidden;
  for (int y = 1; y + 1 < frame.height; ++y)
    for (int x = 1; x + 1 < frame.width; ++x) {
      const std::size_t p = static_cast<std::size_t>(y) * frame.width + x;
      if (shown[p].point == kNobody || shown[p].depth < 0) continue;
      int around = 0, nearer = 0;
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const std::size_t q = p + static_cast<std::ptrdiff_t>(dy) * frame.width + dx;
          if (q == p || shown[q].point == kNobody || surfaces[q] != surfaces[p]) continue;
          ++around, nearer += std::abs(shown[q].depth) < kNearer * shown[p].depth;
        }
      if (nearer > 1 && 2 * nearer > around) hidden.push_back(p);  // most, and not one alone
    }
  for (const std::size_t p : hidden) shown[p] = {};
}

void RenderCache::State::show() {
  frame.wanted = frame.held = 0;
  for (int y = 0; y < frame.height; ++y)
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t p = static_cast<std::size_t>(y) * frame.width + x;
      if (p + kAhead < pixels() && shown[p + kAhead].point != kNobody)
        prefetch(std::span(&points[shown[p + kAhead].point], 1));
      if (surfaces[p] == 0) continue;
      ++frame.wanted;
      if (shown[p].point == kNobody) continue;
      ++frame.held;
      Point& point = points[shown[p].point];
      point.shownAt = static_cast<std::uint32_t>(p);
      frame.pixels[p] = glm::vec4(point.radiance, 1.0f);
      standing[p] = standingOf(point);
      held.set(x, y);
    }
  rendering::fillFrame(frame, held, surfaces);
}

const CacheFrame& RenderCache::frame(const View& view, int width, int height, std::span<const std::uint32_t> surfaces) {
  State& s = *state_;
  if (s.stands && width == s.frame.width && height == s.frame.height && sameView(view, s.view) &&
      std::equal(surfaces.begin(), surfaces.end(), s.surfaces.begin(), s.surfaces.end())) {
    ++s.frameNumber;
    return s.frame;
  }
  s.begin(view, width, height, surfaces);
  s.project();
  s.cull();
  s.show();
  s.stands = true;
  return s.frame;
}

// Rays.

/// Of a sample that is shown: a pixel's own is good, but for chance; others by their age.
float RenderCache::State::standingOf(const Point& point) const {
  if (point.outdated) return kEmpty;
  if (point.view == viewNumber)
    return point.noisy && point.rays < kMostRays ? rendering::tuning::kOld / static_cast<float>(point.rays) : 0.0f;
  const float age = static_cast<float>(frameNumber - point.born);
  return rendering::tuning::kOld * std::min(age / kMostRays, 1.0f);
}

float RenderCache::State::priority(std::size_t p) const {
  if (surfaces[p] == 0 || (asked[p] != 0 && frameNumber - asked[p] < rendering::tuning::kAwaited)) return 0;
  const bool ownSample = shown[p].point != kNobody && shown[p].depth < 0;
  if (answered[p] && !ownSample) return 0;  // by a ray that met something else than is drawn
  if (shown[p].point != kNobody) return standing[p];
  return kEmpty + (rendering::tuning::kOld - kEmpty) * frame.pixels[p].w;
}

PixelRay RenderCache::State::ray(const View& from, std::size_t pixel) const {
  const auto width = static_cast<std::size_t>(frame.width);
  const ViewRay r = viewRay(from, (static_cast<double>(pixel % width) + 0.5) / frame.width,
                            (static_cast<double>(pixel / width) + 0.5) / frame.height);
  return {Vec3f(r.origin), Vec3f(r.direction), static_cast<std::uint32_t>(pixel), 0};
}

/// Where the next view will have nothing to show: middles of empty cells, as far as what lies there is seen now, or
/// beside a surface at the border that wants samples.
void RenderCache::State::predict(std::size_t count, const View& next, std::vector<PixelRay>& rays) const {
  const rendering::ViewProjection ahead(next, frame.width, frame.height);
  const int across = (frame.width + kPredicted - 1) / kPredicted, down = (frame.height + kPredicted - 1) / kPredicted;
  std::vector<char> occupied(static_cast<std::size_t>(across) * static_cast<std::size_t>(down), 0);
  for (const Point& point : points) {
    const rendering::PixelPlace at = ahead(point.apparent);
    if (at.depth > 0 && at.x >= 0 && at.y >= 0 && at.x < static_cast<float>(frame.width) &&
        at.y < static_cast<float>(frame.height))
      occupied[static_cast<std::size_t>(static_cast<int>(at.y) / kPredicted) * across +
               static_cast<std::size_t>(static_cast<int>(at.x) / kPredicted)] = 1;
  }
  std::vector<PixelRay> candidates;
  for (int y = 0; y < down; ++y)
    for (int x = 0; x < across; ++x) {
      if (occupied[static_cast<std::size_t>(y) * across + x]) continue;
      const int px = std::min(x * kPredicted + kPredicted / 2, frame.width - 1),
                py = std::min(y * kPredicted + kPredicted / 2, frame.height - 1);
      const PixelRay r = ray(next, static_cast<std::size_t>(py) * frame.width + px);
      const rendering::PixelPlace now = projection.ofDirection(r.direction);
      if (!(now.depth > 0)) continue;
      const auto clamped = [](float v, int size) {
        return static_cast<std::size_t>(std::clamp(v, 0.0f, static_cast<float>(size - 1)));
      };
      if (surfaces[clamped(now.y, frame.height) * frame.width + clamped(now.x, frame.width)] != 0)
        candidates.push_back(r);
    }
  const std::size_t taken = std::min(count, candidates.size());
  for (std::size_t i = 0; i < taken; ++i) rays.push_back(candidates[i * candidates.size() / taken]);
}

std::vector<PixelRay> RenderCache::wanted(std::size_t count, const View& next) {
  State& s = *state_;
  std::vector<PixelRay> rays;
  if (s.viewNumber == 0) return rays;
  if (!sameView(next, s.view))
    s.predict(static_cast<std::size_t>(s.settings.prediction * static_cast<double>(count)), next, rays);
  std::vector<float> priorities(s.pixels());
  for (std::size_t p = 0; p < priorities.size(); ++p) priorities[p] = s.priority(p);
  for (const std::uint32_t p : rendering::chooseByPriority(priorities, s.frame.width, count - rays.size())) {
    PixelRay ray = s.ray(s.view, p);
    ray.index = s.streams[p]++;
    s.asked[p] = s.frameNumber;
    rays.push_back(ray);
  }
  return rays;
}

}  // namespace deltalux
