#pragma once
// Motion: frames that take edits in as far as their time goes, and what they put off until there is time. [GD01 4.3]
//
// In every frame the scene and the ray tracer follow at once. Of the particles that the edits touch those that deposit
// the most light are traced anew, as many as fit; the others lie where they were, whole, so that no light is there
// twice and none is lost. Their light is brought to the elements and handed on by as many iterations as fit. Textures
// keep their picture and are multiplied to the flux that their surface has now.
//
// Links go from where things were last to where they are in one step: in a frame that has the time for it, or in one of
// kFramesBetween or more, which takes as long as it must. The rows below them then follow in slices (row_queue.hpp),
// those near what moved with the most light first. Rays of a slice see things where they are by then, so the bounds
// from which links go next are those of all places that rows have seen. (Departure: the paper re-emits a share of the
// links that the user sets; here time sets it.)
//
// How long parts of a frame take is learned from frame to frame.
#include <chrono>
#include <cmath>
#include <limits>

#include "engine/row_queue.hpp"
#include "engine/scene_update.hpp"
#include "particles/particle_tracing.hpp"
#include "particles/transfer.hpp"
#include "solution/solution.hpp"

namespace deltalux::engine {

/// Seconds that a kind of work takes, by what it took before.
class LearnedCost {
 public:
  explicit LearnedCost(double guess) : seconds_(guess) {}

  double seconds() const { return seconds_; }
  bool known() const { return std::isfinite(seconds_); }
  /// `count` pieces took so long.
  void learn(double seconds, double count = 1) {
    if (!(count > 0)) return;
    const double found = seconds / count;
    seconds_ = std::isfinite(seconds_) ? seconds_ + kNew * (found - seconds_) : found;
  }

 private:
  static constexpr double kNew = 0.5;
  double seconds_;
};

/// What edits that were taken in have still to do.
struct Backlog {
  // What waits.
  SceneUpdate links;         // edits that links have not seen, from where they stand
  RowQueue rows;             // that follow links
  int framesSinceLinks = 0;  // since links last followed, and when that was
  std::chrono::steady_clock::time_point linksFollowed = std::chrono::steady_clock::now();
  std::vector<hierarchy::ElementId> reflecting;  // that were black
  std::vector<hierarchy::ElementId> painted;     // input-level patches whose reflectance is another
  std::vector<hierarchy::ElementId> rescaled;    // leaves that gather otherwise by that
  bool dimmed = false;                           // some light sends otherwise
  bool afresh = false;                           // only solving the scene anew helps
  particles::ParticleUpdate landed;  // paths traced anew since textures were last looked at, and what they were then
  std::vector<caustics::SurfaceCaustics> textures;  // as they were when they were last looked at
  bool frames = false;                              // some frame has been shown since

  LearnedCost path{3e-6};                                       // traced anew
  LearnedCost carry{0.01};                                      // what was traced taken into transfers and textures
  LearnedCost deposit{0.01};                                    // particles' light brought to the elements
  LearnedCost pass{0.1};                                        // one gathering over all rows
  LearnedCost row{1e-4};                                        // made anew, or looked at for it
  LearnedCost follow{std::numeric_limits<double>::infinity()};  // of links, and rows that cannot wait; not known yet

  bool linksWait() const { return !links.moved.empty() || !links.movedLights.empty(); }
  /// Whether links may follow in a frame that is too short for it.
  bool linksAreDue() const;
  /// Adds what a later edit did; where things were first is where they were.
  void add(const SceneUpdate&);
  /// Rows have seen things where they are now.
  void addSeen(const Scene&);
  /// Adds paths traced anew; what they were first is what they were.
  void add(const particles::ParticleUpdate&);
};

/// What a path deposits today, gray [W, with the scene's unit squared as area].
double deposited(const Solution&, const particles::ParticleTransfer&, std::size_t path);

/// One frame in so many may be longer than asked, for links to follow; and so much of the time may they take.
inline constexpr int kFramesBetween = 25;
inline constexpr double kLinksShare = 0.2;
/// Moves whose rows wait, at most: links wait for them then.
inline constexpr int kMostMoves = 4;

/// Twice the light that falls on the things that moved, where they stood: about what will be another when links and
/// rows follow, since where they are now it is about as much. Gray [W, as above].
double lightOn(const Solution&, const SceneUpdate&);

/// Flux that textured sides lose and gain by paths that are traced anew, by index of Caustics::surfaces.
class TextureFlux {
 public:
  explicit TextureFlux(const Solution& s) : solution_(s), change_(s.caustics.surfaces.size(), RgbSum(0.0)) {}

  /// What the paths were is taken out: before `transfer` follows. What they are is put in: after.
  void takeOut(const particles::ParticleUpdate&, const particles::ParticleTransfer&);
  void putIn(const particles::ParticleUpdate&, const particles::ParticleTransfer&);
  /// Multiplies the textures, of pictures as they are in `still`. Returns how many surfaces that was.
  std::size_t apply(caustics::Caustics&, const std::vector<caustics::SurfaceCaustics>& still) const;

 private:
  void add(const particles::PathRange&, const Rgb& power);

  const Solution& solution_;
  std::vector<RgbSum> change_;
};

}  // namespace deltalux::engine
