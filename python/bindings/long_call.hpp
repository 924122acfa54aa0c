#pragma once
// Long work, off the interpreter's lock.
#include <pybind11/pybind11.h>

#include <cstddef>
#include <deltalux/progress.hpp>
#include <functional>

namespace deltalux::python {

/// Runs `work`, which must not touch Python, on a thread of its own and waits for it without the interpreter's lock.
/// The calling thread sees to signals and calls `progress(phase, fraction)`, unless that is None, some times a second:
/// an exception of either (KeyboardInterrupt) asks the work to stop, and is raised when it has. Throws what `work`
/// throws. `threads`: at most so many for the work; 0: as many as there are.
void runLong(const pybind11::object& progress, std::size_t threads, const std::function<void(Progress&)>& work);

}  // namespace deltalux::python
