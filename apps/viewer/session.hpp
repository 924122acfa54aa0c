#pragma once
// What a person has done: the scene as edits have made it, undo and redo (one step a drag), stored states, and a record
// of it all that can be replayed. Plain values; no window, no engine.
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
  Session(Scene scene, Recording start, std::filesystem::path record);

  const Scene& scene() const { return scene_; }
  const Recording& recording() const { return recording_; }

  /// One step. Returns what the engine has to apply. Throws InputError and is as before.
  Edit apply(const Edit&);
  /// A drag: any number of maps after one another, all of them one step. Each is relative to where the object was when
  /// the drag began, in the coordinates of the scene's files.
  void beginDrag(const std::string& object);
  Edit dragTo(const Mat4& fromStart);  // the engine's edit from where it is to there
  void endDrag();                      // one line in the record; none when it is where it was
  bool dragging() const { return drag_.has_value(); }
  const std::string& dragged() const { return drag_->object; }

  bool canUndo() const { return !undo_.empty(); }
  bool canRedo() const { return !redo_.empty(); }
  Edit undo();  // what the engine has to apply; precondition canUndo()
  Edit redo();

  /// A state of scene and light that can be looked at beside another, and restored.
  struct Stored {
    std::string name;
    std::shared_ptr<const SolutionMesh> mesh;
    Restore state;  // of all that edits can change
  };
  void store(std::size_t slot, std::string name, std::shared_ptr<const SolutionMesh>);
  const std::vector<std::optional<Stored>>& stored() const { return stored_; }
  /// One step, as apply().
  Edit restore(std::size_t slot);

  /// Everything that edits can change, as it is now.
  Restore wholeState() const;

 private:
  struct Step {
    Restore back, forth;
  };
  struct Drag {
    std::string object;
    Mat4 now{1.0};
    std::optional<Restore> before;
  };
  void record(EditStep);

  Scene scene_;
  Recording recording_;
  std::filesystem::path file_;
  std::vector<Step> undo_, redo_;
  std::optional<Drag> drag_;
  std::vector<std::optional<Stored>> stored_;
};

}  // namespace deltalux::viewer
