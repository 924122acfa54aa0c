#pragma once
// A JSON value that knows its place in the document, for messages.
#include <deltalux/error.hpp>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace deltalux::io {

/// Members that are not there are nowhere: present() is false, and every check passes.
class JsonView {
 public:
  /// `hint` says, at the end of every message, what to do. `text`, when given, is what the document was read from:
  /// messages have lines then. It must outlive this.
  JsonView(const nlohmann::json& value, const std::string& file, const char* hint, std::string_view text = {})
      : value_(&value), file_(&file), hint_(hint), text_(text) {}

  bool present() const { return value_ != nullptr; }
  const nlohmann::json& value() const { return *value_; }
  /// Of the text; of what is not there, of what it is missing in. 0 without text.
  int line() const;

  /// The member `key` of an object.
  JsonView member(const char* key) const;
  /// The members of an object, or nothing.
  std::vector<JsonView> members() const;
  /// The elements of an array, or nothing; anything else is an error.
  std::vector<JsonView> elements() const;
  /// The elements of an array, each of them an object.
  std::vector<JsonView> objects() const;
  std::size_t size() const;

  /// A whole number in [low, high].
  void expectInteger(std::int64_t low, std::int64_t high) const;
  /// An index into `count` things.
  void expectIndex(std::size_t count) const;
  void expectNumber(double low, double high) const;
  /// An array of `size` numbers.
  void expectNumbers(std::size_t size, double low, double high) const;
  void expectString() const;
  void expectBool() const;
  void expectObject() const;
  void expectPresent(const char* what) const;

  [[noreturn]] void fail(const std::string& message) const;

 private:
  JsonView(const nlohmann::json* value, const JsonView& document, std::string where)
      : value_(value), file_(document.file_), hint_(document.hint_), text_(document.text_), where_(std::move(where)) {}

  const nlohmann::json* value_;
  const std::string* file_;
  const char* hint_;
  std::string_view text_;
  std::string where_;  // JSON pointer
};

}  // namespace deltalux::io
