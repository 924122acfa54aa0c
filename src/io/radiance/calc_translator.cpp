#include "io/radiance/calc_translator.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>

#include "io/radiance/calc_compiled.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr int kDeepest = 200;  // [limit]

bool isDigit(char c) { return c >= '0' && c <= '9'; }

std::string parenthesised(double value) {
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value, std::chars_format::scientific, 17).ptr;
  return "(" + std::string(text.data(), end) + ")";
}

}  // namespace

bool beginsName(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool inName(char c) { return beginsName(c) || isDigit(c) || c == '.' || c == '`'; }

std::string CalcTranslator::translate() {
  std::string result = sum();
  if (peek() != '\0') fail("'" + std::string(text_.substr(position_, 20)) + "' is not expected here");
  return result;
}

std::string CalcTranslator::sum() {
  if (++depth_ > kDeepest) fail("it is nested too deeply");
  std::string left = product();
  for (char c = peek(); c == '+' || c == '-'; c = peek()) {
    ++position_;
    left = "(" + left + c + product() + ")";
  }
  --depth_;
  return left;
}

std::string CalcTranslator::product() {
  std::string left = power();
  for (char c = peek(); c == '*' || c == '/'; c = peek()) {
    ++position_;
    left = "(" + left + c + power() + ")";
  }
  return left;
}

std::string CalcTranslator::power() {
  if (++depth_ > kDeepest) fail("it is nested too deeply");
  std::string base = signedPrimary();
  if (accept('^')) base = "((" + base + ")^(" + power() + "))";
  --depth_;
  return base;
}

std::string CalcTranslator::signedPrimary() {
  bool negative = false;
  for (char c = peek(); c == '+' || c == '-'; c = peek()) {
    negative = negative != (c == '-');
    ++position_;
  }
  std::string value = primary();
  return negative ? "(-" + value + ")" : value;
}

std::string CalcTranslator::primary() {
  const char c = peek();
  if (accept('(')) {
    std::string inner = sum();
    expect(')');
    return "(" + inner + ")";
  }
  if (isDigit(c) || c == '.') return number();
  if (beginsName(c)) return name();
  if (c == '\0') fail("it ends too early");
  std::string message = "'";
  message += c;
  fail(message += "' is not expected here");
}

std::string CalcTranslator::number() {
  double value = 0;
  const auto [end, error] = std::from_chars(text_.data() + position_, text_.data() + text_.size(), value);
  if (error != std::errc()) fail("'" + std::string(text_.substr(position_, 20)) + "' is no usable number");
  position_ = static_cast<std::size_t>(end - text_.data());
  return parenthesised(value);
}

std::string CalcTranslator::name() {
  const std::size_t begin = position_;
  while (position_ < text_.size() && inName(text_[position_])) ++position_;
  const std::string found(text_.substr(begin, position_ - begin));
  if (accept('(')) return call(found);
  for (std::size_t i = 0; i < parameters_.size(); ++i) {
    if (parameters_[i] == found) return "p" + std::to_string(i);
  }
  return variable(found);
}

std::string CalcTranslator::variable(const std::string& name) {
  const auto bound = calc_.bound_.find(name);
  if (calc_.definitions_.count(name) == 0 && bound != calc_.bound_.end()) {
    bound->second.read = true;
    std::string alias = "b" + std::to_string(std::distance(calc_.bound_.begin(), bound));
    reads_[alias] = &bound->second.value;
    return alias;
  }
  if (calc_.bound_.empty() || calc_.variables_.count(name) != 0) return parenthesised(calc_.variable(name));
  Calc::Compiled& compiled = calc_.compiledVariable(name);
  if (!compiled.varies) {
    try {
      if (const double value = compiled(nullptr, 0); std::isfinite(value)) return parenthesised(value);
    } catch (const mu::ParserError& error) {
      fail(error.GetMsg());
    }
  }
  std::string callee = "f" + std::to_string(calls_.size());
  calls_[callee] = &compiled;
  callee += "(0)";  // muParser's functions take an argument
  return callee;
}

std::string CalcTranslator::call(const std::string& function) {
  std::vector<std::string> arguments;
  do {
    arguments.push_back(sum());
  } while (accept(','));
  expect(')');
  const auto require = [&](std::size_t count) {
    if (arguments.size() != count) {
      fail(function + "() takes " + std::to_string(count) + " arguments, not " + std::to_string(arguments.size()));
    }
  };
  std::string callee = function;
  if (calc_.definitions_.count(function) != 0) {
    Calc::Compiled& compiled = calc_.compiledFunction(function);
    require(compiled.slots.size());
    callee = "f" + std::to_string(calls_.size());
    calls_[callee] = &compiled;
  } else if (function == "if") {
    require(3);
    return "((" + arguments[0] + ">0)?(" + arguments[1] + "):(" + arguments[2] + "))";
  } else if (const auto arity = libraryArity(function)) {
    if (*arity >= 0) require(static_cast<std::size_t>(*arity));
  } else {
    fail("no function '" + function + "' is defined or built in");
  }
  std::string text = callee + "(" + arguments[0];
  for (std::size_t i = 1; i < arguments.size(); ++i) text += "," + arguments[i];
  return text + ")";
}

char CalcTranslator::peek() {
  const auto isSpace = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
  while (position_ < text_.size() && isSpace(text_[position_])) ++position_;
  return position_ < text_.size() ? text_[position_] : '\0';
}

bool CalcTranslator::accept(char c) {
  if (peek() != c) return false;
  ++position_;
  return true;
}

void CalcTranslator::expect(char c) {
  if (!accept(c)) fail(std::string("'") + c + "' is missing");
}

void CalcTranslator::fail(const std::string& message) const {
  calc_.fail("expression '" + std::string(text_.substr(0, 60)) + (text_.size() > 60 ? "...': " : "': ") + message);
}

}  // namespace deltalux::io::radiance
