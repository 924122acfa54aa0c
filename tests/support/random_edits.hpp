#pragma once
// A session of random edits of all kinds, one update each, and its way back.
#include <deltalux/engine.hpp>
#include <filesystem>

#include "base/random.hpp"

namespace deltalux::test {

/// What may be edited. Every list has something in it.
struct Editable {
  std::vector<std::string> objects;
  std::vector<std::string> lights;  // that may be dimmed, coloured and switched
  std::vector<std::string> placed;  // lights that may be moved and aimed
  std::vector<std::string> paints;  // materials with a reflectance
  std::vector<std::string> rough;   // materials with a roughness
  double reach = 0.2;               // of a move, at most along each axis [scene units]
};

/// All of a scene that has a name, but of its objects only those that a list of edits (bench/edits/*.txt) has as things
/// and lamps, where one is given.
Editable everythingIn(const Scene&, const std::filesystem::path& list = {});

class RandomEdits {
 public:
  RandomEdits(Engine& engine, Editable what, std::uint64_t seed)
      : engine_(engine), what_(std::move(what)), rng_(seed), scaled_(what_.lights.size(), 0) {}

  /// One edit and the update to it.
  StepReport step();
  /// Takes all edits back, last first, a few an update.
  void undoAll();
  std::size_t done() const { return undo_.size(); }
  /// What the last step did, for messages.
  const std::string& last() const { return last_; }

 private:
  Edit choose();
  Edit turn(const std::string& object);
  Edit dim();
  const std::string& pick(const std::vector<std::string>& names) { return names[pickIndex(names.size())]; }
  std::size_t pickIndex(std::size_t count) {
    return static_cast<std::size_t>(rng_.uniform() * static_cast<double>(count));
  }
  double between(double a, double b) { return a + (b - a) * rng_.uniform(); }

  Engine& engine_;
  Editable what_;
  Rng rng_;
  std::vector<int> scaled_;  // by light: doublings so far
  std::vector<Restore> undo_;
  std::vector<Restore> gone_;  // brings removed objects back
  std::string last_;
};

}  // namespace deltalux::test
