#include "io/number.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace deltalux {
using namespace io;

namespace {

TEST(Number, AllOfTheWordIsADecimalNumber) {
  for (const auto& [word, value] : {std::pair{"1", 1.0}, {"+2.5", 2.5}, {"-.5", -0.5}, {"3.", 3.0}, {"1e-3", 1e-3}})
    EXPECT_EQ(parseDecimal(word), value) << word;
  for (const char* word : {"", "+", "-", "abc", "1x", "0x10", "1 2", "--1", "+-1", "nan", "-inf", "1e", "1,5"}) {
    EXPECT_FALSE(parseDecimal(word)) << word;
    EXPECT_NE(notANumber(word).find("is not a number"), std::string::npos) << word;
  }
}

TEST(Number, BeyondTheDoublesIsNoNumber) {
  const std::string digits(400, '9');
  for (const std::string& word : std::vector<std::string>{"1e400", "-1e400", "0.0001e99999999999999999999", digits,
                                                          "-" + digits + "e-10", digits + ".5"}) {
    EXPECT_FALSE(parseDecimal(word)) << word;
    EXPECT_NE(notANumber(word).find("is too large a number"), std::string::npos) << word;
    EXPECT_LT(notANumber(word).size(), 80u);
  }
}

TEST(Number, NearerToZeroThanAnyDoubleIsZero) {
  const std::string zeros(400, '0');
  for (const std::string& word : std::vector<std::string>{"1e-400", "-1e-400", "1e-99999999999999999999",
                                                          "0." + zeros + "1", "-0." + zeros + "12e10", "9999e-500"})
    EXPECT_EQ(parseDecimal(word), 0.0) << word;
  EXPECT_EQ(parseDecimal("0e400"), 0.0);
}

}  // namespace
}  // namespace deltalux
