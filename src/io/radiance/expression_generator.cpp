#include "io/radiance/expression_generator.hpp"

namespace deltalux::io::radiance {

bool readDefinition(const std::string& option, ObjectMaker& maker, Calc& calc) {
  if (option == "-e") {
    calc.define(maker.word("-e expression"));
  } else if (option == "-f") {
    calc.define(maker.input().open(maker.word("-f file")).text);
  } else {
    return false;
  }
  return true;
}

int segmentCount(const std::string& expression, const ObjectMaker& maker, Calc& calc) {
  constexpr double kMost = 1e6;  // [limit]
  const double count = std::floor(calc.evaluate(expression) + 0.5);
  if (!(count >= 1 && count <= kMost)) maker.fail("'" + expression.substr(0, 40) + "' is no number of segments");
  return static_cast<int>(count);
}

}  // namespace deltalux::io::radiance
