#pragma once
// All that can be done in the viewer, whoever does it: hands, panels and scripts call the same functions. Owns the
// session and the solver; knows no window and no GL. One thread: the window's.
#include <array>
#include <deltalux/solution_reader.hpp>
#include <deque>

#include "camera.hpp"
#include "drawing.hpp"
#include "mesh_pick.hpp"
#include "session.hpp"
#include "solver.hpp"

namespace deltalux::viewer {

/// A meter that was pinned to a surface, and what it has read.
struct Probe {
  std::string name;
  ProbePoint point;
  double lux = 0;
  bool exact = false;
  std::deque<float> history;  // lux, at most 256, the newest last
};

/// A rectangle of meters: corner + i across + j along.
struct MeterField {
  Vec3 corner{0}, across{1, 0, 0}, along{0, 1, 0}, normal{0, 0, 1};
  int columns = 8, rows = 8;
  double mean = 0, least = 0, uniformity = 0;  // Em, Emin [lux], U0 = Emin / Em
  bool exact = false;
};

/// What is under the cursor.
struct UnderCursor {
  bool known = false;
  ProbePoint point;
  PrimitiveId primitive;
  ObjectId object;
  MaterialId material;
  double lux = 0, candelaPerSquareMetre = 0;
  std::optional<Contributions> contributions;  // once answered
};

class Controller {
 public:
  struct Source {
    Solver::Open open;
    std::function<Recording()> recording;  // of what was opened: files and settings, for the record. After `open`
    std::filesystem::path record;          // where the session is written
    std::optional<View> view;              // to begin with, in the coordinates of the scene's files
  };
  Controller(Source, Solver::Settings);

  // Every frame of the window.
  /// Takes over what is new. True when something has to be drawn again.
  bool takeChanges();
  /// The frame to draw.
  Frame frame() const;
  /// After drawing: asks for rays and for the picture at rest. `specular`: by pixel (Renderer::specularPixels).
  void drawn(const std::vector<char>& specular);
  RenderCache& cache() { return cache_; }

  // Looking.
  const View& camera() const { return camera_; }  // its angles fit the window
  void setCamera(const View&);
  void setSize(int width, int height);
  void bookmark(int slot);      // keeps the camera, 1 to 9
  bool goToBookmark(int slot);  // views of the scene fill the first of them
  void focusOnSelection();
  DrawSettings& draw() { return draw_; }  // exposure, false colour, overlays, section box: no solving follows
  void automaticExposure() { exposureWanted_ = true; }  // once, from what is drawn; it stays locked then
  /// Whether the next drawing's radiance is to be handed to wantExposureFrom().
  bool exposureWanted() const { return exposureWanted_ && ready(); }
  void wantExposureFrom(const Image& radiance);

  // Choosing. Names are those of edits files.
  void select(const std::string& objectOrLight);  // "": nothing. Throws InputError with near misses
  const std::string& selection() const { return selection_; }
  /// The thing at a pixel: the object at the top of its tree that a person would move, or with `deep` the lowest.
  std::string nameAt(double x, double y, bool deep = false) const;
  std::optional<SurfaceHit> hitAt(double x, double y) const;  // on the mesh that is drawn: no waiting

  // Editing: each call is one step. Throw InputError and change nothing.
  void edit(const Edit&);
  void beginDrag();  // of the selection
  void dragTo(const Mat4& fromStart);
  void endDrag();
  bool dragging() const { return session_ && session_->dragging(); }
  /// A value under the hand: edits follow one another, each in place of the one before, until it lets go.
  void adjust(const Edit&);
  void endAdjust();
  void undo();
  void redo();
  void dim(const std::string& light, double factor);  // of its present scale
  void colour(const std::string& light, const Rgb&);
  void switchLight(const std::string& light, bool on);
  void aim(const std::string& light, const Vec3& at);  // the point it shall shine at
  void lookThrough(const std::string& light);
  void paint(const std::string& material, const Rgb& reflectance);

  // States, A and B. Throw InputError where nothing is stored.
  void store(int slot);                 // 0: A, 1: B
  void compare(int slot, double wipe);  // beside what is now; wipe 1: off
  void restore(int slot);               // exactly, as undo and redo do

  // Measuring.
  void pointAt(double x, double y);  // the cursor: asks what is there
  const UnderCursor& underCursor() const { return cursor_; }
  void pinProbe(const std::string& name, const ProbePoint&);
  void unpinProbe(const std::string& name);
  const std::vector<Probe>& probes() const { return probes_; }
  void setField(std::optional<MeterField>);
  const std::optional<MeterField>& field() const { return field_; }
  void explain(const ProbePoint&);  // why is it bright here?
  const std::optional<Contributions>& explanation() const { return explanation_; }

  const Status& status() const { return status_; }
  bool ready() const { return session_ != nullptr; }        // there is something to look at
  bool settled() const;                                     // no edit waits, the light is that of the scene
  bool finished() const;                                    // settled, and the picture has all of its rays
  const Scene& scene() const { return session_->scene(); }  // as the session has it; precondition ready()
  Session& session() { return *session_; }                  // precondition ready()
  Solver& solver() { return *solver_; }
  std::string
      lastError;  // of an edit that the solver refused or a record that was not written; panels show and clear it

 private:
  // Questions to the solver wait for one another: it takes one at a time.
  struct Question {
    std::optional<ProbePoint> point;
    std::uint64_t number = 0;  // 0: not asked yet
    bool answered = false;
  };

  void begin();
  void takeMesh(std::shared_ptr<const SolutionMesh>);
  void takeReadings(const Readings&);
  void takeAnswer(const Answer&);
  void send(std::vector<Edit>, bool moving);
  void askNext();
  void lookUnderCursor();
  void pinMeters();
  std::optional<MeshHit> meshHit(double x, double y) const;
  std::vector<PrimitiveId> selectedPrimitives() const;
  std::optional<Ahead> ahead() const;
  LightId firstLight(const std::string& name) const;
  const std::optional<Session::Stored>& storedAt(int slot) const;
  View predicted() const;
  bool pictureFits() const;

  Source source_;
  std::unique_ptr<Session> session_;
  RenderCache cache_;
  Status status_;
  std::shared_ptr<const SolutionMesh> mesh_;
  MeshPick pick_;
  std::shared_ptr<const SampleChanges> changes_;
  bool looking_ = false;  // the solver knows what is looked at
  std::shared_ptr<const Picture> picture_;
  std::shared_ptr<const Readings> readings_;
  std::shared_ptr<const Answer> answer_;
  std::uint64_t editsSent_ = 0;
  bool resting_ = true;                 // the solver knows that no edit of a drag will follow
  std::vector<PrimitiveId> handMoved_;  // by the last edit or drag: they are drawn where the session has them

  View camera_;
  View drawnCamera_;         // of the frame before
  int stillRequests_ = 0;    // for rays of the cache, since anything changed
  std::size_t raysOut_ = 0;  // that have not come back
  int width_ = 0, height_ = 0;
  DrawSettings draw_;
  bool exposureWanted_ = false;
  std::string selection_;
  std::array<std::optional<View>, 10> bookmarks_;
  int compared_ = -1;
  double wipe_ = 1;
  std::array<bool, 2> storedEarly_{};  // before the light had settled, or was read to the bit: it follows

  std::optional<glm::dvec2> cursorAt_;  // pixels
  UnderCursor cursor_;
  Question cursorQuestion_, explainQuestion_;
  std::vector<Probe> probes_;
  std::optional<MeterField> field_;
  std::uint64_t pinned_ = 0;
  bool historyIsOfMesh_ = false;  // the newest of every probe: an exact one takes its place
  std::optional<Contributions> explanation_;
  std::unique_ptr<Solver> solver_;  // last: its thread ends first
};

}  // namespace deltalux::viewer
