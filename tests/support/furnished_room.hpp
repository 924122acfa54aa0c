#pragma once
// A room with a table, a box, a brass pot, a glass ball, a mirror on the wall, a lamp and a spot; and what of it may be
// edited.
#include "support/random_edits.hpp"

namespace deltalux::test {

Scene furnishedRoom();
Editable editableOfFurnishedRoom();

}  // namespace deltalux::test
