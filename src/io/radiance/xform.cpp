#include "io/radiance/xform.hpp"

#include <algorithm>

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

struct Array {
  std::size_t word;  // of its -a among the transform options
  long count;
};

/// The options before the transform.
struct Heading {
  Placement placement;
  bool named = false;
  std::size_t words = 0;
};

Heading parseHeading(std::span<const std::string> words, const SourceLine& where) {
  Heading heading;
  std::size_t& i = heading.words;
  const auto argument = [&]() -> const std::string& {
    if (i + 1 >= words.size()) throw inputError(where, "xform " + words[i] + " needs a name after it");
    return words[++i];
  };
  for (; i < words.size(); ++i) {
    std::string& prefix = heading.placement.namePrefix;
    if (words[i] == "-m") {
      const std::string& modifier = argument();
      if (heading.placement.modifier.empty()) heading.placement.modifier = modifier;
    } else if (words[i] == "-n") {
      prefix += (prefix.empty() ? "" : ".") + argument();
      heading.named = true;
    } else if (words[i] == "-I") {
      heading.placement.invert = !heading.placement.invert;
    } else if (words[i] != "-e" && words[i] != "-c") {
      break;
    }
  }
  return heading;
}

std::vector<Array> findArrays(std::span<const std::string> words, const SourceLine& where) {
  std::vector<Array> arrays;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] != "-a") continue;
    if (i + 1 >= words.size()) throw inputError(where, "xform -a needs a count after it");
    const long count = requireInteger(words[i + 1], where, "xform -a");
    if (count <= 0) throw inputError(where, "xform -a " + words[i + 1] + " makes no copy");
    arrays.push_back({i, count});
  }
  return arrays;
}

std::string copyName(const Heading& heading, const std::vector<long>& counter) {
  std::string name = heading.placement.namePrefix;
  for (std::size_t i = 0; i < counter.size(); ++i) {
    const std::string index = std::to_string(counter[i]);
    name += i == 0 && !heading.named ? "a" + index : "." + index;
  }
  return name;
}

/// Counts up like an odometer, the last array fastest; false after the last copy.
bool advance(std::vector<long>& counter, const std::vector<Array>& arrays) {
  for (std::size_t i = counter.size(); i-- > 0;) {
    if (++counter[i] < arrays[i].count) return true;
    counter[i] = 0;
  }
  return false;
}

}  // namespace

XformCommand parseXform(std::span<const std::string> words, std::size_t mostCopies, const SourceLine& where) {
  const Heading heading = parseHeading(words, where);
  std::vector<std::string> options(words.begin() + static_cast<std::ptrdiff_t>(heading.words), words.end());
  const std::vector<Array> arrays = findArrays(options, where);
  double copies = 1;
  for (const Array& array : arrays) copies *= static_cast<double>(array.count);
  if (copies > static_cast<double>(mostCopies)) {
    throw inputError(where, "the arrays of this xform make too many copies", "at most " + std::to_string(mostCopies));
  }
  for (const Array& array : arrays) options[array.word] = "-i";

  XformCommand command;
  std::vector<long> counter(arrays.size(), 0);
  std::size_t used = 0;
  do {
    for (std::size_t i = 0; i < arrays.size(); ++i) options[arrays[i].word + 1] = std::to_string(counter[i]);
    Placement placement = heading.placement;
    placement.transform = parseTransform(options, used, where);
    placement.namePrefix = copyName(heading, counter);
    command.copies.push_back(std::move(placement));
  } while (advance(counter, arrays));

  if (used < options.size() && options[used].starts_with('-')) {
    throw inputError(where, "xform has no option '" + options[used].substr(0, 40) + "' here",
                     "-m -n -c -e -I come first, then -t -s -rx -ry -rz -mx -my -mz -a -i, then files");
  }
  command.files.assign(options.begin() + static_cast<std::ptrdiff_t>(used), options.end());
  return command;
}

}  // namespace deltalux::io::radiance
