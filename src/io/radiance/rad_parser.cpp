#include "io/radiance/rad_parser.hpp"

#include <deltalux/scene.hpp>

#include "io/plain_text.hpp"
#include "io/radiance/lexer.hpp"
#include "io/radiance/sky_pattern.hpp"

namespace deltalux::io::radiance {

namespace {

std::string_view requireWord(Lexer& lexer, const RadObject& object, std::string_view what) {
  if (const auto word = lexer.word()) return *word;
  throw inputError(object.where,
                   "the file ends within the object that starts here: " + std::string(what) + " is missing",
                   "the file may be cut short");
}

std::string subject(const RadObject& object) { return object.typeName + " '" + object.name + "'"; }

Type requireType(std::string_view word, const SourceLine& where) {
  if (const auto type = typeNamed(word)) return *type;
  std::string hint = "near:";
  for (const std::string& near : nearMisses(word.substr(0, 40), typeNames())) hint += " " + near;
  if (parseNumber(word)) hint = "the object before may have more arguments than it says";
  throw inputError(where, "unknown type '" + std::string(word.substr(0, 40)) + "'", hint);
}

std::size_t readCount(Lexer& lexer, const RadObject& object, std::string_view what) {
  const std::string_view word = requireWord(lexer, object, "the number of " + std::string(what) + " arguments");
  const auto count = parseInteger(word);
  if (!count || *count < 0) {
    throw inputError(lexer.where(),
                     subject(object) + ": '" + std::string(word.substr(0, 40)) + "' is no number of " +
                         std::string(what) + " arguments",
                     "after 'modifier type name' come three counted lists: strings, integers, reals");
  }
  return static_cast<std::size_t>(*count);
}

void readArguments(Lexer& lexer, RadObject& object) {
  for (std::size_t left = readCount(lexer, object, "string"); left > 0; --left) {
    object.strings.emplace_back(requireWord(lexer, object, "a string argument"));
  }
  for (std::size_t left = readCount(lexer, object, "integer"); left > 0; --left) {
    requireInteger(requireWord(lexer, object, "an integer argument"), lexer.where(), subject(object));
  }
  for (std::size_t left = readCount(lexer, object, "real"); left > 0; --left) {
    const std::string_view word = requireWord(lexer, object, "a real argument");
    object.reals.push_back(requireNumber(word, lexer.where(), subject(object)));
  }
}

RadObject readObject(Lexer& lexer) {
  RadObject object;
  object.where = lexer.where();
  object.modifier = *lexer.word();
  const std::string_view type = requireWord(lexer, object, "its type");
  object.type = requireType(type, lexer.where());
  object.typeName = type;
  object.name = requireWord(lexer, object, "its name");
  if (object.type == Type::Alias) {
    object.strings.emplace_back(requireWord(lexer, object, "what it stands for"));
    return object;
  }
  readArguments(lexer, object);
  checkArgumentCounts(object);
  if (object.typeName == "brightfunc") recogniseSky(object);
  return object;
}

}  // namespace

std::vector<RadItem> parseRadiance(std::string_view text, std::shared_ptr<const std::string> file) {
  const PlainText plain(text, *file);
  if (text.find('\0') != std::string_view::npos) {
    throw InputError(*file, 0, "is binary, no scene description",
                     "give the .rad files that an octree or picture was made from");
  }
  Lexer lexer(plain.view(), std::move(file));
  std::vector<RadItem> items;
  while (lexer.skipToObject()) {
    if (lexer.atCommand()) {
      const SourceLine where = lexer.where();
      items.push_back(RadCommand{lexer.commandLine(), where});
    } else {
      items.push_back(readObject(lexer));
    }
  }
  return items;
}

}  // namespace deltalux::io::radiance
