// How paths that depend on rows before their own go on: against rows that are really there.
#include "wearwell/models/formula_model/formula_running.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_crossing.h"
#include "wearwell/models/formula_model/formula_likelihood.h"
#include "wearwell/models/formula_model/formula_reader.h"

namespace wearwell::formula_model {
namespace {

constexpr double um = 1e-6, km = 1000;

class RunningPathTest : public ScratchTest {
 protected:
  struct Study {
    TomlReader root;
    std::shared_ptr<FormulaModel> model;
  };

  // Two machines of which the rate k varies.
  Study read(const std::string& model, const std::string& mean, const std::string& rows,
             const std::string& given = "force = \"25 N\"") const {
    write("d.csv", "m,F,s,ds,h\n" + rows);
    const auto file = write("study.toml", R"(
model = "formula"
[data]
file = "d.csv"
[data.columns]
h = { column = "h", unit = "um" }
force = { column = "F", unit = "N" }
s = { column = "s", unit = "km" }
ds = { column = "ds", unit = "km" }
m = "m"
[formula]
)" + model + R"(
[likelihood.h]
family = "normal"
mean = ")" + mean + R"toml("
sd = "sigma"
[prior]
k = { distribution = "lognormal", median = "0.1 um/(N km)", log_sd = 1 }
h0 = { distribution = "lognormal", median = "30 um", log_sd = 1 }
sigma = { distribution = "half-normal", scale = "1 um" }
scatter = { distribution = "half-normal", scale = 1 }
[random_effects.m]
k = { distribution = "lognormal", log_sd = "scatter + 0*h0/1 [um]" }
[predict]
along = "s"
given = { )toml" + given + " }\n");
    const Source source = source_of(file);
    TomlReader root = TomlReader::parse(source.study);
    auto law_read = read_formula_model(root, source);
    return {root, law_read};
  }

  const std::vector<double> x_ = {0.13 * um / km, 22 * um, 1 * um, 0.4};
  // The mean of the last row of unit 1 as the likelihood has it.
  double by_rows(const Study& study, double z) const {
    const FormulaRows rows(study.model, study.model->data.table.rows);
    UnitRows& units = rows.mine().rows;
    units.move_to(x_.data());
    const std::vector<double> effects = {-0.3, z};
    return units.each_family_parameter(
        effects)[0][(study.model->data.table.rows - 1) * most_response_parameters];
  }
  std::shared_ptr<const Path> path(const Study& study, const std::string& wanted,
                                   std::optional<std::size_t> unit) const {
    const TomlReader predict = study.root.required_table("predict");
    const Conditions given = read_conditions(predict.required_table("given"), *study.model);
    const Conditions all = unit ? conditions_of_unit(*study.model, *unit, given)
                                : common_conditions(*study.model, given);
    return make_path(study.model, predict, "at", {{"path", wanted}}, true, all, unit);
  }
  double at(const Path& path, double z, double place) const {
    PathAt now(path);
    now.move_to(x_.data());
    now.stand(1, &z);
    now.evaluate(1, &z, &place);
    return now.output(0, 0);
  }
  std::string refusal(const std::string& model, const std::string& mean, const std::string& rows,
                      const std::string& given, bool of_new = false) const {
    return message_of<InputError>([&] {
      const Study study = read(model, mean, rows, given);
      path(study, mean, of_new ? std::nullopt : std::optional<std::size_t>(1));
    });
  }
};

const char* const even = "a,20,1,1,2\na,20,2,1,4\nb,10,1,1,1\nb,30,2,1,4\n";
const char* const uneven = "a,20,1,1,2\na,20,3,2,6\nb,10,1,1,1\nb,30,4,3,9\n";

// The third row of machine b, 25 N up to 11 km, is in the data, and ahead of them.
TEST_F(RunningPathTest, APathAheadIsThatOfRowsThatAreThere) {
  const std::vector<std::pair<std::string, std::string>> models = {
      {"", "k * cum(force * ds)"},
      {"\"d(wear)/d(s)\" = \"k * force\"\n", "wear"},
      {"\"d(wear)/d(s)\" = \"k * force * (1 - wear/h0)\"\n\"wear(0)\" = \"0 [um]\"\n", "wear"},
      {"\"d(wear)/d(s)\" = \"k * force * (1 - (wear/h0)^2)\"\n\"wear(0)\" = \"2 [um]\"\n", "wear"},
      {"\"d(wear)/d(s)\" = \"k * force * exp(-s/20 [km])\"\n", "wear + 1e-9*s*1 [m/km]"}};
  for (const char* data : {even, uneven}) {
    for (const auto& [model, mean] : models) {
      const std::string unit = mean.substr(0, 4) == "wear" ? mean : mean;
      const Study now = read(model, unit, data);
      const double ahead = at(*path(now, unit, 1), 0.7, 11 * km);
      const double ds = data == even ? 9 : 7;
      const Study later =
          read(model, unit, std::string(data) + "b,25,11," + std::to_string(ds) + ",0\n");
      EXPECT_NEAR(ahead / by_rows(later, 0.7), 1, 1e-9) << unit << model;
    }
  }
}

TEST_F(RunningPathTest, ANewUnitBeginsAtTheBeginning) {
  const Study sum = read("", "k * cum(force * ds)", uneven);
  const Study state = read("\"d(wear)/d(s)\" = \"k * force\"\n", "wear", uneven);
  const double expected = x_[0] * std::exp(0.4 * 0.7) * 25 * 5 * km;
  EXPECT_NEAR(at(*path(sum, "k * cum(force * ds)", {}), 0.7, 5 * km) / expected, 1, 1e-12);
  EXPECT_NEAR(at(*path(state, "wear", {}), 0.7, 5 * km) / expected, 1, 1e-12);
}

// Rows that are evenly far apart go on so; a sum of what is the same in all rows is a straight line.
TEST_F(RunningPathTest, ASumOfRowsThatLieEvenlyGoesOnAsEvenly) {
  const Study study = read("", "k * cum(force) * 1 [km]", even);
  const double k = x_[0] * std::exp(0.4 * 0.7);
  const auto ahead = path(study, "k * cum(force) * 1 [km]", 1);
  EXPECT_NEAR(at(*ahead, 0.7, 2 * km) / (k * 40 * km), 1, 1e-12);
  EXPECT_NEAR(at(*ahead, 0.7, 6.5 * km) / (k * (40 + 25 * 4.5) * km), 1, 1e-12);
  const auto anew = path(study, "k * cum(force) * 1 [km]", {});
  EXPECT_NEAR(at(*anew, 0.7, 6.5 * km) / (k * 25 * 6.5 * km), 1, 1e-12);
}

// In steps that are said: 4 km each, of which the root counts.
TEST_F(RunningPathTest, StepsAheadMayBeSaid) {
  const std::string mean = "k * cum(force * (ds/1 [km])^0.5) * 1 [km]";
  const Study study = read("", mean, uneven, "force = \"25 N\", ds = \"4 km\"");
  const double k = x_[0] * std::exp(0.4 * 0.7);
  const double until_now = 10 + 30 * std::sqrt(3.0);
  EXPECT_NEAR(at(*path(study, mean, 1), 0.7, 12 * km) / (k * (until_now + 25 * 2 * 2) * km), 1,
              1e-12);
}

TEST_F(RunningPathTest, WhatCannotBeToldIsRefused) {
  const std::string force = "force = \"25 N\"";
  EXPECT_NE(refusal("", "k * cum(force) * 1 [km]", uneven, force).find("2 to 3 km apart"),
            std::string::npos);
  EXPECT_NE(refusal("", "k * cum(force * (ds/1 [km])^0.5) * 1 [km]", uneven, force)
                .find("not proportional to the step 'ds'"),
            std::string::npos);
  EXPECT_NE(refusal("", "k * cum(force * s/1 [km]) * 1 [km]", even, force)
                .find("varies over future rows"),
            std::string::npos);
  EXPECT_NE(refusal("", "k * cum(cum(force * ds)) ", uneven, force).find("depends on earlier rows"),
            std::string::npos);
  EXPECT_NE(refusal("", "k * cum(force * ds)", uneven, "", true).find("needs predict.given.force"),
            std::string::npos);
  EXPECT_NE(refusal("\"d(wear)/d(s)\" = \"k * force\"\n\"wear(first)\" = \"0 [um]\"\n", "wear",
                    "a,20,1,1,2\na,20,2,1,4\nb,10,2,1,1\nb,30,3,1,4\n", force, true)
                .find("units begin at 1 and at 2 km"),
            std::string::npos);
}

// Where a state reaches its limit: after its last row, or before.
TEST_F(RunningPathTest, AStateReachesItsLimit) {
  const Study study =
      read("\"d(wear)/d(s)\" = \"k * force * (1 - wear/h0)\"\n\"wear(0)\" = \"0 [um]\"\n", "wear",
           uneven);
  const double z = 0.7, k = x_[0] * std::exp(0.4 * z), h0 = x_[1];
  const double limits[] = {15 * um, 2 * um, 40 * um};
  double place[3] = {};
  const double units[] = {z, z, z};
  const auto of_new = path(study, "wear", {}), of_seen = path(study, "wear", 1);
  Crossing anew(*of_new, true, 0, 4 * km);
  anew.at().move_to(x_.data());
  anew.solve(3, units, limits, place);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(place[i] / (-std::log(1 - limits[i] / h0) * h0 / (k * 25)), 1, 1e-9);
  }
  EXPECT_EQ(place[2], INFINITY);  // it never gets beyond h0
  Crossing seen(*of_seen, true, 0, 4 * km);
  seen.at().move_to(x_.data());
  seen.solve(3, units, limits, place);
  const double work = -std::log(1 - limits[0] / h0) * h0 / k;  // of which 100 N km are behind it
  EXPECT_NEAR(place[0] / (4 * km + (work - 100 * km) / 25), 1, 1e-9);
  EXPECT_EQ(place[1], 4 * km);
  EXPECT_GT(seen.ahead(1), 0);
  EXPECT_EQ(place[2], INFINITY);
}

}  // namespace
}  // namespace wearwell::formula_model
