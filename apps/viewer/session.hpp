#pragma once
// What a person has done: the scene as edits have made it, undo and redo (one step a drag), stored states, and a record
// of it all that can be replayed. Plain values; no window, no engine.
//
// Whoever keeps another copy of the scene, as the engine does, applies what the functions return, in order, and has the
// very same scene: names and numbers of all things included.
#include <deltalux/edit.hpp>
#include <deltalux/edit_io.hpp>
#include <deltalux/solution_mesh.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace deltalux::viewer {

class Session {
 public:
  /// `record`: where the session is written after every action, in the format of `deltalux replay`; empty: nowhere.
  /// The scene has its area lights, and is what `start` leads to.
  Session(Scene scene, Recording start, std::filesystem::path record);

  const Scene& scene() const { return scene_; }
  const Recording& recording() const { return recording_; }
  /// What went wrong when the record was written last; empty: nothing.
  const std::string& recordProblem() const { return recordProblem_; }

  /// One step. Returns what the engine has to apply. Throws InputError and is as before. Ends a drag first.
  Edit apply(const Edit&);

  /// A drag of an object, or of a light that belongs to none: any number of maps after one another, all of them one
  /// step. Each is relative to where it was when the drag began, in the coordinates of the scene's files. A light that
  /// belongs to no object goes where the map takes it, and is not turned. Throws InputError: nothing of that name can
  /// be moved.
  void beginDrag(const std::string& object);
  /// Returns the engine's edits from where it is to there. Throws InputError, and it stays where it is.
  std::vector<Edit> dragTo(const Mat4& fromStart);
  void endDrag();  // one line in the record; none when it is where it was
  bool dragging() const { return drag_.has_value(); }
  const std::string& dragged() const { return drag_->object; }  // precondition dragging()

  /// A value under the hand, such as a dimmer: each edit takes the place of the one before, all of them are one step.
  /// Throws InputError and is as before.
  std::vector<Edit> adjust(const Edit&);
  void endAdjust();  // one line in the record
  bool adjusting() const { return adjust_.has_value(); }

  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  Edit undo();  // what the engine has to apply; precondition canUndo(). Ends a drag first
  Edit redo();

  /// A step that was done, and what takes it back.
  struct Step {
    std::uint64_t number = 0;  // its own; the same step done again keeps it
    Edit edit;                 // as the record has it
    Restore inverse;
  };
  /// A state of scene and light that can be looked at beside another, and restored: the steps that lead to it from the
  /// scene as it was opened.
  struct Stored {
    std::string name;
    std::shared_ptr<const SolutionMesh> mesh;
    std::vector<Step> steps;
  };
  void store(std::size_t slot, std::string name, std::shared_ptr<const SolutionMesh>);
  const std::vector<std::optional<Stored>>& stored() const { return stored_; }
  /// Goes to the stored state, exactly: undoes the steps that do not lead there, then redoes those that do, or does
  /// them again where others took their place. The record says the same. Returns the engine's edits, in order.
  /// Precondition: something is stored there.
  std::vector<Edit> restore(std::size_t slot);

 private:
  struct Undone {
    Step step;
    Restore forth;
  };
  struct Drag {
    std::string object;
    Mat4 now{1.0};
    std::optional<Restore> before;  // of all that it moves, once it has moved
    std::size_t materials = 0;      // of the scene, before those that it has made for itself
  };
  Edit dragEdit(const Mat4& fromStart) const;
  std::vector<Edit> moveDragged(const Mat4& fromStart);
  Edit stepBack();
  Edit stepForth();
  Edit takeStep(const Edit&, std::uint64_t number);
  void write();

  Scene scene_;
  Recording recording_;
  std::filesystem::path file_;
  std::string recordProblem_;
  std::vector<Step> undo_;
  std::vector<Undone> redo_;
  std::uint64_t steps_ = 0;
  struct Adjust {
    Edit edit;
    Restore before;
  };
  void endGesture();

  std::optional<Drag> drag_;
  std::optional<Adjust> adjust_;
  std::vector<std::optional<Stored>> stored_;
};

}  // namespace deltalux::viewer
