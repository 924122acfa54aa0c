#pragma once
// Before and after: undo and redo, what was done, states A and B.
#include "tools.hpp"

namespace deltalux::viewer {

void statePanel(Controller&, Tools&);
void historyPanel(Controller&);
/// A step of the record as a person would say it: "transform armchair", "undo".
std::string describe(const EditStep&);
/// The border between what is now and the state beside it, over the picture.
void wipeLine(const Tools&, float pictureWidth, float pictureHeight);

}  // namespace deltalux::viewer
