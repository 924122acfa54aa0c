#pragma once
// Expressions of Radiance's generators: calc's language on top of muParser. [Radiance, icalc(1)]
//
// Definitions `f(a,b)=expr;` and `v=expr;` (also with ':') come from -e and -f. An expression is parsed by calc's own
// grammar (where -a^b is (-a)^b), and written out for muParser fully parenthesised; user functions become callbacks
// with a parser each, user variables become numbers. if(c,a,b) evaluates the one branch it takes. Departures: no
// recursion, no noise, rand or external data: InputErrors, as are values that are not finite.
//
// Pattern functions read variables that change from one evaluation to the next: bind() makes them. With any bound, user
// variables become functions too, unless nothing bound is behind them.
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "io/radiance/rad_object.hpp"

namespace deltalux::io::radiance {

class Calc {
 public:
  explicit Calc(SourceLine where);
  /// `calls` bounds the work of all evaluations and is counted down; an InputError says when it is used up.
  Calc(SourceLine where, long& calls);
  ~Calc();
  Calc(const Calc&) = delete;
  Calc& operator=(const Calc&) = delete;

  /// Adds the definitions of `text` (an -e expression or the contents of a .cal file); later ones win.
  void define(std::string_view text);

  /// A variable of that name, to be set before functions run. To be called before any is made.
  double& bind(const std::string& name) { return bound_[name].value; }
  /// Whether anything made so far reads the bound variable.
  bool reads(const std::string& name) const;

  using Function = std::function<double(std::vector<double>)>;
  /// The function (parameters) -> expression. The Calc must outlive it.
  Function function(const std::vector<std::string>& parameters, const std::string& expression);
  /// The user's function of that name and arity; an empty one when there is none.
  Function userFunction(const std::string& name, std::size_t arity);
  /// The value of an expression without parameters.
  double evaluate(const std::string& expression);

 private:
  struct Definition {
    std::vector<std::string> parameters;  // empty: a variable
    std::string expression;
  };
  struct Compiled;
  struct Bound {
    double value = 0;
    bool read = false;
  };
  friend class CalcTranslator;

  Compiled& compiledFunction(const std::string& name);
  Compiled& compiledVariable(const std::string& name);
  Compiled& compiledOnce(const std::string& name);
  double variable(const std::string& name);
  std::unique_ptr<Compiled> compile(const Definition&);
  [[noreturn]] void fail(const std::string& message) const;

  SourceLine where_;
  std::map<std::string, Definition> definitions_;
  std::map<std::string, std::unique_ptr<Compiled>> compiled_;
  std::vector<std::unique_ptr<Compiled>> own_;  // of function()
  std::map<std::string, double> variables_;
  std::map<std::string, Bound> bound_;
  std::vector<std::string> inProgress_;  // names being compiled: a repeat is a recursion
  long ownCalls_;                        // bounds the work that hostile definitions can ask for
  long* callsLeft_;
};

}  // namespace deltalux::io::radiance
