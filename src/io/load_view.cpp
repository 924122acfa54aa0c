#include <algorithm>
#include <deltalux/error.hpp>
#include <deltalux/io.hpp>
#include <optional>
#include <string_view>

#include "io/import_file.hpp"
#include "io/plain_text.hpp"
#include "io/radiance/view_options.hpp"

namespace deltalux {

namespace {

/// The options of a line that tells a view; nullopt for other lines.
std::optional<std::string_view> viewOptions(std::string_view line) {
  for (const std::string_view start : {"rview", "rvu", "rpict", "VIEW="}) {
    const std::size_t indent = std::min(line.find_first_not_of(" \t"), line.size());
    if (line.substr(indent).starts_with(start)) return line.substr(indent + start.size());
  }
  return std::nullopt;
}

}  // namespace

View loadView(const std::filesystem::path& file) {
  const std::string read = io::readInputFile(file);
  const io::PlainText plain(read, file.string());
  const std::string_view text = plain.view();
  std::optional<std::string_view> last;
  int lastLine = 0, line = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    ++line;
    if (const auto options = viewOptions(text.substr(begin, end - begin))) last = options, lastLine = line;
    begin = end + 1;
  }
  if (!last) throw InputError(file.string(), 0, "holds no view", "a view is a line 'rvu -vtv -vp ... -vd ...'");
  View view = io::radiance::parseView(*last, {std::make_shared<const std::string>(file.string()), lastLine});
  view.name = file.stem().string();
  return view;
}

}  // namespace deltalux
