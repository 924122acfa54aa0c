#include "io/solution_file.hpp"

#include <deltalux/error.hpp>

#include "hierarchy/fold.hpp"
#include "io/atomic_file.hpp"
#include "io/lower_case.hpp"
#include "io/mapped_file.hpp"
#include "io/solution_file/caustic_members.hpp"
#include "io/solution_file/packing.hpp"
#include "io/solution_file/references.hpp"
#include "io/solution_file/solution_members.hpp"

namespace deltalux {

namespace fs = std::filesystem;

namespace {

/// What goes into which section, in the order of the file.
void forEachSection(auto& solution, const auto& visit) {
  visit("SETT", solution.settings);
  visit("SCEN", solution.scene);
  visit("ELEM", solution.elements);
  visit("LINK", solution.links);
  visit("PART", solution.particles);
  visit("LINE", solution.lines);
  visit("DEVI", solution.deviation);
  visit("SCAL", solution.sampledScale);
  visit("CAUS", solution.caustics);
  visit("COLS", solution.columns);
  visit("REPT", solution.report);
}

Solution parse(std::string_view bytes, const std::string& file) {
  const std::vector<io::Section> sections = io::openContainer(bytes, file);
  Solution solution;
  auto section = sections.begin();
  forEachSection(solution, [&](std::string_view tag, auto& part) {
    if (section == sections.end() || section->tag != tag)
      throw InputError(file, 0, "is damaged: its sections are not those of a solution", "solve the scene again");
    io::ArchiveReader reader(section->payload, file);
    io::transfer(reader, part);
    reader.require(reader.left() == 0);
    ++section;
  });
  if (section != sections.end())
    throw InputError(file, 0, "is damaged: it has a section too many", "solve the scene again");
  return solution;
}

}  // namespace

bool isSolutionFile(const fs::path& file) { return io::lowerCase(file.extension().string()) == ".dlx"; }

}  // namespace deltalux

namespace deltalux::io {

namespace {

/// Elements that are away are not written: the file is that of a mesh that was made at once.
void pack(Packer& packer, const Solution&, const hierarchy::Elements& elements) {
  if (hierarchy::awayIn(elements) == 0) return transfer(packer, elements);
  const hierarchy::Elements present = hierarchy::compacted(elements);
  transfer(packer, present);
}
/// And lines in the order of those that are.
void pack(Packer& packer, const Solution& solution, const lines::Lines& lines) {
  const hierarchy::Elements& elements = solution.elements;
  const lines::Lines present = lines.empty() ? lines::Lines()
                                             : lines::renumbered(lines, hierarchy::numbersWithoutAway(elements),
                                                                 elements.size() - hierarchy::awayIn(elements));
  transfer(packer, present);
}
void pack(Packer& packer, const Solution&, const auto& part) { transfer(packer, part); }

}  // namespace

void writeSolution(const SolutionView& view, const ByteSink& sink) {
  std::vector<std::pair<std::string_view, std::string>> packed;
  forEachSection(view.get(), [&](std::string_view tag, const auto& part) {
    Packer packer;
    pack(packer, view.get(), part);
    packed.emplace_back(tag, packer.finish());
  });
  std::vector<Section> sections;
  for (const auto& [tag, payload] : packed) sections.push_back({tag, payload});
  writeContainer(sections, sink);
}

}  // namespace deltalux::io

namespace deltalux {

void saveSolution(const fs::path& path, const SolutionView& view) {
  io::AtomicFile file(path);
  io::writeSolution(view, [&](std::string_view bytes) { file.write(bytes); });
  file.commit();
}

}  // namespace deltalux

namespace deltalux::io {

SolutionView readSolution(std::string_view bytes, const std::string& file) {
  auto solution = std::make_shared<Solution>(parse(bytes, file));
  try {
    validate(solution->scene);
    checkTables(solution->scene);
    // As many as patches refer to follow from the scene.
    const auto& domains = solution->elements.domain;
    if (std::any_of(domains.begin(), domains.end(), [](const auto& d) { return d.order > 0; }))
      solution->elements.faceOrders = hierarchy::faceOrders(solution->scene);
    checkReferences(*solution);
  } catch (const std::logic_error& error) {
    throw InputError(file, 0, std::string("does not hold together: ") + error.what(), "solve the scene again");
  }
  solution->elements.listInputs();
  solution->elements.contacts = hierarchy::ContactLines(solution->elements, solution->scene);
  lines::setDirections(solution->lines, solution->elements, solution->scene);
  solution->tracer = tracing::makeEmbreeTracer(solution->scene);
  return SolutionView(std::move(solution));
}

}  // namespace deltalux::io

namespace deltalux {

SolutionView loadSolution(const fs::path& path) {
  const io::MappedFile file(path);
  return io::readSolution(file.bytes(), path.string());
}

}  // namespace deltalux
