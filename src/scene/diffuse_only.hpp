#pragma once
#include <deltalux/scene.hpp>

namespace deltalux::scene {

/// The scene without specular light: lobes off, mirrors and glass bodies black; thin panes pass light straight on and
/// do not reflect (isPane still holds for them). Lets the diffuse solver be judged alone.
void dropSpeculars(Scene&);

}  // namespace deltalux::scene
