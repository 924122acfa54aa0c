#include "io/radiance/calc.hpp"

#include <algorithm>
#include <cmath>

#include "io/radiance/calc_compiled.hpp"
#include "io/radiance/calc_translator.hpp"
#include "io/trimmed.hpp"

namespace deltalux::io::radiance {

namespace {

constexpr long kMostCalls = 20000000;             // [limit]
constexpr std::size_t kDeepestDefinitions = 100;  // [limit]
constexpr std::size_t kCharactersOfACall = 100;   // of a program that takes about as long as a call [limit]

/// calc's comments stand in braces, which nest.
std::string withoutComments(std::string_view text) {
  std::string kept;
  int depth = 0;
  for (const char c : text) {
    if (c == '{') ++depth;
    if (depth == 0) kept += c;
    if (c == '}' && depth > 0) --depth;
  }
  return kept;
}

bool isName(const std::string& text) {
  return !text.empty() && beginsName(text[0]) && std::all_of(text.begin(), text.end(), inName);
}

}  // namespace

double Calc::Compiled::operator()(const double* arguments, std::size_t count) {
  if ((*callsLeft -= cost) < 0) throw mu::ParserError("the expressions call each other too often");
  std::copy(arguments, arguments + std::min(count, slots.size()), slots.begin());
  return parser.Eval();
}

Calc::Calc(SourceLine where) : Calc(std::move(where), ownCalls_) {}
Calc::Calc(SourceLine where, long& calls) : where_(std::move(where)), ownCalls_(kMostCalls), callsLeft_(&calls) {
  variables_["PI"] = std::acos(-1.0);
}
Calc::~Calc() = default;

bool Calc::reads(const std::string& name) const {
  const auto found = bound_.find(name);
  return found != bound_.end() && found->second.read;
}

void Calc::fail(const std::string& message) const { throw inputError(where_, message); }

void Calc::define(std::string_view text) {
  const std::string clean = withoutComments(text);
  for (std::size_t begin = 0; begin < clean.size();) {
    const std::size_t end = std::min(clean.find(';', begin), clean.size());
    const std::string statement(trimmed(std::string_view(clean).substr(begin, end - begin)));
    begin = end + 1;
    if (statement.empty()) continue;
    const std::size_t equals = statement.find_first_of("=:");
    if (equals == std::string::npos) fail("'" + statement.substr(0, 60) + "' defines nothing: name = expression");
    std::string head(trimmed(std::string_view(statement).substr(0, equals)));
    Definition definition;
    definition.expression = std::string(trimmed(std::string_view(statement).substr(equals + 1)));
    if (const std::size_t open = head.find('('); open != std::string::npos) {
      if (head.back() != ')') fail("'" + head.substr(0, 60) + "' is no function's head: name(a,b)");
      std::string_view list = std::string_view(head).substr(open + 1, head.size() - open - 2);
      for (std::size_t comma = 0; comma != std::string_view::npos;) {
        comma = list.find(',');
        definition.parameters.emplace_back(trimmed(list.substr(0, comma)));
        if (comma != std::string_view::npos) list.remove_prefix(comma + 1);
      }
      head = std::string(trimmed(std::string_view(head).substr(0, open)));
    }
    for (const std::string& parameter : definition.parameters) {
      if (!isName(parameter)) fail("'" + parameter.substr(0, 60) + "' is no parameter name");
    }
    if (!isName(head)) fail("'" + head.substr(0, 60) + "' is no name that could be defined");
    definitions_[head] = std::move(definition);
  }
}

std::unique_ptr<Calc::Compiled> Calc::compile(const Definition& definition) {
  if (inProgress_.size() > kDeepestDefinitions) fail("the definitions are nested too deeply");
  CalcTranslator translator(*this, definition.expression, definition.parameters);
  const std::string program = translator.translate();
  auto compiled = std::make_unique<Compiled>();
  compiled->callsLeft = callsLeft_;
  compiled->cost = 1 + static_cast<long>(program.size() / kCharactersOfACall);
  compiled->varies = !translator.reads().empty();
  compiled->slots.resize(definition.parameters.size());
  compiled->parser = calcParser();
  for (std::size_t i = 0; i < compiled->slots.size(); ++i) {
    compiled->parser.DefineVar("p" + std::to_string(i), &compiled->slots[i]);
  }
  for (const auto& [name, variable] : translator.reads()) compiled->parser.DefineVar(name, variable);
  for (const auto& [name, callee] : translator.calls()) {
    compiled->varies = compiled->varies || callee->varies;
    compiled->parser.DefineFunUserData(
        name,
        +[](void* function, const double* arguments, int count) {
          return (*static_cast<Compiled*>(function))(arguments, static_cast<std::size_t>(count));
        },
        callee, false);
  }
  try {
    compiled->parser.SetExpr(program);
  } catch (const mu::ParserError& error) {
    fail("expression '" + definition.expression.substr(0, 60) + "': " + error.GetMsg());
  }
  return compiled;
}

Calc::Compiled& Calc::compiledFunction(const std::string& name) {
  if (definitions_.at(name).parameters.empty()) fail("'" + name + "' is a variable, not a function");
  return compiledOnce(name);
}

Calc::Compiled& Calc::compiledVariable(const std::string& name) {
  const auto found = definitions_.find(name);
  if (found == definitions_.end()) fail("no variable '" + name + "' is defined");
  if (!found->second.parameters.empty()) fail("'" + name + "' is a function, not a variable");
  return compiledOnce(name);
}

Calc::Compiled& Calc::compiledOnce(const std::string& name) {
  if (const auto known = compiled_.find(name); known != compiled_.end()) return *known->second;
  if (std::find(inProgress_.begin(), inProgress_.end(), name) != inProgress_.end()) {
    fail("'" + name + "' is defined by itself, which is not supported");
  }
  inProgress_.push_back(name);
  auto compiled = compile(definitions_.at(name));
  inProgress_.pop_back();
  return *(compiled_[name] = std::move(compiled));
}

double Calc::variable(const std::string& name) {
  if (const auto known = variables_.find(name); known != variables_.end()) return known->second;
  const auto found = definitions_.find(name);
  if (found == definitions_.end()) fail("no variable '" + name + "' is defined");
  if (!found->second.parameters.empty()) fail("'" + name + "' is a function, not a variable");
  if (std::find(inProgress_.begin(), inProgress_.end(), name) != inProgress_.end()) {
    fail("'" + name + "' is defined by itself");
  }
  inProgress_.push_back(name);
  const double value = evaluate(found->second.expression);
  inProgress_.pop_back();
  return variables_[name] = value;
}

Calc::Function Calc::function(const std::vector<std::string>& parameters, const std::string& expression) {
  own_.push_back(compile({parameters, expression}));
  Compiled* compiled = own_.back().get();
  return [this, compiled, expression](const std::vector<double>& arguments) {
    try {
      return (*compiled)(arguments.data(), arguments.size());
    } catch (const mu::ParserError& error) {
      fail("expression '" + expression.substr(0, 60) + "': " + error.GetMsg());
    }
  };
}

Calc::Function Calc::userFunction(const std::string& name, std::size_t arity) {
  const auto found = definitions_.find(name);
  if (found == definitions_.end() || found->second.parameters.size() != arity) return {};
  return function(found->second.parameters, found->second.expression);
}

double Calc::evaluate(const std::string& expression) {
  const double value = function({}, expression)({});
  if (!std::isfinite(value)) fail("expression '" + expression.substr(0, 60) + "' is not finite");
  return value;
}

}  // namespace deltalux::io::radiance
