#pragma once
// Ctrl-C and termination end long work in order: nothing is half-written. A second one ends the program at once.

namespace deltalux::cli {

void catchInterrupts();
bool interruptRequested();
/// Throws Interrupted when one was requested.
void throwIfInterrupted();

}  // namespace deltalux::cli
