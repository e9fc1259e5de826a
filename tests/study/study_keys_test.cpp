// What the lists of keys say of a study is what its reader does; docs/reference/study-keys.md is made of both.
#include "wearwell/input/study_keys.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <regex>
#include <set>

#include "support/run_command.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/registry.h"
#include "wearwell/study/posterior_keys.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

const Model& model(std::string_view key) {
  for (const Model& each : all_models()) {
    if (each.key == key) return each;
  }
  throw std::logic_error("no such model");
}

// "data.columns" and "volume".
std::pair<std::string, std::string> split(const std::string& path) {
  const std::size_t dot = path.rfind('.');
  return dot == path.npos ? std::pair(std::string(), path)
                          : std::pair(path.substr(0, dot), path.substr(dot + 1));
}

// Keys with their values, in the order in which they were added.
using Values = std::vector<std::pair<std::string, std::string>>;

std::string toml(const Values& values) {
  std::vector<std::string> tables;
  for (const auto& [path, value] : values) {
    const std::string table = split(path).first;
    if (std::find(tables.begin(), tables.end(), table) == tables.end()) tables.push_back(table);
  }
  std::sort(tables.begin(), tables.end());  // the top of the file first
  std::string text;
  for (const std::string& table : tables) {
    if (!table.empty()) text += fmt::format("[{}]\n", table);
    for (const auto& [path, value] : values) {
      if (split(path).first == table) text += fmt::format("{} = {}\n", split(path).second, value);
    }
  }
  return text;
}

class StudyKeysTest : public ScratchTest {
 protected:
  void SetUp() override {
    ScratchTest::SetUp();
    // Every column that an example of a key names. All are failures: a status that tells nothing may stay unused.
    write("wear.csv",
          "cycles,volume,work,force,slip,depth,bearing,radius,clearance,contact,pressure,length,"
          "revolutions,speed,time,alternating_stress,R,mean_stress,max_stress,min_stress,amplitude,"
          "mean,cycles_until,status,count,type,trials\n"
          "100,5,1,60,6,10,A,10,25,stationary,1,20,1000,60,1,300,-1,10,300,-300,5,10,200,failure,1,"
          "A,9\n"
          "1000,9,8,61,60,20,B,10,25,stationary,1,20,3000,60,3,250,-1,10,250,-250,4,10,2000,"
          "failure,2,B,9\n"
          "9000,40,70,60,540,60,B,10,25,stationary,1,20,9000,60,9,200,-1,10,200,-200,3,10,9900,"
          "failure,1,B,9\n");
    write("events.csv",
          "unit,age [day],start [day],event\nA,100,50,broke\nA,200,50,sold\nB,90,0,broke\n");
    write("cycle.csv", "force,ds\n60,1\n61,1\n60,1\n61,1\n");
    write("positions.csv",
          "cycles,dx,dy\n100,0.01,0\n100,0,0.01\n100,-0.01,0\n100,0,-0.01\n9000,0.05,0\n9000,0,"
          "0.05\n9000,-0.05,0\n9000,0,-0.05\n");
    for (const char* name : {"joint", "bearing", "fatigue", "clutch", "spring", "formula", "life",
                             "accelerated", "repairable", "warranty", "fleet"}) {
      for (const auto& entry :
           fs::directory_iterator(fs::path(PROJECT_SOURCE_DIR) / "examples" / name))
        if (!fs::exists(folder() / entry.path().filename()))
          fs::copy(entry.path(), folder() / entry.path().filename());
    }
    fs::copy(fs::path(PROJECT_SOURCE_DIR) / "examples/formula/wear.csv", folder() / "law.csv");
  }

  // Reads as `read_study` does, and keeps what was asked for.
  std::unique_ptr<const Study> read(const Model& model, const std::string& text) {
    const fs::path file = write("s.toml", text);
    const Source source = source_of(file);
    const TomlReader root = TomlReader::parse(source.study);
    root.has("model");
    std::unique_ptr<const Study> study = model.read(root, source);
    for (const auto& [path, kinds] : root.asked()) {
      asked_[std::string(model.key)][path].insert(kinds.begin(), kinds.end());
    }
    EXPECT_EQ(unused_keys(root, model.keys()), "") << text;
    EXPECT_EQ(key_faults(root, model.keys(), ""), "") << text;
    return study;
  }

  // `seeds`, and all that they need, with the values that the list has for an example.
  Values completed(const Model& model, const Values& seeds) {
    Values values = seeds;
    values.insert(values.begin(), {"model", fmt::format("\"{}\"", model.key)});
    for (bool more = true; more;) {
      more = false;
      const TomlReader root = TomlReader::parse({folder() / "s.toml", toml(values)});
      for (const StudyKey& key : missing_keys(root, model.keys())) {
        values.emplace_back(key.path, key.example);
        more = true;
        break;  // it may stand for others
      }
    }
    return values;
  }

  std::map<std::string, std::map<std::string, std::set<std::string>>> asked_;
};

struct Start {
  const char* model;
  Values values;
};

// The ways to say a thing; each needs keys of its own.
const std::vector<Start>& starts() {
  static const std::vector<Start> all = {
      {"archard-joint", {}},
      {"archard-joint", {{"data.columns.work", "{ column = \"work\", unit = \"J\" }"}}},
      {"archard-joint", {{"data.columns.force", "{ column = \"force\", unit = \"N\" }"}}},
      {"archard-joint", {{"conditions.profile.rule", "\"rectangle\""}}},
      {"archard-joint",
       {{"data.file", "\"positions.csv\""},
        {"data.columns.dx", "{ column = \"dx\", unit = \"mm\" }"},
        {"prior.sigma", "{ distribution = \"half-normal\", scale = \"5 mm^3\" }"}}},
      {"bearing-wear", {}},
      {"bearing-wear", {{"conditions.force", "\"400 N\""}}},
      {"bearing-wear", {{"conditions.time", "\"400 h\""}}},
      {"bearing-wear", {{"likelihood.depth_error", "\"2 um\""}}},
      {"sn", {}},
      {"sn", {{"conditions.max_stress", "\"400 MPa\""}}},
      {"sn",
       {{"data.columns.displacement_amplitude", "{ column = \"amplitude\", unit = \"mm\" }"}}},
      {"sn", {{"law.mean_stress", "\"none\""}}},
      {"sn", {{"law.mean_stress", "\"soderberg\""}, {"conditions.S_y", "\"900 MPa\""}}},
      {"sn", {{"law.mean_stress", "\"morrow\""}, {"conditions.sigma_f", "\"1500 MPa\""}}},
      {"sn", {{"law.mean_stress", "\"walker\""}, {"conditions.gamma", "0.5"}}},
      {"sn", {{"predict.stress.part.max_stress", "\"400 MPa\""}}},
      {"sn",
       {{"data.columns.displacement_amplitude", "{ column = \"amplitude\", unit = \"mm\" }"},
        {"predict.stress.part.displacement_amplitude", "\"4 mm\""}}},
      {"sn",
       {{"law.mean_stress", "\"soderberg\""},
        {"prior.log10_Sy", "{ distribution = \"default\" }"}}},
      {"sn",
       {{"law.mean_stress", "\"morrow\""},
        {"prior.log10_sigma_f", "{ distribution = \"default\" }"}}},
      {"sn",
       {{"law.mean_stress", "\"walker\""},
        {"law.fatigue_limit", "\"random\""},
        {"prior.gamma", "{ distribution = \"default\" }"},
        {"prior.log10_limit", "{ distribution = \"default\" }"},
        {"prior.sigma_limit", "{ distribution = \"default\" }"}}},
      {"sn",
       {{"law.mean_stress", "\"none\""},
        {"law.curve", "\"knee\""},
        {"law.second_slope", "\"free\""},
        {"law.scatter", "\"grows\""},
        {"prior.k", "{ distribution = \"default\" }"},
        {"prior.k2", "{ distribution = \"default\" }"},
        {"prior.log10_N_D", "{ distribution = \"default\" }"},
        {"prior.log10_S_D", "{ distribution = \"default\" }"},
        {"prior.sigma_growth", "{ distribution = \"default\" }"}}},
      {"sn",
       {{"law.mean_stress", "\"none\""},
        {"law.curve", "\"bastenaire\""},
        {"prior.log10_N_B", "{ distribution = \"default\" }"},
        {"prior.log10_B", "{ distribution = \"default\" }"},
        {"prior.C", "{ distribution = \"default\" }"}}},
      {"sn",
       {{"data.columns.alternating_stress", "{ column = \"alternating_stress\", unit = \"um/m\" }"},
        {"law.mean_stress", "\"none\""},
        {"law.curve", "\"strain-life\""},
        {"conditions.E", "\"206 GPa\""},
        {"prior.log10_elastic", "{ distribution = \"default\" }"},
        {"prior.log10_plastic", "{ distribution = \"default\" }"},
        {"prior.c", "{ distribution = \"default\" }"}}},
      {"sn", {{"data.columns.status", "{ column = \"status\", failure = 0 }"}}},
      {"staircase", {}},
      {"staircase", {{"data.columns.status", "{ column = \"status\", failure = 0 }"}}},
      {"staircase",
       {{"data.columns.count", "\"count\""},
        {"law.limit_family", "\"normal\""},
        {"prior.log10_limit", "{ distribution = \"default\" }"},
        {"prior.sigma_limit", "{ distribution = \"default\" }"},
        {"predict.reliability", "\"90 %\""},
        {"predict.credible_level", "0.9"}}},
      {"repairable",
       {{"data.file", "\"valve_seats.csv\""},
        {"data.rounding", "\"1 day\""},
        {"data.columns.event", "\"event\""}}},
      {"sn",
       {{"conditions.S_ut", "\"1200 MPa\""},
        {"predict.reliability", "\"90 %\""},
        {"predict.stress_ratio", "-1"}}},
      {"formula",
       {{"data.columns.depth", "{ column = \"depth\", unit = \"um\" }"},
        {"data.columns.status", "{ column = \"status\", failure = 0 }"},
        {"likelihood.depth.mean", "\"a\""},
        {"likelihood.depth.sd", "\"s\""},
        {"prior.a", "{ distribution = \"normal\", mean = \"20 um\", sd = \"20 um\" }"},
        {"prior.s", "{ distribution = \"half-normal\", scale = \"20 um\" }"}}},
  };
  return all;
}

// With the needed keys a study can be read; without any of them it cannot, and the refusal names it.
TEST_F(StudyKeysTest, NeededIsWhatReadersNeed) {
  for (const Start& start : starts()) {
    const Model& of = model(start.model);
    const Values whole = completed(of, start.values);
    ASSERT_NO_THROW(read(of, toml(whole))) << toml(whole);
    for (std::size_t i = start.values.size() + 1; i < whole.size(); ++i) {
      Values less = whole;
      less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
      write("s.toml", toml(less));
      EXPECT_THAT(
          message_of<InputError>([&] { read_study(source_of(folder() / "s.toml"), all_models()); }),
          HasSubstr(split(whole[i].first).second))
          << toml(less);
    }
  }
}

TEST_F(StudyKeysTest, OfAClutchToo) {
  const Model& clutch = model("clutch-wear");
  const Values whole =
      completed(clutch, {{"simulation.seed", "1"}, {"life.points.launch.torque", "\"50 N m\""}});
  ASSERT_NO_THROW(read(clutch, toml(whole))) << toml(whole);
  for (std::size_t i = 3; i < whole.size(); ++i) {
    Values less = whole;
    less.erase(less.begin() + static_cast<std::ptrdiff_t>(i));
    EXPECT_THAT(message_of<InputError>([&] { read(clutch, toml(less)); }),
                HasSubstr(split(whole[i].first).second));
  }
  const Values rig = completed(clutch, {{"data.traces", "\"traces.csv\""}});
  EXPECT_EQ(rig.size(), 9U) << toml(rig);
}

// All missing keys in one message, however early the reader stumbles.
TEST_F(StudyKeysTest, AllMissingKeysInOneMessage) {
  for (const Start& start : starts()) {
    const Model& of = model(start.model);
    const Values whole = completed(of, start.values);
    Values less = start.values;
    less.insert(less.begin(), {"model", fmt::format("\"{}\"", of.key)});
    write("s.toml", toml(less));
    const std::string message =
        message_of<InputError>([&] { read_study(source_of(folder() / "s.toml"), all_models()); });
    const TomlReader root = TomlReader::parse_file(folder() / "s.toml");
    for (const StudyKey& key : missing_keys(root, of.keys()))
      EXPECT_THAT(message, HasSubstr(key.path + " = " + key.example));
  }
}

// Everything that may stand in a study, in as few studies as that takes.
const std::vector<std::pair<const char*, std::string>>& rich_studies() {
  const std::string sampler = R"toml(
[update]
stages = "row"
[sampler]
method = "metropolis"
chains = 4
half_width.k = "1e-5 mm^3/(N m)"
half_width.sigma = "1 KEY"
)toml";
  const auto joint = [&](const std::string& more) {
    return R"toml(model = "archard-joint"
title = "t"
[data]
file = "wear.csv"
sql = "select * from data"
[data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
[conditions]
work_per_cycle = "5 N m"
[likelihood]
family = "normal"
[predict]
limit = "100 mm^3"
)toml" + more;
  };
  const auto with_law = [&](const std::string& distribution) {
    return joint("[prior]\nk = " + distribution +
                 "\nsigma = { distribution = \"flat\", unit = \"mm^3\" }\n");
  };
  // One family after the other, of depths that grow with time; what a law does not use is refused.
  const auto formula_model = [](const std::string& family, const std::string& family_parameters,
                                const std::string& more) {
    std::string priors;
    const std::pair<const char*, const char*> all_priors[] = {
        {"a", "{ distribution = \"lognormal\", median = \"10 um\", log_sd = 1 }"},
        {"b", "{ distribution = \"lognormal\", median = \"5 um/h\", log_sd = 1 }"},
        {"c", "{ distribution = \"half-normal\", scale = \"9 um\" }"},
        {"q", "{ distribution = \"half-normal\", scale = 1 }"},
        {"r", "{ distribution = \"half-normal\", scale = \"5 um\" }"},
        {"u", "{ distribution = \"uniform\", lower = -1, upper = 1 }"}};
    for (const auto& [name, prior] : all_priors) {
      const bool used =
          std::string("ab").find(name) != std::string::npos ||
          (family_parameters + more).find(fmt::format("\"{}\"", name)) != std::string::npos;
      if (used) priors += fmt::format("{} = {}\n", name, prior);
    }
    return fmt::format(R"toml(model = "formula"
[data]
file = "wear.csv"
[data.columns]
depth = {{ column = "depth", unit = "um" }}
time = {{ column = "time", unit = "h" }}
bearing = "bearing"
[likelihood.depth]
family = "{}"
{}
[prior]
{}{})toml",
                       family, family_parameters, priors, more);
  };
  static const std::vector<std::pair<const char*, std::string>> all = {
      {"archard-joint", joint("[prior]\nk = { distribution = \"flat\", unit = \"mm^3/(N m)\" "
                              "}\nsigma = { distribution = \"flat\", unit "
                              "= \"mm^3\" }\n" +
                              std::regex_replace(sampler, std::regex("KEY"), "mm^3"))},
      {"archard-joint",
       with_law("{ distribution = \"lognormal\", mean = \"1e-3 mm^3/(N m)\", sd = \"1e-3 "
                "mm^3/(N m)\" }")},
      {"archard-joint",
       with_law("{ distribution = \"lognormal\", median = \"1e-3 mm^3/(N m)\", log_sd = 1 }")},
      {"archard-joint",
       with_law("{ distribution = \"gamma\", shape = 2, scale = \"1e-3 mm^3/(N m)\" }")},
      {"archard-joint", with_law("{ distribution = \"log10-normal\", median = \"1e-3 mm^3/(N m)\", "
                                 "log10_sd = 0.4, threshold = \"1e-5 mm^3/(N m)\" }")},
      {"archard-joint",
       with_law("{ distribution = \"generalized-gamma\", scale = \"1e-3 mm^3/(N m)\", "
                "sigma = 1, lambda = 0.5 }")},
      {"archard-joint",
       with_law("{ distribution = \"exponentiated-weibull\", scale = \"1e-3 mm^3/(N m)\", "
                "shape = 1, exponent = 2 }")},
      {"archard-joint",
       with_law("{ distribution = \"student-t\", df = 4, location = \"1e-3 mm^3/(N m)\", "
                "scale = \"1e-3 mm^3/(N m)\" }")},
      {"archard-joint",
       with_law("{ distribution = \"uniform\", lower = \"0 mm^3/(N m)\", upper = \"1 "
                "mm^3/(N m)\" }") +
           "V0 = { distribution = \"flat\", unit = \"mm^3\" }\nexponent = { distribution = "
           "\"beta\", alpha = 2, beta = 2 }\n"},
      {"archard-joint", R"toml(model = "archard-joint"
[data]
file = "wear.csv"
[data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
work = { column = "work", unit = "J" }
[likelihood]
family = "normal"
[prior]
k = { distribution = "flat", unit = "mm^3/(N m)" }
sigma = { distribution = "flat", unit = "mm^3" }
[predict]
work_per_cycle = "5 N m"
cycles = [10000]
)toml"},
      {"formula", formula_model("normal", "mean = \"a + b * time\"\nsd = \"c\"",
                                R"toml([random_effects.bearing]
a = { distribution = "normal", sd = "r" }
b = { distribution = "lognormal", log_sd = "q" }
correlation = "u"
[predict]
along = "time"
[predict.quantities]
rate = { value = "b", unit = "um/h" }
)toml")},
      {"formula", formula_model("lognormal", "median = \"a + b * time\"\nlog_sd = \"q\"", "")},
      {"formula", formula_model("log10-normal", "median = \"a + b * time\"\nlog10_sd = \"q\"", "")},
      {"formula",
       formula_model("student-t", "df = 4\nlocation = \"a + b * time\"\nscale = \"c\"", "")},
      {"formula",
       formula_model("wiener-process", "mean = \"a + b * time\"\nscale = \"c\"\nnoise = \"r\"",
                     "[predict]\nalong = \"time\"\n")},
      {"formula", formula_model("generalized-gamma",
                                "scale = \"a + b * time\"\nsigma = \"q\"\nlambda = \"u\"", "")},
      {"formula",
       formula_model("log-location-scale",
                     "standard = \"logistic\"\nscale = \"a + b * time\"\nsigma = \"q\"", "")},
      {"formula", formula_model("exponentiated-weibull",
                                "scale = \"a + b * time\"\nshape = \"q\"\nexponent = 2", "")},
      {"formula",
       formula_model("weibull", "scale = \"a + b * time\"\nshape = \"q\"\nthreshold = \"1 [um]\"",
                     "[predict]\ngiven = { time = \"2 h\" }\ncompared_with = { time = \"3 h\" "
                     "}\nmean_life = true\nhazard_at = \"9 um\"\n")},
      {"formula",
       formula_model(
           "weibull", "scale = \"a + b * time\"\nshape = \"q\"",
           "[predict]\ngiven = { time = { values = [\"2 h\", \"3 h\"], shares = [2, 1] } }\n"
           "compared_with = { time = { distribution = \"uniform\", lower = \"1 h\", "
           "upper = \"3 h\" } }\naccelerated = { time = { distribution = \"uniform\", "
           "lower = \"3 h\", upper = \"4 h\" } }\n")},
      {"formula", R"toml(model = "formula"
[data]
file = "wear.csv"
[data.columns]
failed = "count"
trials = "trials"
[likelihood.failed]
family = "binomial"
probability = "p"
trials = "trials"
[prior]
p = { distribution = "beta", alpha = 2, beta = 2 }
)toml"},
      {"formula", R"toml(model = "formula"
[data]
file = "shock_absorbers.csv"
[data.columns]
life = { column = "km", unit = "km" }
mode = "failure mode"
[failure_modes]
column = "mode"
runout = "censored"
unknown = "n/a"
[failure_modes."mode 2"]
family = "lognormal"
median = "middle"
log_sd = "scatter"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
middle = { distribution = "lognormal", median = "30000 km", log_sd = 1 }
scatter = { distribution = "lognormal", median = 0.5, log_sd = 0.5 }
eta = { distribution = "lognormal", median = "30000 km", log_sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.5 }
)toml"},
      {"formula", R"toml(model = "formula"
[data]
file = "returns.csv"
[data.returns]
sold = "sold"
quantity = "shipped"
period = "month"
ages = "middle"
delay_to_use = "0.1 month"
delay_of_report = "0.1 month"
warranty = "36 month"
hold_out = "2 month"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "100 month", log_sd = 1 }
beta = { distribution = "lognormal", median = 1, log_sd = 0.5 }
[predict]
next = "12 month"
cost_per_return = "180 EUR"
planned_sales = { file = "planned_sales.csv", sold = "month", quantity = "units" }
)toml"},
      {"formula", R"toml(model = "formula"
[data]
file = "returns.csv"
[data.returns]
sold = "sold"
quantity = "shipped"
period = "month"
ages = "middle"
delay_to_use = { distribution = "lognormal", median = "0.1 month", log_sd = 0.5, lower = "0 month", upper = "3 month", unit = "month" }
delay_of_report = { distribution = "lognormal", mean = "0.1 month", sd = "0.1 month" }
warranty = "36 month"
hold_out = "2 month"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "100 month", log_sd = 1 }
beta = { distribution = "lognormal", median = 1, log_sd = 0.5 }
[predict]
next = "12 month"
cost_per_return = "180 EUR"
planned_sales = { file = "planned_sales.csv", sold = "month", quantity = "units" }
)toml"},
      {"formula", R"toml(model = "formula"
[data]
file = "returns.csv"
[data.returns]
sold = "sold"
quantity = "shipped"
period = "month"
ages = "middle"
delay_to_use = { distribution = "gamma", scale = "0.1 month", shape = 2 }
delay_of_report = { file = "delays.csv", delay = { column = "months", unit = "month" }, share = { column = "share", unit = "1" } }
warranty = "36 month"
hold_out = "2 month"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
[prior]
eta = { distribution = "lognormal", median = "100 month", log_sd = 1 }
beta = { distribution = "lognormal", median = 1, log_sd = 0.5 }
[predict]
next = "12 month"
cost_per_return = "180 EUR"
planned_sales = { file = "planned_sales.csv", sold = "month", quantity = "units" }
)toml"},
      {"formula", R"toml(model = "formula"
[data]
file = "shock_absorbers.csv"
unused = ["failure mode"]
[data.columns]
life = { column = "km", unit = "km" }
[subpopulations]
names = ["early", "late"]
share = { early = "weak" }
[subpopulations.late]
family = "lognormal"
median = "middle"
log_sd = "scatter"
[likelihood.life]
family = "weibull"
scale = "eta"
shape = "beta"
share_defective = "p"
share_dead_on_arrival = 0.01
[prior]
middle = { distribution = "lognormal", median = "30000 km", log_sd = 1 }
scatter = { distribution = "lognormal", median = 0.5, log_sd = 0.5 }
eta = { distribution = "lognormal", median = "3000 km", log_sd = 1 }
beta = { distribution = "lognormal", median = 2, log_sd = 0.5 }
weak = { distribution = "beta", alpha = 1, beta = 3 }
p = { distribution = "beta", alpha = 2, beta = 2 }
)toml"},
      {"repairable", R"toml(model = "repairable"
process = "power_law"
[data]
file = "events.csv"
end = "last failure"
rounding = "1 day"
[data.columns]
unit = "unit"
age = "age"
start = "start"
event = { column = "event", failure = "broke", end = "sold" }
[conditions]
reference_age = "600 day"
[prior]
M_T = { distribution = "default" }
[predict]
next = ["100 day"]
credible_level = 0.95
)toml"},
      {"repairable", R"toml(model = "repairable"
process = "phases"
[data]
file = "growth.csv"
end = "last failure"
[data.columns]
unit = "system"
age = "test time"
event = "event"
[conditions]
phase_ends = ["500 h"]
[prior]
MTBF_2 = { distribution = "default" }
)toml"},
      {"repairable", R"toml(model = "repairable"
process = "phases"
[data]
file = "delayed_fixes.csv"
[data.columns]
unit = "system"
age = "test time"
event = "event"
mode = "mode"
[fixes]
none = ["A", "BD2", "BD3", "BD4", "BD5", "BD6", "BD7", "BD8", "BD9", "BD10", "BD11", "BD12", "BD13",
  "BD14", "BD15", "BD16"]
during = ["BC17", "BC18", "BC19", "BC20", "BC21", "BC22", "BC23", "BC24", "BC25", "BC26", "BC27",
  "BC28"]
[fixes.effectiveness]
BD1 = { distribution = "beta", alpha = 7, beta = 3 }
)toml"},
      {"repairable", R"toml(model = "repairable"
process = "renewal"
[data]
file = "valve_seats.csv"
rounding = "1 day"
[data.columns]
unit = "engine"
age = "age"
event = { column = "event", failure = 1 }
[prior]
eta = { distribution = "default" }
)toml"},
  };
  return all;
}

void add_examples(std::vector<std::pair<std::string, std::string>>& studies) {
  const std::map<std::string, std::string> folders = {
      {"joint", "archard-joint"}, {"bearing", "bearing-wear"}, {"fatigue", "sn"},
      {"spring", "sn"},           {"clutch", "clutch-wear"},   {"formula", "formula"},
      {"life", "formula"},        {"accelerated", "formula"},  {"repairable", "repairable"},
      {"warranty", "formula"},    {"fleet", "formula"}};
  for (const auto& [folder, model] : folders) {
    for (const auto& entry :
         fs::directory_iterator(fs::path(PROJECT_SOURCE_DIR) / "examples" / folder)) {
      if (entry.path().extension() != ".toml" || entry.path().filename() == "truth.toml" ||
          entry.path().filename() == "monitor.toml")
        continue;
      std::string text = read_text_file(entry.path()).text;
      if (folder == "formula") text = std::regex_replace(text, std::regex("wear\\.csv"), "law.csv");
      studies.emplace_back(model, text);
    }
  }
}

// What stands in docs/reference/study-keys.md of some keys.
using Asked = std::map<std::string, std::set<std::string>>;

std::string kinds_of(const StudyKey& key, const Asked& asked) {
  std::set<std::string> kinds;
  for (const auto& [path, each] : asked) {
    if (matches_key(key.path, path)) kinds.insert(each.begin(), each.end());
  }
  const std::string table = split(key.path).first;
  if (table.ends_with("columns")) return "heading, or `{ column, unit }`";
  if (key.path.starts_with("prior.") && !key.path.starts_with("prior.*"))
    return "law with its keys";
  if ((key.path.starts_with("predict.") || key.path.starts_with("fixes.")) &&
      (key.path.ends_with(".*.*") || key.path.ends_with(".*.distribution")))
    return "as in `[prior]`";
  const bool of_unknown = key.path.starts_with("prior.*") || key.path.ends_with("half_width.*");
  if (of_unknown && !kinds.empty() && (kinds.size() > 1 || kinds.begin()->starts_with("text like")))
    return "as the unknown";
  return fmt::format("{}", fmt::join(kinds, " or "));
}

std::string needed_words(const StudyKey& key) {
  if (!key.needed) return "";
  const auto list = [](const std::vector<std::string>& conditions) {
    std::vector<std::string> shown;
    for (const std::string& each : conditions) {
      const std::string plain = each.starts_with('.') ? each.substr(1) : each;
      const std::size_t equals = plain.find('=');
      shown.push_back(equals == plain.npos ? "`" + plain + "`"
                                           : fmt::format("`{} = \"{}\"`", plain.substr(0, equals),
                                                         plain.substr(equals + 1)));
    }
    return fmt::format("{}", fmt::join(shown, " or "));
  };
  std::string words = key.when.empty() ? "yes" : "with " + list(key.when);
  if (!key.unless.empty()) words += ", unless " + list(key.unless);
  return words;
}

std::string block(const StudyKeys& keys, const Asked& asked) {
  std::string text =
      "| key | for example | may be | needed | what it is |\n|---|---|---|---|---|\n";
  for (const StudyKey& key : keys)
    text += fmt::format("| `{}` | `{}` | {} | {} | {} |\n", key.path, key.example,
                        kinds_of(key, asked), needed_words(key), key.meaning);
  return text;
}

void expect_asked(const StudyKeys& keys, const Asked& asked) {
  for (const StudyKey& key : keys) {
    const bool is_asked = std::any_of(asked.begin(), asked.end(), [&](const auto& one) {
      return matches_key(key.path, one.first);
    });
    EXPECT_TRUE(is_asked) << "nobody asks for " << key.path;
  }
}

// Keys that readers ask for stand in the lists, keys of the lists are asked for; and the docs say so.
TEST_F(StudyKeysTest, ListsHoldWhatReadersAskForAndDocsShowThem) {
  for (const Start& start : starts())
    read(model(start.model), toml(completed(model(start.model), start.values)));
  for (const auto& [key, text] : rich_studies()) read(model(key), text);
  std::vector<std::pair<std::string, std::string>> examples;
  add_examples(examples);
  for (const auto& [key, text] : examples) read(model(key), text);
  const Model& clutch = model("clutch-wear");
  const CommandResult rig = run_command(fmt::format(
      "cd '{}' && '{}' clutch simulate --design design.csv --truth truth.toml --traces 1 -o rig",
      folder().string(), WEARWELL_BINARY));
  ASSERT_EQ(rig.exit_code, 0) << rig.err;
  read(clutch, toml(completed(clutch, {{"data.design", "\"design.csv\""},
                                       {"data.cycles", "\"rig/cycles.csv\""},
                                       {"data.weighings", "\"rig/weighings.csv\""},
                                       {"data.traces", "\"rig/traces.csv\""}})));
  Values tables;
  const std::pair<const char*, const char*> columns[] = {{"design", "torque = N m"},
                                                         {"cycles", "torque = N m"},
                                                         {"weighings", "mass = g"},
                                                         {"traces", "torque = N m"}};
  for (const auto& [table, column] : columns) {
    const std::string name = std::string(column).substr(0, std::string(column).find(' ')),
                      unit = std::string(column).substr(name.size() + 3),
                      path = std::string("data.") + table;
    const std::string file =
        table == std::string("design") ? "design.csv" : fmt::format("rig/{}.csv", table);
    tables.emplace_back(path + ".file", fmt::format("\"{}\"", file));
    tables.emplace_back(path + ".sql", "\"select * from data\"");
    tables.emplace_back(path + ".columns." + name,
                        fmt::format("{{ column = \"{0} [{1}]\", unit = \"{1}\" }}", name, unit));
  }
  read(clutch, toml(completed(clutch, tables)));
  std::string docs =
      read_text_file(fs::path(PROJECT_SOURCE_DIR) / "docs/reference/study-keys.md").text;
  const auto put = [&](const std::string& name, const std::string& content) {
    const std::string begin = fmt::format("<!-- keys: {} -->\n", name), end = "<!-- end -->";
    const std::size_t from = docs.find(begin);
    ASSERT_NE(from, docs.npos) << name;
    const std::size_t at = from + begin.size();
    docs.replace(at, docs.find(end, at) - at, content);
  };
  const StudyKeys common = posterior_keys();
  Asked of_all;
  for (const Model& each : all_models()) {
    if (!each.keys) continue;
    const StudyKeys keys = each.keys();
    const Asked& asked = asked_[std::string(each.key)];
    for (const auto& [path, kinds] : asked) of_all[path].insert(kinds.begin(), kinds.end());
    for (const auto& [path, kinds] : asked) {
      // A staircase asks for them to refuse them with the reason.
      if ((each.key == "staircase" || each.key == "repairable") && path == "predict.b_lives")
        continue;
      const bool known =
          std::any_of(keys.begin(), keys.end(), [&, &path = path](const StudyKey& key) {
            return matches_key(key.path, path) || key.path.starts_with(path + ".");
          });
      EXPECT_TRUE(known) << each.key << " asks for " << path << ", which is not in its list";
    }
    StudyKeys own;
    for (const StudyKey& key : keys) {
      const bool is_common = std::any_of(common.begin(), common.end(),
                                         [&](const StudyKey& one) { return one.path == key.path; });
      if (!is_common || &each == &clutch) own.push_back(key);
    }
    expect_asked(own, asked);
    put(std::string(each.key), block(own, asked));
  }
  expect_asked(common, of_all);
  put("all", block(common, of_all));
  const fs::path file = fs::path(PROJECT_SOURCE_DIR) / "docs/reference/study-keys.md";
  if (std::getenv("WEARWELL_WRITE_DOCS")) std::ofstream(file) << docs;
  EXPECT_EQ(docs, read_text_file(file).text) << "docs/reference/study-keys.md is not what readers "
                                                "ask for; WEARWELL_WRITE_DOCS=1 writes it anew";
}

// The studies of the tutorials, whose data are the reader's own: no key of theirs is wrong or missing.
TEST(DocsStudies, HaveTheKeysThatTheyNeed) {
  int studies = 0;
  for (const char* page : {"joint", "bearing", "fatigue", "clutch"}) {
    const std::string text = read_text_file(fs::path(PROJECT_SOURCE_DIR) / "docs/reference" /
                                            (std::string(page) + ".md"))
                                 .text;
    const std::string begin = "```toml\n", end = "```\n";
    for (std::size_t at = text.find(begin); at != text.npos; at = text.find(begin, at)) {
      at += begin.size();
      const std::string toml = text.substr(at, text.find(end, at) - at);
      if (!toml.starts_with("model = ")) continue;
      const TomlReader root = TomlReader::parse({fs::path(page), toml});
      EXPECT_EQ(key_faults(root, model(*root.text("model")).keys(), ""), "");
      ++studies;
    }
  }
  EXPECT_EQ(studies, 4);
}

}  // namespace
}  // namespace wearwell
