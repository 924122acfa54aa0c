#pragma once
// Drawings on pages: a plan of illuminances, a polar curve.
#include <deltalux/glare.hpp>
#include <deltalux/plan.hpp>

#include "export/sheet/canvas.hpp"

namespace deltalux::exporting {

/// Within a box at `at`: false colours, lines of equal illuminance, values, a scale, sides in metres, and the place and
/// line of sight of `eye`, if given. Returns the height that it takes.
double drawPlan(Canvas&, const Vec2& at, const Vec2& box, const Plan&, const Eye* eye);

/// Planes C0-C180 and C90-C270 in a square of that side.
void drawPolar(Canvas&, const Vec2& at, double side, const Photometry&);

}  // namespace deltalux::exporting
