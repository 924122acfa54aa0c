#pragma once
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "io/radiance/calc.hpp"

namespace deltalux::io::radiance {

/// Writes an expression of calc's language as muParser's. Recursive descent over calc's grammar:
///   sum: product {(+|-) product}   product: power {(*|/) power}   power: signed [^ power]   signed: {+|-} primary
class CalcTranslator {
 public:
  CalcTranslator(Calc& calc, std::string_view text, const std::vector<std::string>& parameters)
      : calc_(calc), text_(text), parameters_(parameters) {}

  std::string translate();
  /// User functions that the expression calls: the name given to muParser, and the function.
  const std::map<std::string, Calc::Compiled*>& calls() const { return calls_; }
  /// Bound variables that it reads: the name given to muParser, and the variable.
  const std::map<std::string, double*>& reads() const { return reads_; }

 private:
  std::string sum();
  std::string product();
  std::string power();
  std::string signedPrimary();
  std::string primary();
  std::string number();
  std::string name();
  std::string variable(const std::string& name);
  std::string call(const std::string& function);

  char peek();
  bool accept(char c);
  void expect(char c);
  [[noreturn]] void fail(const std::string& message) const;

  Calc& calc_;
  std::string_view text_;
  const std::vector<std::string>& parameters_;
  std::size_t position_ = 0;
  int depth_ = 0;
  std::map<std::string, Calc::Compiled*> calls_;
  std::map<std::string, double*> reads_;
};

/// Whether `c` may begin, or stand in, a name of calc's language.
bool beginsName(char c);
bool inName(char c);

}  // namespace deltalux::io::radiance
