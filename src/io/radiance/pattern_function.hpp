#pragma once
// Patterns that multiply what a light emits or a surface reflects, evaluated natively: brightfunc, brightdata,
// colorfunc, colordata, colorpict, the sky functions of gensky and gendaylit; and the share of a mixfunc's first
// modifier. [Radiance reference manual, "Patterns", "Mixtures"]
//
// Function files are read where the program finds them, beside the scene, or from function_library.hpp. A pattern's
// coordinates are the world's, taken back through its own transform and those of the xforms around it. Departures: no
// noise, no recursion; the distance to what is lit (T, Ts) is taken to be large.
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <functional>
#include <map>
#include <memory>

#include "io/radiance/file_access.hpp"
#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

/// Where a ray that looks at a light meets it.
struct PatternPoint {
  Vec3 direction{0, 0, 1};  // unit, of the ray: against the light that leaves
  Vec3 normal{0, 0, -1};    // unit, towards the side that is looked at
  Vec3 position{0};
  double cosine = 1;  // between normal and the light that leaves, above 0
};

class PatternFunction {
 public:
  /// Throws InputError for what cannot be read or compiled. `calls` bounds the work of all evaluations; it is counted
  /// down.
  PatternFunction(const RadObject&, FileAccess&, long& calls);

  /// By which the pattern multiplies each channel. Throws InputError when the work is used up.
  glm::dvec3 operator()(const PatternPoint& p) const { return value_(p); }

  /// What its values depend on beside the direction.
  bool usesNormal() const { return usesNormal_; }  // beyond the cosine
  bool usesCosine() const { return usesCosine_; }
  bool usesPosition() const { return usesPosition_; }
  bool usesDistance() const { return usesDistance_; }
  /// Orthogonal; the pattern's axes in the world.
  const glm::dmat3& frame() const { return frame_; }

  /// Whether this kind of pattern can be read at all.
  static bool understands(const RadObject&);

 private:
  std::function<glm::dvec3(const PatternPoint&)> value_;
  bool usesNormal_ = false, usesCosine_ = false, usesPosition_ = false, usesDistance_ = false;
  glm::dmat3 frame_{1.0};
};

/// The functions of patterns, each made when it is first asked for.
class PatternFunctions {
 public:
  /// `user`: of the patterns, in reports: a light, a surface. `calls` bounds the work of all evaluations.
  PatternFunctions(std::string user, ImportReport& report, FileAccess& files, long calls)
      : user_(std::move(user)), report_(report), files_(files), calls_(calls) {}

  /// made(function) is told of each once; null where it cannot be evaluated, which is then in the report.
  template <class Made>
  const PatternFunction* of(const RadObject& object, const Made& made) {
    const auto [at, added] = made_.try_emplace(&object);
    if (!added) return at->second.get();
    try {
      at->second = std::make_unique<PatternFunction>(object, files_, calls_);
      made(*at->second);
    } catch (const InputError& error) {
      ++report_.ignored[object.typeName + " of a " + user_ + " (" + error.message() + ")"];
    }
    return at->second.get();
  }
  bool asked(const RadObject& pattern) const { return made_.contains(&pattern); }
  /// Counts work done beside calls. Throws InputError when all of it is used up.
  void spend(long calls) {
    calls_ -= calls;
    if (calls_ < 0) throw InputError("", 0, "its evaluation takes too long");
  }

 private:
  std::string user_;
  ImportReport& report_;
  FileAccess& files_;
  long calls_;
  std::map<const RadObject*, std::unique_ptr<PatternFunction>> made_;
};

}  // namespace deltalux::io::radiance
