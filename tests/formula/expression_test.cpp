// Values of expressions: precedence against Python's, functions against the C library, data and parameters.
#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "formula/laboratory.h"
#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

struct Computed {
  const char* text;
  double value;
};

// What Python 3 prints for these with ** for ^.
constexpr Computed by_python[] = {
    {"2 + 3*4", 14},
    {"(2 + 3)*4", 20},
    {"2 - 3 - 4", -5},
    {"2 - (3 - 4)", 3},
    {"24/4/3", 2},
    {"24/4*3", 18},
    {"24/(4*3)", 2},
    {"-2^2", -4},
    {"(-2)^2", 4},
    {"2^3^2", 512},
    {"(2^3)^2", 64},
    {"2^-1", 0.5},
    {"2^-1^2", 0.5},
    {"-2^-2", -0.25},
    {"2*-3", -6},
    {"--2", 2},
    {"-+-2", 2},
    {"2--3", 5},
    {"4*2^3", 32},
    {"4^3*2", 128},
    {"1 + 2 < 4", 1},
    {"1 < 2 and 3 < 2", 0},
    {"1 < 2 or 3 < 2 and 2 < 1", 1},
    {"not 1 < 2", 0},
    {"not 1 < 2 or 2 < 3", 1},
    {"3 >= 3", 1},
    {"3 > 3", 0},
    {"3 <= 3", 1},
    {"3 == 3", 1},
    {"3 != 3", 0},
    {"1.5e3", 1500},
    {".5 + 5.", 5.5},
    {"1e-3*1E3", 1},
    {"pow(2, 10)", 1024},
    {"min(3, 1, 2)", 1},
    {"max(3, 1, 2)", 3},
    {"abs(-3)", 3},
    {"where(1 < 2, 5, 6)", 5},
    {"where(1 > 2, 5, 6)", 6},
    {"2^0.5", 1.4142135623730951},
    {"27^(1/3)", 3.0},
    {"(1 < 2) + (3 < 4)", 2},
};

TEST(Expression, HasThePrecedenceOfPython) {
  const Laboratory laboratory;
  for (const Computed& each : by_python)
    EXPECT_DOUBLE_EQ(laboratory.value(each.text), each.value) << each.text;
}

TEST(Expression, FunctionsAreThoseOfTheLibrary) {
  Laboratory laboratory;
  laboratory.columns[0] = {0.25, 1.5, 3};
  const std::vector<std::pair<const char*, double (*)(double)>> all = {
      {"exp", std::exp},     {"log", std::log},     {"log10", std::log10}, {"sqrt", std::sqrt},
      {"abs", std::abs},     {"erf", std::erf},     {"tanh", std::tanh},   {"atan", std::atan},
      {"log1p", std::log1p}, {"expm1", std::expm1},
  };
  for (const auto& [name, function] : all) {
    const auto values = laboratory.values(std::string(name) + "(x)");
    const auto moved = laboratory.values(std::string(name) + "(x*a/a)");
    for (std::size_t i = 0; i < 3; ++i) {
      const double x = laboratory.columns[0][i];
      EXPECT_DOUBLE_EQ(values[i], function(x)) << name;
      EXPECT_DOUBLE_EQ(moved[i], function(x * 0.7 / 0.7)) << name;
    }
  }
  EXPECT_DOUBLE_EQ(laboratory.values("sin(phi)")[1], std::sin(0.2));
  EXPECT_DOUBLE_EQ(laboratory.values("cos(phi)")[2], std::cos(0.3));
  EXPECT_DOUBLE_EQ(laboratory.value("sin(30 [deg])"), 0.5);
  EXPECT_DOUBLE_EQ(laboratory.value("pi"), std::numbers::pi);
}

// exp and log are our own: bounds, and within an ulp of the library's over the whole range.
TEST(Expression, ExponentialAndLogarithmAreGoodToAnUlp) {
  Laboratory laboratory;
  std::vector<double>& x = laboratory.columns[0];
  x.clear();
  for (double at = -760; at < 720; at += 0.173) x.push_back(at);
  const double infinity = INFINITY;
  x.insert(x.end(), {0.0, -0.0, infinity, -infinity, NAN, 709.78271289338397, 709.7827128933841,
                     -745.13, -745.14, 1e300, -1e300, 5e-324});
  for (auto& column : laboratory.columns) column.resize(x.size(), 1.0);
  for (auto& label : laboratory.labels) label.resize(x.size());
  const auto exponentials = laboratory.values("exp(x)");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = std::exp(x[i]);
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(exponentials[i]));
    } else if (std::isinf(wanted)) {
      EXPECT_EQ(exponentials[i], wanted) << x[i];
    } else if (wanted < 1e-300) {
      EXPECT_NEAR(exponentials[i] / 4.9e-324, wanted / 4.9e-324, 1 + 1e-15 * wanted / 4.9e-324)
          << x[i];
    } else {
      EXPECT_NEAR(exponentials[i] / wanted, 1, 2.3e-16) << x[i];
    }
  }
  for (std::size_t i = 0; i + 12 < x.size(); ++i) x[i] = std::exp(x[i]);
  const auto logarithms = laboratory.values("log(x)");
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double wanted = std::log(x[i]);
    if (std::isnan(wanted)) {
      EXPECT_TRUE(std::isnan(logarithms[i])) << x[i];
    } else if (std::isinf(wanted) || wanted == 0) {
      EXPECT_EQ(logarithms[i], wanted) << x[i];
    } else {
      EXPECT_NEAR(logarithms[i] / wanted, 1, 2.3e-16) << x[i];
    }
  }
}

TEST(Expression, UnitsAreConverted) {
  const Laboratory laboratory;
  EXPECT_DOUBLE_EQ(laboratory.value("9.81 [m/s^2] / 1 [mm/s^2]"), 9810);
  EXPECT_DOUBLE_EQ(laboratory.values("force / 1 [kN]")[1], 0.02);
  EXPECT_DOUBLE_EQ(laboratory.values("(force/1 [kN])^b")[1], std::pow(0.02, 1.9));
  EXPECT_DOUBLE_EQ(laboratory.value("2 [krev] / 1 [cycle]"), 2000);
  EXPECT_DOUBLE_EQ(laboratory.value("3 [MPa sqrt(m)] / (1 [MPa] * sqrt(1 [m]))"), 3);
  EXPECT_DOUBLE_EQ(laboratory.value("3 [MPa m^0.5] / 1 [Pa] / sqrt(1 [mm])"), 3e6 * std::sqrt(1e3));
  EXPECT_DOUBLE_EQ(laboratory.value("5 [%]"), 0.05);
  EXPECT_DOUBLE_EQ(laboratory.value("2 [mm]^2 / 1 [m^2]"), 4e-6);
}

TEST(Expression, ZeroFitsAnyDimension) {
  const Laboratory laboratory;
  EXPECT_EQ(laboratory.values("max(force - 15 [N], 0)"), (std::vector<double>{0, 5, 15}));
  EXPECT_EQ(laboratory.values("where(force > 0, force, 0)")[2], 30);
  EXPECT_EQ(laboratory.values("0 + force")[2], 30);
}

TEST(Expression, LabelsPickAndIndicate) {
  const Laboratory laboratory;
  EXPECT_EQ(laboratory.values("q[material]"), (std::vector<double>{2.5, -1.5, 2.5}));
  EXPECT_EQ(laboratory.value("q[\"PEEK\"]"), -1.5);
  EXPECT_EQ(laboratory.values("material == \"PTFE\""), (std::vector<double>{1, 0, 1}));
  EXPECT_EQ(laboratory.values("\"PTFE\" != material"), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(laboratory.values("b * (machine == '2')"), (std::vector<double>{0, 1.9, 0}));
  EXPECT_EQ(laboratory.values("where(material == \"PTFE\" and x < 3, a, b)"),
            (std::vector<double>{0.7, 1.9, 1.9}));
}

TEST(Expression, RunningSumsBeginAnewWithEachPath) {
  Laboratory laboratory;
  EXPECT_EQ(laboratory.values("cum(force)/1 [N]"), (std::vector<double>{10, 30, 60}));
  EXPECT_EQ(laboratory.values("cum(a*x)"), (std::vector<double>{0.7 * 1.5, 0.7 * 1.5 + 0.7 * 2,
                                                                0.7 * 1.5 + 0.7 * 2 + 0.7 * 3.25}));
  EXPECT_EQ(laboratory.values("cum(1)"), (std::vector<double>{1, 2, 3}));
  laboratory.paths = {0, 2};
  EXPECT_EQ(laboratory.values("cum(force)/1 [N]"), (std::vector<double>{10, 30, 30}));
  EXPECT_EQ(laboratory.values("cum(b)"), (std::vector<double>{1.9, 3.8, 1.9}));
}

TEST(Distribution, LinesStandInAnyOrder) {
  Laboratory laboratory;
  laboratory.lines = {{"wear", "k * work / area"}, {"work", "force * distance"}};
  const Program program = laboratory.program({"wear", "log(wear/1 [um]) + a"});
  EXPECT_EQ(program.outputs()[0].powers, read_any_unit("m").powers);
  EXPECT_EQ(program.text(0), "k * (force * distance) / 5e-05 [m^2]");
}

}  // namespace
}  // namespace wearwell::formula
