// Laws of the trades, written in the language, agree with the trades' own.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "wearwell/formula/program.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/joint/archard.h"

namespace wearwell::formula {
namespace {

Powers unit(const char* text) {
  return read_any_unit(text).powers;
}

// The sum over rows of the first output, and its gradient.
double log_likelihood(const Program& program, const std::vector<std::vector<double>>& columns,
                      const std::vector<double>& parameters, std::vector<double>& gradient) {
  Rows rows;
  rows.count = columns.front().size();
  for (const auto& column : columns) rows.columns.emplace_back(column);
  const Data data = program.bind(rows);
  Workspace work = program.workspace(rows.count);
  program.forward(data, 0, rows.count, {parameters}, work);
  double sum = 0;
  for (const double each : work.values(0)) sum += each;
  for (double& each : work.adjoints(0)) each = 1;
  gradient.assign(parameters.size(), 0);
  program.reverse(data, 0, rows.count, {parameters}, work, gradient);
  return sum;
}

void expect_agreement(const LogDensity& built_in, const Program& program,
                      const std::vector<std::vector<double>>& columns,
                      const std::vector<double>& parameters) {
  std::vector<double> wanted(parameters.size()), found;
  const double value = built_in.value_and_gradient(parameters, wanted);
  const double ours = log_likelihood(program, columns, parameters, found);
  EXPECT_NEAR(ours / value, 1, 1e-12);
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(found[i] / wanted[i], 1, 1e-12) << i;
}

TEST(Language, HasArchardsLawOfAJoint) {
  const joint::Inspections seen = {{5.966, 596.6, 5966, 29830, 59660},
                                   {4.44e-9, 5.105e-9, 8.825e-9, 24.175e-9, 45.31e-9}};
  Symbols symbols;
  symbols.columns = {{"work", unit("J")}, {"volume", unit("m^3")}};
  symbols.parameters = {
      {"k", unit("mm^3/(N m)")}, {"sigma", unit("mm^3")}, {"v0", unit("mm^3")}, {"exponent", {}}};
  const Program program = compile(
      {{"mean", "v0 + k*work*(work/100 [J])^(exponent - 1)"}, {"z", "(volume - mean)/sigma"}},
      {{"log-likelihood", "-0.5*z^2 - log(sigma/1 [m^3]) - 0.5*log(2*pi)"}}, symbols);
  const auto likelihood = joint::archard_likelihood({true, true, 100}, ObservationFamily::normal,
                                                    seen, seen.work.size());
  expect_agreement(*likelihood, program, {seen.work, seen.volume}, {6.3e-13, 2e-9, 3.5e-9, 1.07});
  expect_agreement(*likelihood, program, {seen.work, seen.volume}, {8e-13, 5e-9, 1e-9, 0.9});
}

// Lives in numbers of cycles; the density is that per cycle.
TEST(Language, HasBasquinsLawWithGoodmansCorrection) {
  fatigue::LifeTests tests;
  std::vector<std::vector<double>> columns(3);
  for (int i = 0; i < 9; ++i) {
    fatigue::LifeTest test;
    test.stress.alternating = (300 + 25.0 * i) * 1e6;
    test.stress.mean = (500 - 30.0 * i) * 1e6;
    test.life = std::pow(10, 5.9 - 0.2 * i + 0.1 * (i % 3));
    tests.push_back(test);
    columns[0].push_back(test.stress.alternating);
    columns[1].push_back(test.stress.mean);
    columns[2].push_back(test.life);
  }
  Symbols symbols;
  symbols.columns = {
      {"amplitude", unit("Pa")}, {"mean_stress", unit("Pa")}, {"life", unit("cycles")}};
  symbols.parameters = {{"log10_a", {}}, {"b", {}}, {"log10_sut", {}}, {"sigma", {}}};
  const std::vector<Line> lines = {
      {"reversed", "amplitude/(1 - mean_stress/(10^log10_sut * 1 [Pa]))"},
      {"log10_life", "(log10(reversed/1 [Pa]) - log10_a)/b"},
      {"z", "(log10(life/1 [cycle]) - log10_life)/sigma"},
      {"measure", "-log(life/1 [cycle]*log(10))"}};
  const std::vector<double> parameters = {9.3, -0.09, 9.25, 0.2};
  fatigue::SnLaw built_in;
  expect_agreement(
      *fatigue::sn_likelihood(built_in, tests, tests.size()),
      compile(lines, {{"log-likelihood", "measure - 0.5*z^2 - log(sigma) - 0.5*log(2*pi)"}},
              symbols),
      columns, parameters);
  built_in.family = fatigue::LifeFamily::weibull;
  expect_agreement(
      *fatigue::sn_likelihood(built_in, tests, tests.size()),
      compile(lines, {{"log-likelihood", "measure + z - exp(z) - log(sigma)"}}, symbols), columns,
      parameters);
}

}  // namespace
}  // namespace wearwell::formula
