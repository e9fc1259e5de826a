// A state by its rate, against closed forms; its gradient against theirs or differences.
#include <gmock/gmock.h>

#include <cmath>

#include "formula/laboratory.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"

namespace wearwell::formula {
namespace {

double total(const Laboratory& laboratory, const std::string& text,
             const std::vector<double>& weight) {
  const auto values = laboratory.values(text);
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += weight[i] * values[i];
  return sum;
}

void expect_slopes(Laboratory laboratory, const std::string& text, double close) {
  const std::vector<double> weight = {1, -0.5, 2};
  const auto found = laboratory.slopes(text, weight).parameters;
  for (std::size_t p = 0; p < found.size(); ++p) {
    double& parameter = laboratory.parameters[p];
    const double centre = parameter, h = 1e-4 * std::abs(centre);
    const auto at = [&](double value) {
      parameter = value;
      return total(laboratory, text, weight);
    };
    // Of the fourth order.
    const double quotient =
        (8 * (at(centre + h) - at(centre - h)) - (at(centre + 2 * h) - at(centre - 2 * h))) /
        (12 * h);
    parameter = centre;
    EXPECT_NEAR(found[p], quotient, close * std::abs(quotient) + 1e-300) << "parameter " << p;
  }
}

// Run-in: depth = h0 (1 - exp(-k cum(force step)/h0)), whose k force is in m per m.
TEST(State, OfRunInIsItsClosedForm) {
  Laboratory laboratory;
  laboratory.parameters[3] = 5e-12;  // m^2/N: rates of 1e-6 .. 3e-6
  laboratory.lines = {{"d(depth)/d(distance)", "k * force/area * (1 - depth/h0)"}};
  const double k = 5e-12 / 50e-6, h0 = 5e-6;
  const double work[] = {10 * 1, 10 * 1 + 20 * 1, 10 * 1 + 20 * 1 + 30 * 2};
  const auto depth = laboratory.values("depth");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(depth[i] / (-h0 * std::expm1(-k * work[i] / h0)), 1, 1e-9);
  expect_slopes(laboratory, "depth", 1e-7);
  expect_slopes(laboratory, "a*depth + depth*log(b)", 1e-7);
}

TEST(State, WhoseRateIsKnownIsASum) {
  Laboratory laboratory;
  laboratory.lines = {
      {"drive", "k * force / area"}, {"d(depth)/d(distance)", "drive"}, {"depth(0)", "a * 1 [um]"}};
  const auto depth = laboratory.values("depth");
  const double work[] = {10, 30, 90};
  for (std::size_t i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(depth[i], 0.7e-6 + 1e-12 / 50e-6 * work[i]);
  expect_slopes(laboratory, "depth", 1e-9);
  EXPECT_EQ(laboratory.program({"depth"}).text(0),
            "a * 1e-06 [m] + cum(k * force / 5e-05 [m^2] * step(distance))");
}

// What is linear has a closed form from row to row; the same rate, written so that it does not look linear, is integrated.
TEST(State, LinearRatesAgreeWithTheirIntegration) {
  Laboratory laboratory;
  laboratory.parameters[3] = 5e-12;
  laboratory.paths = {0, 1};
  const std::pair<const char*, const char*> both[] = {
      {"k*force/area*(1 - depth/h0)", "k*force/area*(1 - min(depth, 1 [m])/h0)"},
      {"k*force/area*x - depth*b/1 [m]", "k*force/area*x - max(depth, -1 [m])*b/1 [m]"},
      {"(depth + h0)/1 [m]*q[material]*0.1", "(max(depth, -1 [m]) + h0)/1 [m]*q[material]*0.1"},
      {"-(depth - h0)*1e-9/1 [m]", "-(min(depth, 1 [m]) - h0)*1e-9/1 [m]"},
      {"depth/1 [m]", "min(depth, 1 [m])/1 [m]"}};
  for (const auto& [linear, other] : both) {
    SCOPED_TRACE(linear);
    laboratory.lines = {{"d(depth)/d(distance)", linear}, {"depth(0)", "h0*a*0.1"}};
    Laboratory integrated = laboratory;
    integrated.lines[0].text = other;
    const auto exact = laboratory.values("depth"), steps = integrated.values("depth");
    const auto by = laboratory.slopes("depth", {1, 2, -0.5}).parameters,
               by_steps = integrated.slopes("depth", {1, 2, -0.5}).parameters;
    for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(exact[i] / steps[i], 1, 1e-9);
    for (std::size_t p = 0; p < by.size(); ++p)
      EXPECT_NEAR(by[p], by_steps[p], 1e-8 * std::abs(by_steps[p]) + 1e-300) << p;
    expect_slopes(laboratory, "depth", 1e-7);
  }
}

// Paris: da/dn = C a^(m/2) in numbers, a = (a0^(1 - m/2) + (1 - m/2) C n)^(1/(1 - m/2)).
TEST(State, OfCrackGrowthIsItsClosedFormAndInfiniteBeyondFailure) {
  Laboratory laboratory;
  laboratory.parameters[0] = 1e-3;  // C
  laboratory.parameters[1] = 3;     // m
  laboratory.lines = {{"d(size)/d(n)", "a/1 [cycle] * size^(b/2)"}, {"size(0)", "0.8"}};
  const auto closed = [](double n) { return std::pow(std::pow(0.8, -0.5) - 0.5 * 1e-3 * n, -2); };
  auto size = laboratory.values("size");
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(size[i] / closed(laboratory.columns[4][i]), 1, 1e-9);
  expect_slopes(laboratory, "size", 1e-7);
  laboratory.columns[4] = {100, 2000, 4000};  // fails at 2236
  size = laboratory.values("size");
  EXPECT_NEAR(size[1] / closed(2000), 1, 1e-8);
  EXPECT_EQ(size[2], INFINITY);
}

// Units at rates of their own, in proportion to a number by row, run along one trajectory, each to its place; beside
// the same rate with the axis in it, which is integrated by steps.
TEST(State, OfUnitsThatDifferRunsAlongOneTrajectory) {
  const std::pair<const char*, const char*> lines[] = {
      {"u^2/1 [cycle] * 0.01 * size^(b/2)", "0.8"},
      {"u^2/1 [cycle] * 0.01 * (1 - (size/b)^2)", "0*a"},
      {"-exp(u)/1 [cycle] * 0.02 * size^1.5 * a", "4"},
      {"u^2/1 [cycle] * 0.002 * size^1.5*exp(-size^2)", "1"}};
  for (const auto& [rate, beginning] : lines) {
    SCOPED_TRACE(rate);
    Laboratory along, steps;
    along.lines = {{"d(size)/d(n)", rate}, {"size(0)", beginning}};
    steps.lines = along.lines;
    steps.lines[0].text += " + 0*(n/1 [cycle^2])*size";
    for (const std::vector<std::size_t>& paths :
         {std::vector<std::size_t>{0}, std::vector<std::size_t>{0, 1, 2}}) {
      along.paths = steps.paths = paths;
      const auto found = along.values("size"), wanted = steps.values("size");
      for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(found[i] / wanted[i], 1, 1e-9) << i;
      const auto by = along.slopes("size", {1, -0.5, 2}),
                 by_steps = steps.slopes("size", {1, -0.5, 2});
      for (std::size_t p = 0; p < by.parameters.size(); ++p) {
        EXPECT_NEAR(by.parameters[p], by_steps.parameters[p],
                    1e-7 * std::abs(by_steps.parameters[p]));
      }
      for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(by.by_row[0][i], by_steps.by_row[0][i], 1e-7 * std::abs(by_steps.by_row[0][i]));
      }
    }
  }
}

// A kink of the rate at 1.14 has a closed form on either side of it.
TEST(State, OfARateWithAKinkIsExactBeyondIt) {
  Laboratory laboratory;
  laboratory.lines = {{"d(size)/d(n)", "u^2/1 [cycle] * 0.002 * max(size, b*0.6)^1.5"},
                      {"size(0)", "1"}};
  laboratory.paths = {0, 1, 2};
  const double kink = 1.9 * 0.6;
  const auto size = laboratory.values("size");
  for (std::size_t i = 0; i < 3; ++i) {
    const double u = laboratory.by_row[0][i], way = u * u * 0.002 * laboratory.columns[4][i];
    const double until = (kink - 1) / std::pow(kink, 1.5);
    const double closed = way < until ? 1 + way * std::pow(kink, 1.5)
                                      : std::pow(std::pow(kink, -0.5) - (way - until) / 2, -2);
    EXPECT_NEAR(size[i] / closed, 1, 1e-9) << i;
  }
}

// What stands on a trajectory does not depend on what was asked before.
TEST(State, IsTheSameWhateverWasAskedBefore) {
  Laboratory laboratory;
  laboratory.lines = {{"d(size)/d(n)", "u^2/1 [cycle] * 0.01 * size^(b/2)"}, {"size(0)", "0.8"}};
  laboratory.paths = {0, 1, 2};
  const Program program = laboratory.program({"size"});
  const Data data = program.bind(laboratory.rows());
  Workspace fresh = program.workspace(3), used = program.workspace(3);
  const auto at = laboratory.pointers();
  for (std::size_t row = 3; row-- > 0;) {
    const double* from = at[0] + row;
    program.forward(data, row, row + 1, {laboratory.parameters, {&from, 1}}, used);
  }
  program.forward(data, 0, 3, {laboratory.parameters, at}, used);
  program.forward(data, 0, 3, {laboratory.parameters, at}, fresh);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(used.values(0)[i], fresh.values(0)[i]);
}

// dy/dx = -b (y - cos x): the axis in the rate is where the state is, not the row's value.
TEST(State, WhoseRateKnowsWhereItIs) {
  Laboratory laboratory;
  laboratory.lines = {{"d(state)/d(phi)", "-b/1 [rad] * (state - cos(phi))"},
                      {"state(0)", "0 * a"}};
  laboratory.columns[5] = {0.5, 3, 8};
  const double b = 1.9;
  const auto state = laboratory.values("state");
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = laboratory.columns[5][i];
    const double wanted = b / (b * b + 1) * (b * std::cos(x) + std::sin(x) - b * std::exp(-b * x));
    EXPECT_NEAR(state[i], wanted, 1e-9);
  }
  expect_slopes(laboratory, "state", 1e-6);
  laboratory.lines = {{"d(state)/d(phi)", "b * phi/1 [rad^2]"}, {"state(0)", "c"}};
  for (std::size_t i = 0; i < 3; ++i) {
    const double x = laboratory.columns[5][i];
    EXPECT_NEAR(laboratory.values("state")[i], -0.3 + b * x * x / 2, 1e-12);
  }
}

TEST(State, BeginsWhereItIsSaid) {
  Laboratory laboratory;
  laboratory.lines = {{"d(growth)/d(distance)", "growth/1 [m]"}, {"growth(first)", "a"}};
  EXPECT_NEAR(laboratory.values("growth")[0], 0.7, 1e-12);
  EXPECT_NEAR(laboratory.values("growth")[2], 0.7 * std::exp(3.0), 1e-9);
  laboratory.paths = {0, 2};
  EXPECT_NEAR(laboratory.values("growth")[1], 0.7 * std::exp(1.0), 1e-9);
  EXPECT_NEAR(laboratory.values("growth")[2], 0.7, 1e-12);
  laboratory.lines[1].name = "growth(50 cm)";
  EXPECT_NEAR(laboratory.values("growth")[1], 0.7 * std::exp(1.5), 1e-9);
  EXPECT_NEAR(laboratory.values("growth")[2], 0.7 * std::exp(3.5), 1e-8);
  expect_slopes(laboratory, "growth", 1e-8);
}

TEST(State, IsToldAsItWasUnderstood) {
  Laboratory laboratory;
  EXPECT_EQ(laboratory.program({"x"}).state_text(), "");
  laboratory.lines = {{"drive", "k*force/area"}, {"d(depth)/d(distance)", "drive*(1 - depth/h0)"}};
  EXPECT_EQ(laboratory.program({"x"}).state_text(),
            "d(depth)/d(distance) = k * force / 5e-05 [m^2] * (1 - depth / h0), depth(0) = 0");
  laboratory.lines.push_back({"depth(2 mm)", "h0/2"});
  const Program program = laboratory.program({"depth/h0"});
  EXPECT_THAT(program.state_text(), testing::EndsWith(", depth(0.002 m) = h0 / 2"));
  EXPECT_EQ(program.text(0), "depth / h0");
  EXPECT_TRUE(program.outputs()[0].by_path);
  EXPECT_TRUE(program.has_paths());
}

TEST(State, AsksForSortedRows) {
  Laboratory laboratory;
  laboratory.lines = {{"d(growth)/d(distance)", "growth/1 [m]"}, {"growth(0)", "a"}};
  laboratory.columns[3] = {1, 4, 2};
  EXPECT_THAT(message_of<InputError>([&] { laboratory.values("growth"); }),
              testing::HasSubstr("'distance' decreases at row 3, from 4 to 2"));
  laboratory.columns[3] = {-1, 2, 4};
  EXPECT_THAT(message_of<InputError>([&] { laboratory.values("growth"); }),
              testing::HasSubstr(
                  "'distance' is -1 in SI at row 1, before the beginning of the state at 0"));
}

}  // namespace
}  // namespace wearwell::formula
