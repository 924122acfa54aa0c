#include "io/radiance/calc.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <deltalux/math.hpp>

namespace deltalux::io::radiance {
namespace {

double value(const std::string& expression, const std::string& definitions = "") {
  Calc calc({});
  calc.define(definitions);
  return calc.evaluate(expression);
}

TEST(Calc, FollowsCalcsGrammar) {
  EXPECT_EQ(value("1+2*3-4/2"), 5);
  EXPECT_EQ(value("10-4-3"), 3);
  EXPECT_EQ(value("-2^2"), 4);  // calc's unary minus binds tighter than ^
  EXPECT_EQ(value("2^3^2"), 512);
  EXPECT_EQ(value("2*-3"), -6);
  EXPECT_EQ(value(" ( 1.5e1 + .5 ) "), 15.5);
  EXPECT_NEAR(value("PI"), kPi, 1e-15);
}

TEST(Calc, HasItsLibrary) {
  EXPECT_EQ(value("if(1,2,3)"), 2);
  EXPECT_EQ(value("if(0,2,3)"), 3);
  EXPECT_EQ(value("if(-1,1/0,3)"), 3);  // only the branch taken counts
  EXPECT_EQ(value("select(2,10,20,30)"), 20);
  EXPECT_EQ(value("select(0,10,20,30)"), 3);
  EXPECT_EQ(value("min(3,1,2)+max(3,1,2)"), 4);
  EXPECT_NEAR(value("atan2(1,-1)"), 0.75 * kPi, 1e-15);
  EXPECT_NEAR(value("log(exp(2))+log10(1000)"), 5, 1e-14);
  EXPECT_EQ(value("floor(-1.5)+ceil(-1.5)"), -3);
  EXPECT_NEAR(value("sqrt(sin(1)^2+cos(1)^2)"), 1, 1e-15);
}

TEST(Calc, SplinesMeetTheirEndsAndSlopes) {
  EXPECT_EQ(value("hermite(2,5,7,11,0)"), 2);
  EXPECT_EQ(value("hermite(2,5,7,11,1)"), 5);
  EXPECT_NEAR(value("(hermite(2,5,7,11,1e-6)-2)/1e-6"), 7, 1e-4);
  EXPECT_NEAR(value("(5-hermite(2,5,7,11,1-1e-6))/1e-6"), 11, 1e-4);
  EXPECT_EQ(value("bezier(2,3,5,7,0)+bezier(2,3,5,7,1)"), 9);
  EXPECT_NEAR(value("bezier(1,2,3,4,.3)"), 1.9, 1e-14);   // linear data
  EXPECT_NEAR(value("bspline(1,2,3,4,.3)"), 2.3, 1e-14);  // linear data
}

TEST(Calc, UserDefinitions) {
  EXPECT_EQ(value("f(3)", "f(x)=g(x,2)+a; g(x,y)=x*y; a:10;"), 16);
  EXPECT_EQ(value("f(f(2))", "{ a comment {nested} } f(x)=x*x"), 16);
  EXPECT_EQ(value("a", "a=b*2;b=c+1;c=3"), 8);
  EXPECT_EQ(value("f(1)", "f(x)=1; f(x)=2"), 2);               // the last definition wins
  EXPECT_EQ(value("f(5)", "PIx=1; f(t)=if(t-4.5,t,PIx)"), 5);  // parameters hide nothing else
  EXPECT_EQ(value("min(2,3)", "min(a,b)=a*b"), 6);             // and hide the library
  EXPECT_EQ(value("if(0.5,f(1),g(1))", "f(x)=x;g(x)=1/(x-1)"), 1);
  EXPECT_EQ(value("half.size", "half.size=2.5"), 2.5);
}

TEST(Calc, FunctionsOfParameters) {
  Calc calc({});
  calc.define("z1(t)=hermite(0,3,5,3,t)");
  const Calc::Function z = calc.function({"t"}, "if(t-.7,1,z1(t/.7))");
  EXPECT_EQ(z({0.8}), 1);
  EXPECT_EQ(z({0.7}), 3);
  EXPECT_EQ(z({0.0}), 0);
  EXPECT_FALSE(calc.userFunction("valid", 2));
  calc.define("valid(s,t)=s-t");
  EXPECT_EQ(calc.userFunction("valid", 2)({3, 1}), 2);
}

TEST(Calc, SaysWhatIsWrong) {
  const auto expectError = [](const std::string& expression, const std::string& definitions, const std::string& part) {
    try {
      value(expression, definitions);
      ADD_FAILURE() << expression << " passed";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
  };
  expectError("", "", "ends too early");
  expectError("1+", "", "ends too early");
  expectError("(1", "", "')' is missing");
  expectError("1 2", "", "not expected");
  expectError("x", "", "no variable 'x'");
  expectError("noise3(1,2,3)", "", "no function 'noise3'");
  expectError("sin(1,2)", "", "takes 1 arguments, not 2");
  expectError("f(1)", "f(x,y)=x", "takes 2 arguments, not 1");
  expectError("if(1,2)", "", "takes 3");
  expectError("1/0", "", "not finite");
  expectError("a", "a=b;b=a", "defined by itself");
  expectError("f(1)", "f(x)=g(x);g(x)=f(x)", "defined by itself");
  expectError("f", "f(x)=x", "is a function");
  expectError("1", "garbage", "defines nothing");
  expectError("1", "f(1)=2", "no parameter name");
  expectError("1", "$2=1", "no name");
  expectError(std::string(1000, '('), "", "too deeply");
  std::string chain = "f0(x)=x;";
  for (int i = 1; i < 40; ++i) chain += fmt::format("f{0}(x)=f{1}(x)+f{1}(x);", i, i - 1);
  expectError("f39(1)", chain, "too often");
}

}  // namespace
}  // namespace deltalux::io::radiance
