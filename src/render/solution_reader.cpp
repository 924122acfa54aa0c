#include <deltalux/solution_reader.hpp>

#include "render/reader_state.hpp"

namespace deltalux {

SolutionReader::SolutionReader(SolutionView view) : state_(std::make_unique<rendering::ReaderState>(std::move(view))) {
  refresh();
}
SolutionReader::~SolutionReader() = default;
SolutionReader::SolutionReader(SolutionReader&&) noexcept = default;
SolutionReader& SolutionReader::operator=(SolutionReader&&) noexcept = default;

void SolutionReader::refresh() {
  rendering::ReaderState& s = *state_;
  ++s.version;
  s.reconstruction = std::make_unique<rendering::Reconstruction>(s.solution());
  s.changes = rendering::noteChanges(s, s.changes.get());
}

std::uint64_t SolutionReader::version() const { return state_->version; }
std::shared_ptr<const SampleChanges> SolutionReader::changes() const { return state_->changes; }

}  // namespace deltalux
