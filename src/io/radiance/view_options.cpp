#include "io/radiance/view_options.hpp"

#include "io/radiance/lexer.hpp"

namespace deltalux::io::radiance {

namespace {

class ViewParser {
 public:
  ViewParser(std::string_view options, const SourceLine& where) : words_(options, where.file), where_(where) {}

  View parse() {
    while (const auto word = words_.word()) option(std::string(*word));
    check();
    return view_;
  }

 private:
  void option(const std::string& word) {
    if (word == "-vp") {
      view_.position = vector(word);
    } else if (word == "-vd") {
      view_.direction = vector(word);
    } else if (word == "-vu") {
      view_.up = vector(word);
    } else if (word == "-vh") {
      view_.horizontal = number(word);
    } else if (word == "-vv") {
      view_.vertical = number(word);
    } else if (word == "-vtv") {
      view_.kind = View::Kind::Perspective;
    } else if (word == "-vtl") {
      view_.kind = View::Kind::Parallel;
    } else if (word == "-vs" || word == "-vl" || word == "-vo" || word == "-va") {
      if (number(word) != 0) throw inputError(where_, word + " other than 0 is not supported");
    } else if (word.starts_with("-v")) {
      throw inputError(where_, "the view option '" + word.substr(0, 20) + "' is not supported",
                       "use -vtv or -vtl with -vp -vd -vu -vh -vv");
    }
    // What else rpict was given says nothing about the view.
  }

  double number(const std::string& option) {
    const auto word = words_.word();
    if (!word) throw inputError(where_, option + " needs a number after it");
    return requireNumber(*word, where_, option);
  }

  Vec3 vector(const std::string& option) {
    const double x = number(option), y = number(option), z = number(option);
    return {x, y, z};
  }

  void check() const {
    if (!(glm::length(glm::cross(view_.direction, view_.up)) > 0)) {
      throw inputError(where_, "the view's direction and up vector are parallel or zero");
    }
    const bool parallel = view_.kind == View::Kind::Parallel;
    for (const double size : {view_.horizontal, view_.vertical}) {
      if (!(size > 0 && (parallel || size < 180))) {
        throw inputError(where_, "the view's -vh or -vv is out of range",
                         parallel ? "they are widths above 0" : "they are angles between 0 and 180 degrees");
      }
    }
  }

  Lexer words_;
  const SourceLine& where_;
  View view_;
};

}  // namespace

View parseView(std::string_view options, const SourceLine& where) { return ViewParser(options, where).parse(); }

}  // namespace deltalux::io::radiance
