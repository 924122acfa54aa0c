#pragma once
// The thread that owns the engine. The window's thread tells it what to do and never waits for it; what it has found it
// leaves in a box, from which the window's thread takes the newest at every frame.
//
// In order of precedence it: takes edits in, by frames of the engine while the hand moves, in whole once it rests;
// traces rays that the Render Cache asks for; answers questions; and when there is nothing else to do makes the picture
// of the view that is looked at better, until that is what `deltalux render` would make. Then it sleeps.
#include <deltalux/contributions.hpp>
#include <deltalux/edit.hpp>
#include <deltalux/engine.hpp>
#include <deltalux/image.hpp>
#include <deltalux/pixel_sample.hpp>
#include <deltalux/probe.hpp>
#include <deltalux/render.hpp>
#include <deltalux/solution_mesh.hpp>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace deltalux::viewer {

enum class Phase { Opening, Solving, Moving, Settling, Settled, Failed };

struct Status {
  Phase phase = Phase::Opening;
  double fraction = 0;       // of Opening and Solving that is done
  bool exact = true;         // the mesh that was published last is the solution's to the bit, not just as it shows
  double staleShare = 0;     // light that is not yet where it would be, of all that lamps emit: 0 to 1
  std::string message;       // Failed: what is wrong. Else of an edit that was refused, until the next; or that waits
  double settleSeconds = 0;  // of the last Settling
  StepReport step;           // the last frame's or update's
  std::uint64_t edits = 0;   // taken in so far: the number that Solver::apply has returned for the last of them
};

/// The picture that is made better at rest.
struct Picture {
  View view;
  std::uint64_t version = 0;  // of the mesh snapshot that it is of
  Image image;
  std::vector<std::uint32_t> rays;  // by pixel
  bool done = false;
};

/// Illuminance meters: what was pinned, and what it reads at a version.
struct Readings {
  std::uint64_t version = 0;
  std::uint64_t pinned = 0;          // what Solver::pin has returned for these points
  bool exact = false;                // as `deltalux probe` has it; otherwise the mesh's own values, as in motion
  std::vector<ProbeResult> results;  // of the points that were asked for
};

/// What one question was answered.
struct Answer {
  std::uint64_t question = 0;
  std::uint64_t version = 0;
  ProbeResult reading;          // as `deltalux probe` has it
  std::optional<Rgb> radiance;  // L towards the eye [W/(sr m2)], when there is one
  Contributions contributions;
};

class Solver {
 public:
  struct Settings {
    double frameMs = 33;
    double motionShare = 1;  // of a frame's time that light may take in motion, (0, 1] [GD01 4.3]
    RenderSettings picture;  // width and height are the window's
  };
  /// `open` runs on the solver's thread: reads the scene or solution. It may report progress, and throws InputError.
  using Open = std::function<std::unique_ptr<Engine>(Progress&)>;
  Solver(Open open, Settings);
  ~Solver();  // stops what is going on, at its next step

  // From the window's thread. All return at once.
  /// Edits to take in; those that come while the scene is being solved wait for that to end. `moving`: more will
  /// follow; otherwise it settles after them. Returns the number of edits so far.
  std::uint64_t apply(std::vector<Edit>, bool moving);
  /// The hand rests: settle.
  void rest();
  /// An object that will be dragged next.
  void select(const std::string& object);
  /// What is looked at; `first`: pixels that want their rays first (ProgressiveRender). nullopt: nothing to make
  /// better.
  void look(std::optional<View>, int width, int height, std::vector<char> first);
  /// Rays to trace, in place of those asked for before that are not traced yet.
  void want(std::vector<PixelRay>);
  /// Meters whose readings are to follow every change, in place of those before. Returns the number of calls so far.
  std::uint64_t pin(std::vector<ProbePoint>);
  /// Takes the place of a question that is not answered yet. `eye`: who looks there. Returns its number.
  std::uint64_t ask(const ProbePoint&, std::optional<Vec3> eye = std::nullopt);
  /// Writes the solution once what is going on is settled; `written` is called on the solver's thread, with an empty
  /// text or what went wrong.
  void save(const std::string& file, std::function<void(std::string)> written);
  /// Light meter by meter, exactly; waits until it is settled. For scripts and tests. Throws std::runtime_error when it
  /// has failed.
  std::vector<ProbeResult> measure(std::vector<ProbePoint>);

  // What it has found: the newest of each. Null: none yet.
  Status status() const;
  std::shared_ptr<const SolutionMesh> mesh() const;
  std::shared_ptr<const Picture> picture() const;
  std::shared_ptr<const Readings> readings() const;
  std::shared_ptr<const Answer> answer() const;
  /// Samples since the last call.
  std::vector<PixelSample> takeSamples();
  /// Tells which samples are stale; never null once there is a mesh.
  std::shared_ptr<const SampleChanges> changes() const;
  /// Called on the solver's thread whenever there is something new: wakes the window.
  void onChange(std::function<void()>);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace deltalux::viewer
