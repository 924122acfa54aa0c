#include "io/radiance/command_line.hpp"

namespace deltalux::io::radiance {

namespace {

class PipelineParser {
 public:
  PipelineParser(std::string_view text, const SourceLine& where) : text_(text), where_(where) {}

  std::vector<std::vector<std::string>> parse() {
    while (position_ < text_.size() && !(text_[position_] == '#' && !inWord_)) step(text_[position_++]);
    endCommand();
    return std::move(commands_);
  }

 private:
  void step(char c) {
    switch (c) {
      case ' ':
      case '\t':
        return endWord();
      case '|':
        return endCommand();
      case '\'':
        return singleQuoted();
      case '"':
        return doubleQuoted();
      case '\\':
        return append(position_ < text_.size() ? text_[position_++] : '\\');
      case ';':
      case '&':
      case '<':
      case '>':
      case '(':
      case ')':
      case '$':
      case '`':
        needsShell(c);
      default:
        append(c);
    }
  }

  void append(char c) { word_ += c, inWord_ = true; }

  void endWord() {
    if (inWord_) words_.push_back(std::move(word_));
    word_.clear(), inWord_ = false;
  }

  void endCommand() {
    endWord();
    if (words_.empty()) throw inputError(where_, "an empty command", "a line that starts with '!' names a command");
    commands_.push_back(std::move(words_));
    words_.clear();
  }

  void singleQuoted() {
    const std::size_t end = text_.find('\'', position_);
    if (end == std::string_view::npos) throw inputError(where_, "a ' without its partner");
    word_ += text_.substr(position_, end - position_), inWord_ = true;
    position_ = end + 1;
  }

  void doubleQuoted() {
    inWord_ = true;
    for (;;) {
      if (position_ >= text_.size()) throw inputError(where_, "a \" without its partner");
      const char c = text_[position_++];
      if (c == '"') return;
      if (c == '$' || c == '`') needsShell(c);
      const bool escapes = c == '\\' && position_ < text_.size() &&
                           std::string_view("\"\\$`").find(text_[position_]) != std::string_view::npos;
      word_ += escapes ? text_[position_++] : c;
    }
  }

  [[noreturn]] void needsShell(char c) const {
    throw inputError(where_, std::string("'") + c + "' in a command needs a shell, and none is run here",
                     "quote it, or expand the file beforehand: xform -e FILE > EXPANDED");
  }

  std::string_view text_;
  const SourceLine& where_;
  std::size_t position_ = 0;
  std::string word_;
  bool inWord_ = false;
  std::vector<std::string> words_;
  std::vector<std::vector<std::string>> commands_;
};

}  // namespace

std::vector<std::vector<std::string>> parsePipeline(std::string_view text, const SourceLine& where) {
  return PipelineParser(text, where).parse();
}

}  // namespace deltalux::io::radiance
