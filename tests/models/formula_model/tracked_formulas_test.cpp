// Every kind of law that a study may have, followed on line: each unit as what a fit says of it, whether the study
// has seen its rows or they come one by one, in their order or late.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "models/formula_model/watched.h"
#include "wearwell/base/rng.h"

// Longer than others: a study for every kind of law.
namespace wearwell::formula_model {
namespace {

using prognosis::Forecast;
using prognosis::Reading;
using prognosis::UpdateResult;

struct Kind {
  std::string name, study;
  std::vector<Column> columns;
  /// The middle of the posterior, in the study's order of parameters, SI, and how far it is spread (of logarithms).
  std::vector<double> middle;
  double spread = 0.15;
  double tolerance = 1e-2;
};

// A posterior that is wide beside what one unit says: each parameter lognormal about its middle.
WeightedDraws around(const Kind& kind) {
  std::vector<std::vector<double>> x;
  Rng rng(11, 0);
  for (int i = 0; i < 600; ++i) {
    x.push_back(kind.middle);
    for (double& each : x.back()) each *= std::exp(kind.spread * rng.normal());
  }
  return points(x);
}

// The same, given the rows of unit u as well.
WeightedDraws given_unit(const Watched& watched, WeightedDraws draws, std::size_t u) {
  const auto rows = watched.rows();
  std::vector<double> log_weight;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double* x = draws.values.row(i).data();
    if (watched.design.model->has_random_effects()) {
      log_weight.push_back(rows->integrate(x).log_likelihood[u]);
      continue;
    }
    UnitRows& all = rows->mine().rows;
    all.move_to(x);
    std::vector<std::uint8_t> wanted(all.units(), 0);
    std::vector<double> value(all.units());
    wanted[u] = 1;
    all.evaluate({}, wanted, value, {});
    log_weight.push_back(value[u]);
  }
  const double top = *std::max_element(log_weight.begin(), log_weight.end());
  for (Eigen::Index i = 0; i < draws.weights.size(); ++i) {
    draws.weights[i] *= std::exp(log_weight[static_cast<std::size_t>(i)] - top);
  }
  draws.weights /= draws.weights.sum();
  return draws;
}

// The rows of unit u in the study's table, as readings.
std::vector<Reading> readings_of(const Watched& watched, std::size_t u) {
  std::vector<Reading> readings;
  const FormulaModel& model = *watched.design.model;
  for (const std::size_t row : model.order) {
    if (model.unit_of_row[row] != u) continue;
    Reading reading;
    for (const NumberColumn& each : model.data.numbers) reading.numbers.push_back(each.values[row]);
    for (const std::string& name : watched.tracker->labels()) {
      const LabelColumn& label = *model.data.label(name);
      reading.labels.push_back(label.levels[static_cast<std::size_t>(label.at[row])]);
    }
    readings.push_back(reading);
  }
  return readings;
}

std::vector<Column> without_last(const std::vector<Column>& columns, std::size_t rows) {
  std::vector<Column> fewer = columns;
  for (Column& each : fewer) {
    each.is_number ? each.numbers.resize(each.numbers.size() - rows)
                   : each.text.resize(each.text.size() - rows);
  }
  return fewer;
}

void expect_followed(const Kind& kind) {
  SCOPED_TRACE(kind.name);
  const WeightedDraws posterior = around(kind);
  const Watched whole(kind.study, kind.columns, posterior);
  const std::size_t last = whole.design.model->units.size() - 1;
  const std::string unit = whole.design.model->units[last];
  const std::vector<Reading> readings = readings_of(whole, last);
  const Watched part(kind.study, without_last(kind.columns, readings.size()), posterior);
  // Laws of life by population are of some forty points each.
  const double apart = std::max(kind.tolerance, 0.015);
  {
    SCOPED_TRACE("seen");
    const LimitedLives fit = lives_of_fit(whole, posterior, !whole.design.model->has_process());
    expect_alike(whole.tracker->begin(unit)->forecast(), fit.remaining[last], fit.passed[last],
                 kind.tolerance);
    if (!whole.design.model->has_process()) {  // dear in a fit
      expect_alike(whole.tracker->begin("new")->forecast(), fit.next, 0, kind.tolerance);
    }
    expect_populations(*whole.tracker, FollowedUnit(*whole.tracker, unit), apart);
    expect_populations(*whole.tracker, FollowedUnit(*whole.tracker, "new"), apart);
  }
  const LimitedLives fit = lives_of_fit(whole, given_unit(whole, posterior, last));
  std::vector<std::size_t> order(readings.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (const bool late : {false, true}) {
    SCOPED_TRACE(late ? "late" : "in order");
    if (late) std::swap(order[1], order.back());
    if (late) std::swap(order[0], order[2]);
    FollowedUnit followed(*part.tracker, unit);
    for (const std::size_t i : order) {
      const UpdateResult taken = followed.update(readings[i]);
      EXPECT_TRUE(taken.counted) << taken.problem;
      EXPECT_FALSE(taken.contradicts) << taken.p_value;
      const std::string bytes = followed.unit->save();
      followed.unit = part.tracker->restore(bytes);
      EXPECT_EQ(bytes, followed.unit->save());
    }
    expect_alike(followed.unit->forecast(), fit.remaining[last], fit.passed[last], kind.tolerance);
    const bool both_ways = kind.study.find("wiener") != std::string::npos;
    expect_path_ahead(*part.tracker, *followed.unit, both_ways, 0.03 + kind.tolerance);
    if (!late) expect_populations(*part.tracker, followed, apart);
  }
}

// Rows of units u0 .. u3 at 1 .. 6.
struct Rows {
  std::vector<double> time, one;
  std::vector<std::string> unit;
  std::size_t count() const { return time.size(); }

  Rows() {
    for (int u = 0; u < 4; ++u) {
      for (int i = 1; i <= 6; ++i) {
        time.push_back(i);
        one.push_back(1);
        unit.push_back("u" + std::to_string(u));
      }
    }
  }
  template <class Value>
  std::vector<double> with(const Value& value) const {
    std::vector<double> all;
    for (std::size_t i = 0; i < count(); ++i) all.push_back(value(i / 6, time[i]));
    return all;
  }
};

const std::string data_of_time = R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
)toml";
const std::string limit_of_depth = R"toml(
[predict]
along = "time"
limit = { depth = "12 um" }
)toml";
const double wobble[] = {0.1, -0.2, 0.15, 0.05, -0.1, 0.2};

TEST(TrackedLaws, TwoEffectsOfEachUnit) {
  const Rows rows;
  const double slope[] = {0.9, 1.2, 1.0, 1.15}, offset[] = {0.4, -0.2, 0.1, 0.6};
  Kind kind{"two effects",
            data_of_time + R"toml(
[formula]
wear = "a + b * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
a = { distribution = "normal", mean = "0.5 um", sd = "1 um" }
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
sa = { distribution = "half-normal", scale = "1 um" }
sb = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
a = { distribution = "normal", sd = "sa" }
b = { distribution = "lognormal", log_sd = "sb" }
[predict]
along = "time"
limit = { wear = "12 um" }
)toml",
            {numbers("depth", rows.with([&](std::size_t u, double t) {
               return offset[u] + slope[u] * t + wobble[static_cast<int>(t) - 1];
             })),
             numbers("time", rows.time), texts("unit", rows.unit)},
            {0.5 * um, 1 * um / h, 0.5 * um, 0.3, 0.2 * um}};
  kind.tolerance = 0.02;
  expect_followed(kind);
}

TEST(TrackedLaws, AStateUnderLoadsThatChange) {
  const Rows rows;
  const std::vector<double> force =
      rows.with([](std::size_t u, double t) { return 20 + 5 * std::sin(u + 2 * t); });
  std::vector<double> depth;
  const double pace[] = {0.9, 1.2, 1.0, 1.15};
  double at = 0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (i % 6 == 0) at = 0;
    at += 0.05 * pace[i / 6] * force[i] * (1 - at / 40);
    depth.push_back(at + wobble[i % 6]);
  }
  expect_followed({"state",
                   R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
force = { column = "force", unit = "N" }
time = { column = "time", unit = "h" }
unit = "unit"
[formula]
"d(depth)/d(time)" = "k * force * (1 - depth / h0)"
[constants]
h0 = "40 um"
[likelihood.depth]
family = "normal"
mean = "depth"
sd = "sigma"
[prior]
k = { distribution = "lognormal", median = "0.05 um/(N h)", log_sd = 0.5 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
k = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
given = { force = "22 N" }
limit = { depth = "12 um" }
)toml",
                   {numbers("depth", depth), numbers("force", force), numbers("time", rows.time),
                    texts("unit", rows.unit)},
                   {0.05 * um / h, 0.3, 0.2 * um}});
}

TEST(TrackedLaws, ARunningSum) {
  const Rows rows;
  const std::vector<double> force =
      rows.with([](std::size_t u, double t) { return 20 + 5 * std::sin(u + 2 * t); });
  std::vector<double> depth;
  const double pace[] = {0.9, 1.2, 1.0, 1.15};
  double at = 0;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    if (i % 6 == 0) at = 0;
    at += 0.05 * pace[i / 6] * force[i];
    depth.push_back(at + wobble[i % 6]);
  }
  expect_followed({"cum",
                   R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
force = { column = "force", unit = "N" }
step = { column = "step", unit = "h" }
time = { column = "time", unit = "h" }
unit = "unit"
[formula]
wear = "k * cum(force * step)"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
k = { distribution = "lognormal", median = "0.05 um/(N h)", log_sd = 0.5 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
k = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
given = { force = "22 N" }
limit = { wear = "12 um" }
)toml",
                   {numbers("depth", depth), numbers("force", force), numbers("step", rows.one),
                    numbers("time", rows.time), texts("unit", rows.unit)},
                   {0.05 * um / h, 0.3, 0.2 * um}});
}

TEST(TrackedLaws, RandomIncrements) {
  const Rows rows;
  const double pace[] = {0.9, 1.2, 1.0, 1.15};
  const double part[] = {0.8, 2.3, 2.9, 4.3, 4.8, 6.1};
  const std::vector<double> depth =
      rows.with([&](std::size_t u, double t) { return pace[u] * part[static_cast<int>(t) - 1]; });
  const auto study = [&](const std::string& family, const std::string& noise, bool random_effects) {
    return data_of_time + "[likelihood.depth]\nfamily = \"" + family + "\"\nmean = \"b * time\"\n" +
           "scale = \"s\"\n" + (noise.empty() ? "" : "noise = \"" + noise + "\"\n") + R"toml(
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
s = { distribution = "half-normal", scale = "0.3 um" }
)toml" +
           (noise.empty() ? ""
                          : noise + " = { distribution = \"half-normal\", scale = \"0.2 um\" }\n") +
           (random_effects ? R"toml(scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
)toml"
                           : "") +
           limit_of_depth;
  };
  for (const bool random_effects : {true, false}) {
    for (const std::string family :
         {"gamma-process", "inverse-gaussian-process", "wiener-process", "noise"}) {
      const bool noisy = family == "noise";
      Kind kind{family + (random_effects ? " that varies" : ""),
                study(noisy ? "wiener-process" : family, noisy ? "e" : "", random_effects),
                {numbers("depth", depth), numbers("time", rows.time), texts("unit", rows.unit)},
                {1 * um / h, 0.2 * um}};
      if (noisy) kind.middle.push_back(0.15 * um);
      if (random_effects) kind.middle.push_back(0.3);
      expect_followed(kind);
    }
  }
}

TEST(TrackedLaws, LevelsOfALabelAndALoadToCome) {
  const Rows rows;
  std::vector<std::string> material;
  for (std::size_t i = 0; i < rows.count(); ++i)
    material.push_back(i / 6 % 2 ? "PTFE" : "steel 1.0");
  expect_followed(
      {"levels",
       R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
force = { column = "force", unit = "N" }
time = { column = "time", unit = "h" }
material = "material"
unit = "unit"
[formula]
wear = "b * c[material] / c[\"steel 1.0\"] * force / f0 * time"
[constants]
f0 = "20 N"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
c = { distribution = "lognormal", median = 1, log_sd = 0.3 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
given = { force = "30 N", material = "PTFE" }
limit = { wear = "12 um" }
)toml",
       {numbers("depth", rows.with([&](std::size_t u, double t) {
          return (0.9 + 0.1 * u) * t + wobble[static_cast<int>(t) - 1];
        })),
        numbers("force", rows.with([](std::size_t, double) { return 20.0; })),
        numbers("time", rows.time), texts("material", material), texts("unit", rows.unit)},
       {1 * um / h, 1, 1, 0.3, 0.2 * um}});
}

TEST(TrackedLaws, SeveralColumnsOfWhichSomeAreMissing) {
  const Rows rows;
  const double nothing = std::nan("");
  expect_followed({"columns",
                   R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
heat = { column = "heat", unit = "W" }
time = { column = "time", unit = "h" }
unit = "unit"
[formula]
wear = "b * time"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "sigma"
[likelihood.heat]
family = "lognormal"
median = "c * b"
log_sd = "q"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
c = { distribution = "lognormal", median = "1 W h/um", log_sd = 0.3 }
q = { distribution = "half-normal", scale = 0.3 }
scatter = { distribution = "half-normal", scale = 0.5 }
sigma = { distribution = "half-normal", scale = "0.5 um" }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { wear = "12 um" }
)toml",
                   {numbers("depth", rows.with([&](std::size_t u, double t) {
                      return t == 2 || t == 5
                                 ? nothing
                                 : (0.9 + 0.1 * u) * t + wobble[static_cast<int>(t) - 1];
                    })),
                    numbers("heat", rows.with([&](std::size_t u, double t) {
                      return t == 3 ? nothing : (0.9 + 0.1 * u) * std::exp(0.1 * std::sin(t));
                    })),
                    numbers("time", rows.time), texts("unit", rows.unit)},
                   {1 * um / h, 1e6 * h, 0.2, 0.3, 0.2 * um}});
}

TEST(TrackedLaws, ReadingsThatAreKnownToAnInterval) {
  const Rows rows;
  std::vector<double> lower, upper;
  for (std::size_t i = 0; i < rows.count(); ++i) {
    const double y = (0.9 + 0.1 * static_cast<double>(i / 6)) * rows.time[i] + wobble[i % 6];
    lower.push_back(i % 3 == 0 ? std::floor(y) : y);
    upper.push_back(i % 3 == 0 ? std::floor(y) + 1 : y);
  }
  std::string study = straight;
  const std::string depth = "depth = { column = \"depth\", unit = \"um\" }\n";
  study.replace(study.find(depth), depth.size(),
                "lower = { column = \"lower\", unit = \"um\" }\n"
                "upper = { column = \"upper\", unit = \"um\" }\n");
  expect_followed({"intervals",
                   study,
                   {numbers("lower", lower), numbers("upper", upper), numbers("time", rows.time),
                    texts("unit", rows.unit)},
                   {1 * um / h, 0.3, 0.2 * um}});
}

}  // namespace
}  // namespace wearwell::formula_model
