#include "io/radiance/expander.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "io/plain_text.hpp"
#include "io/radiance/command_line.hpp"
#include "io/radiance/compound.hpp"
#include "io/radiance/generators.hpp"
#include "io/radiance/lexer.hpp"
#include "io/radiance/xform.hpp"

namespace deltalux::io::radiance {

namespace fs = std::filesystem;

namespace {

/// How many numbers and words the objects hold, names aside.
std::size_t numbersIn(const Expander::Objects& objects) {
  std::size_t sum = 0;
  for (const RadObject& object : objects) {
    sum += object.reals.size() + object.strings.size() + (object.mesh ? 6 * object.mesh->positions.size() : 0);
  }
  return sum;
}

}  // namespace

std::shared_ptr<const Expander::Objects> Expander::expand(const SourceFile& file) {
  if (const auto known = expanded_.find(file.identity); known != expanded_.end()) return known->second;
  open_.push_back(file.identity);
  auto objects = std::make_shared<const Objects>(
      expandItems(parseRadiance(file.text, std::make_shared<const std::string>(file.name)), file.folder));
  open_.pop_back();
  expanded_[file.identity] = objects;
  return objects;
}

Expander::Objects Expander::expandItems(std::vector<RadItem> items, const fs::path& folder) {
  Objects objects;
  objects.reserve(items.size());
  double numbers = 0;
  for (RadItem& item : items) {
    auto* const object = std::get_if<RadObject>(&item);
    std::optional<Objects> parts;
    if (object && (object->type == Type::Instance || object->type == Type::Mesh))
      parts = compound(*object, folder, objects);
    if (object && !parts) {
      objects.push_back(std::move(*object));
      continue;
    }
    Objects made = object ? std::move(*parts) : run(std::get<RadCommand>(item), folder);
    numbers += static_cast<double>(numbersIn(made));
    checkSize(static_cast<double>(objects.size() + made.size()), numbers,
              object ? object->where : std::get<RadCommand>(item).where);
    objects.insert(objects.end(), std::make_move_iterator(made.begin()), std::make_move_iterator(made.end()));
  }
  return objects;
}

std::optional<Expander::Objects> Expander::compound(const RadObject& object, const fs::path& folder,
                                                    const Objects& before) {
  const std::string name = sourceOfCompound(object);
  const auto file = name.empty() ? std::nullopt : files_.open(name, folder);
  if (!file) return std::nullopt;
  std::shared_ptr<const Objects> source;
  if (object.type == Type::Instance)
    source = include(*file, object.where);
  else
    source = std::make_shared<const Objects>(surfacesOfObj(file->text, file->name, object.where, before));
  Objects result;
  appendPlaced(result, *source, placementOfCompound(object), object.where);
  return result;
}

std::shared_ptr<const Expander::Objects> Expander::include(const SourceFile& file, const SourceLine& where) {
  if (std::find(open_.begin(), open_.end(), file.identity) != open_.end())
    throw inputError(where, "'" + file.name + "' includes itself", "remove the cycle of files");
  if (open_.size() >= limits_.depth) throw inputError(where, "files include each other too deeply");
  return expand(file);
}

Expander::Objects Expander::run(const RadCommand& command, const fs::path& folder) {
  Objects objects;
  bool first = true;
  for (const std::vector<std::string>& words : parsePipeline(command.text, command.where)) {
    if (words[0] == "xform") {
      objects = transformed(words, first ? nullptr : &objects, command.where, folder);
    } else if (first) {
      objects = generate(words, command.where, folder);
    } else {
      throw inputError(command.where, "a pipe into '" + words[0].substr(0, 40) + "' is not supported",
                       "pipes may lead into xform; expand others beforehand: xform -e FILE > EXPANDED");
    }
    first = false;
  }
  return objects;
}

Expander::Objects Expander::generate(const std::vector<std::string>& words, const SourceLine& where,
                                     const fs::path& folder) {
  using Generator = std::vector<RadObject> (*)(const GeneratorInput&);
  static constexpr std::pair<std::string_view, Generator> kGenerators[] = {
      {"genbox", genbox},   {"genprism", genprism}, {"genrev", genrev},       {"gensurf", gensurf},
      {"genworm", genworm}, {"gensky", gensky},     {"gendaylit", gendaylit},
  };
  for (const auto& [name, generator] : kGenerators) {
    if (words[0] != name) continue;
    const auto openFile = [&](const std::string& file) {
      SourceFile opened = open(file, where, folder);
      opened.text = std::string(PlainText(opened.text, opened.name).view());
      return opened;
    };
    return generator({std::span(words).subspan(1), where, openFile, limits_.objects});
  }
  throw inputError(
      where, "the command '" + words[0].substr(0, 40) + "' is not evaluated here",
      "known are xform, genbox, genprism, genrev, gensurf, genworm, gensky and gendaylit; expand others beforehand: "
      "xform -e FILE > EXPANDED");
}

Expander::Objects Expander::transformed(const std::vector<std::string>& words, const Objects* piped,
                                        const SourceLine& where, const fs::path& folder) {
  const XformCommand command = parseXform(std::span(words).subspan(1), limits_.objects, where);
  std::vector<std::shared_ptr<const Objects>> inputs;
  for (const std::string& name : command.files) {
    inputs.push_back(include(open(name, where, folder), where));
  }
  if (inputs.empty() && piped == nullptr) {
    throw inputError(where, "xform has no input", "name a file after its options, or pipe a generator into it");
  }
  std::vector<const Objects*> sources;
  for (const auto& input : inputs) sources.push_back(input.get());
  if (inputs.empty()) sources.push_back(piped);
  double objects = 0, numbers = 0;
  for (const Objects* source : sources) {
    objects += static_cast<double>(source->size()), numbers += static_cast<double>(numbersIn(*source));
  }
  const auto copies = static_cast<double>(command.copies.size());
  checkSize(copies * objects, copies * numbers, where);

  Objects result;
  result.reserve(static_cast<std::size_t>(copies * objects));
  for (const Placement& placement : command.copies) {
    for (const Objects* source : sources) appendPlaced(result, *source, placement, where);
  }
  return result;
}

void Expander::appendPlaced(Objects& list, const Objects& source, const Placement& placement,
                            const SourceLine& where) const {
  for (const RadObject& object : source) {
    RadObject copy = placed(object, placement);
    const auto tooLarge = [](double x) { return !(std::abs(x) <= kLargestNumber); };
    const auto outside = [&](const Vec3& p) { return tooLarge(p.x) || tooLarge(p.y) || tooLarge(p.z); };
    if (std::any_of(copy.reals.begin(), copy.reals.end(), tooLarge) ||
        (copy.mesh && std::any_of(copy.mesh->positions.begin(), copy.mesh->positions.end(), outside))) {
      throw inputError(where, "the transform takes '" + object.name + "' beyond 1e12", "check its -s, -t and -i");
    }
    list.push_back(std::move(copy));
  }
}

SourceFile Expander::open(const std::string& name, const SourceLine& where, const fs::path& folder) {
  if (auto file = files_.open(name, folder)) return std::move(*file);
  throw inputError(
      where, "cannot find the file '" + name.substr(0, 200) + "'",
      "files are looked for where the program runs, beside the file that names them, and beside the scene");
}

void Expander::checkSize(double objects, double numbers, const SourceLine& where) const {
  if (objects <= static_cast<double>(limits_.objects) && numbers <= static_cast<double>(limits_.numbers)) return;
  throw inputError(where, "the scene expands to too much: more than " + std::to_string(limits_.objects) + " objects",
                   "check the counts of its arrays");
}

}  // namespace deltalux::io::radiance
