#include "io/json_view.hpp"

#include "io/json_text.hpp"

namespace deltalux::io {

using nlohmann::json;

namespace {
// Numbers of a document as messages show them.
std::string text(double value) {
  std::string shown = json(value).dump();
  return shown.ends_with(".0") ? shown.substr(0, shown.size() - 2) : shown;
}
}  // namespace

void JsonView::fail(const std::string& message) const {
  throw InputError(*file_, line(), (where_.empty() ? "the document" : where_.substr(0, 200)) + " " + message, hint_);
}

int JsonView::line() const { return text_.empty() ? 0 : lineOf(text_, where_); }

JsonView JsonView::member(const char* key) const {
  const std::string where = where_ + "/" + key;
  if (!present()) return {nullptr, *this, where};
  expectObject();
  const auto found = value_->find(key);
  return {found == value_->end() ? nullptr : &*found, *this, where};
}

std::vector<JsonView> JsonView::members() const {
  std::vector<JsonView> views;
  if (!present()) return views;
  expectObject();
  for (const auto& [key, value] : value_->items()) views.push_back({&value, *this, where_ + "/" + key});
  return views;
}

std::vector<JsonView> JsonView::elements() const {
  std::vector<JsonView> views;
  if (!present()) return views;
  if (!value_->is_array()) fail("is not an array");
  for (std::size_t i = 0; i < value_->size(); ++i) {
    views.push_back({&(*value_)[i], *this, where_ + "/" + std::to_string(i)});
  }
  return views;
}

std::vector<JsonView> JsonView::objects() const {
  std::vector<JsonView> views = elements();
  for (const JsonView& view : views) view.expectObject();
  return views;
}

std::size_t JsonView::size() const { return present() && value_->is_array() ? value_->size() : 0; }

void JsonView::expectInteger(std::int64_t low, std::int64_t high) const {
  if (!present()) return;
  if (!value_->is_number_integer()) fail("is not a whole number");
  const bool fits = !value_->is_number_unsigned() || value_->get<std::uint64_t>() <= std::uint64_t{1} << 62;
  const auto number = fits ? value_->get<std::int64_t>() : std::int64_t{-1};
  if (!fits || number < low || number > high) {
    fail("is " + value_->dump() + ", not in " + std::to_string(low) + " to " + std::to_string(high));
  }
}

void JsonView::expectIndex(std::size_t count) const {
  if (!present()) return;
  expectInteger(0, std::int64_t{1} << 62);
  if (value_->get<std::uint64_t>() >= count)
    fail("is " + value_->dump() + ", but only " + std::to_string(count) + " are there");
}

void JsonView::expectNumber(double low, double high) const {
  if (!present()) return;
  if (!value_->is_number()) fail("is not a number");
  const double number = value_->get<double>();
  if (!(number >= low && number <= high)) {
    fail("is " + text(number) + ", not in " + text(low) + " to " + text(high));
  }
}

void JsonView::expectNumbers(std::size_t size, double low, double high) const {
  if (!present()) return;
  const std::vector<JsonView> numbers = elements();
  if (numbers.size() != size) fail("has " + std::to_string(numbers.size()) + " numbers, not " + std::to_string(size));
  for (const JsonView& number : numbers) number.expectNumber(low, high);
}

void JsonView::expectString() const {
  if (present() && !value_->is_string()) fail("is not a string");
}

void JsonView::expectBool() const {
  if (present() && !value_->is_boolean()) fail("is neither true nor false");
}

void JsonView::expectObject() const {
  if (present() && !value_->is_object()) fail("is not an object");
}

void JsonView::expectPresent(const char* what) const {
  if (!present()) fail(std::string("is missing: ") + what);
}

}  // namespace deltalux::io
