#pragma once
// What a move does to links [GD01 5]: those that it touches are found by the line-space traversal, where things stand
// before they leave; they are evaluated again where things have arrived, refined or made coarse again. The light that
// they brought is taken out of their receivers, and what they bring now is put in (irradiance_lists.hpp). Cost: some
// 0.1 microseconds a link visited, and what evaluating costs those that are touched.
#include <deltalux/edit.hpp>

#include "paper/irradiance_lists.hpp"
#include "paper/line_space.hpp"
#include "paper/solve.hpp"

namespace deltalux::paper {

/// What moves leaves its place: the links that it touches there and where it goes, and the shapes of its elements. The
/// scene has it in its new place, elements in the old one.
LinkMarks leave(const Parts&, std::span<const SceneChange::Moved>, std::span<const LightId>);

/// What has come into the light since: elements of their own (a root, or none), and others that slept or were black.
struct Newcomers {
  hierarchy::ElementId root;
  std::span<const hierarchy::ElementId> reactivated;
  std::span<const hierarchy::ElementId> inactive;  // and what has left it
};

/// It comes to its new place, and newcomers with it: adds the links of these to the marks.
void arrive(const Parts&, LinkMarks&, const Newcomers&);

/// Evaluates the marked links again. `lists`: of the light that they bring.
RefineReport follow(const Parts&, LinkMarks&, const OracleSettings&, IrradianceLists& lists);

}  // namespace deltalux::paper
