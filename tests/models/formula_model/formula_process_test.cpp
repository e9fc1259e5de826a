// Paths with random increments, against R (tests/golden/process.R), differences and brute force.
#include "wearwell/models/formula_model/formula_process.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <random>
#include <sstream>

#include "models/formula_model/process_form.h"
#include "support/posterior_study.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/models/formula_model/formula_first_passage.h"
#include "wearwell/study/run_study.h"

namespace wearwell::formula_model {
namespace {

double sum_at(const ProcessForm& form, const std::vector<double>& y,
              const std::vector<std::vector<double>>& family_parameters,
              std::vector<double>* slope = nullptr) {
  std::vector<double> value(y.size());
  if (slope) slope->resize(3 * y.size());
  process_terms(form, {y, family_parameters[0], family_parameters[1], family_parameters[2]}, value,
                slope ? std::span<double>(*slope) : std::span<double>());
  double sum = 0;
  for (const double each : value) sum += each;
  return sum;
}

// Every slot of every row, by differences.
TEST(FormulaProcess, SlopesAreThoseOfTheSum) {
  const std::vector<double> y = {0.8, 1.1, 2.9, 3.3};
  const std::vector<double> mean = {0.7, 1.5, 2.4, 3.6}, scale = {0.5, 0.4, 0.5, 0.7},
                            sd = {0.3, 0.5, 0.55, 0.8}, noise = {0.2, 0.1, 0.3, 0.25};
  struct Case {
    const ProcessForm& form;
    bool by_sd, noisy;
  };
  for (const Case& each :
       {Case{form_of(Process::wiener), false, true}, Case{form_of(Process::wiener), false, false},
        Case{form_of(Process::wiener, true), true, true},
        Case{form_of(Process::gamma), false, false},
        Case{form_of(Process::inverse_gaussian), false, false}}) {
    std::vector<std::vector<double>> family_parameters = {
        mean, each.by_sd ? sd : scale, each.noisy ? noise : std::vector<double>()};
    std::vector<double> slope;
    const double at = sum_at(each.form, y, family_parameters, &slope);
    EXPECT_DOUBLE_EQ(at, sum_at(each.form, y, family_parameters));
    for (std::size_t s = 0; s < (each.noisy ? 3u : 2u); ++s) {
      for (std::size_t i = 0; i < y.size(); ++i) {
        const double kept = family_parameters[s][i], h = 1e-5;
        family_parameters[s][i] = kept + h;
        const double above = sum_at(each.form, y, family_parameters);
        family_parameters[s][i] = kept - h;
        const double by_difference = (above - sum_at(each.form, y, family_parameters)) / (2 * h);
        family_parameters[s][i] = kept;
        EXPECT_NEAR(slope[s * y.size() + i], by_difference, 1e-6 * (1 + std::abs(by_difference)))
            << each.form.form.name << s << i;
      }
    }
  }
}

// Rates, scales and readings as far as doubles go: a density and its slopes are finite, or the density
// is zero.
TEST(FormulaProcess, ExtremesAreFiniteOrNoDensity) {
  constexpr double extremes[] = {0,   5e-324, 1e-310, 1e-302, 1e-150, 1e-9,
                                 0.5, 1e9,    1e150,  1e300,  1.7e308};
  int finite = 0;
  for (const ProcessForm& form : process_forms()) {
    for (const bool noisy : {false, true}) {
      for (const double mean : extremes) {
        for (const double spread : extremes) {
          for (const double reading : {1e-300, 0.8, 1e300}) {
            const std::vector<double> y = {reading, 2 * reading, 3 * reading},
                                      m = {mean, 2 * mean, 3 * mean}, s(3, spread),
                                      noise = noisy ? std::vector<double>(3, 0.1 * reading)
                                                    : std::vector<double>();
            std::vector<double> value(3), slope(9, 0.0);
            ASSERT_NO_THROW(process_terms(form, {y, m, s, noise}, value, slope))
                << form.form.name << " " << mean << " " << spread << " " << reading;
            const double sum = value[0] + value[1] + value[2];
            if (sum == -infinity) continue;
            ++finite;
            EXPECT_TRUE(std::isfinite(sum));
            for (const double each : slope) {
              EXPECT_TRUE(std::isfinite(each))
                  << form.form.name << " " << mean << " " << spread << " " << reading;
            }
          }
        }
      }
    }
  }
  EXPECT_GT(finite, 100);
}

// tests/golden/process.R
TEST(FormulaProcess, FirstPassagesAreThoseOfR) {
  const double golden[][6] = {{10, 0.05, 0.05, 8.8810874, 8.8765135, 8.8642169},
                              {10, 0.05, 0.5, 9.9750726, 10.016662, 10.024928},
                              {10, 0.05, 0.95, 11.203942, 11.201928, 11.18603},
                              {2, 1.5, 0.05, 0.44941925, 0.43134959, 0.51438973},
                              {2, 1.5, 0.5, 1.4684651, 2.4781402, 2.5669132},
                              {2, 1.5, 0.95, 5.3630109, 5.9144264, 5.1819959},
                              {0.3, 2, 0.05, 0.01100103, 0.068952644, 0.079445215},
                              {0.3, 2, 0.5, 0.07348561, 0.81253538, 0.70120379},
                              {0.3, 2, 0.95, 1.3188735, 2.8280731, 1.776628}};
  for (const auto& row : golden) {
    int column = 3;
    for (const Process each : {Process::wiener, Process::gamma, Process::inverse_gaussian}) {
      EXPECT_NEAR(passage_quantile(each, row[0], row[1], row[2]) / row[column], 1, 1e-7)
          << row[0] << " " << row[2] << " " << column;
      ++column;
    }
  }
}

TEST(FormulaProcess, TheTableOfFirstPassagesIsTheSame) {
  for (const Process each : {Process::wiener, Process::gamma, Process::inverse_gaussian}) {
    const ScoreTable& table = ScoreTable::passages(each);
    for (const double distance : {1e-5, 0.0123, 0.7, 5.0, 137.0, 4e5, 3e7}) {
      double mean[ScoreTable::edges];
      table.look_up(distance, 1, mean);
      for (int k = 0; k < ScoreTable::edges; k += 5) {
        const double p = 0.5 * std::erfc((4.8 - 0.4 * k) / std::sqrt(2.0));
        EXPECT_NEAR(mean[k] / passage_quantile(each, distance, 1, p), 1, 2e-5)
            << distance << " " << k;
      }
    }
  }
}

class FormulaProcessStudy : public ScratchTest {
 protected:
  PosteriorSummary run(const std::string& text) const {
    return run_study(wearwell::read_posterior_study(write("study.toml", text)),
                     {Method::exact, 1, {}, 50, {}}, {}, false);
  }
  std::string lasers(const std::string& family, const std::string& spread,
                     const std::string& predict = "") const {
    const auto to = folder() / "laser.csv";
    if (!std::filesystem::exists(to)) {
      std::filesystem::copy_file(PROJECT_SOURCE_DIR "/examples/degradation/laser.csv", to);
    }
    return "model = \"formula\"\n[data]\nfile = \"laser.csv\"\n[data.columns]\n"
           "increase = { column = \"increase_percent\", unit = \"%\" }\n"
           "time = { column = \"hours\", unit = \"h\" }\nlaser = \"laser\"\n"
           "[likelihood.increase]\nfamily = \"" +
           family + "\"\nmean = \"rate * time\"\n" + spread +
           "[prior]\nrate = { distribution = \"flat\", unit = \"%/h\" }\nu = { distribution = "
           "\"flat\", unit = "
           "\"%\" }\n[predict]\nalong = \"time\"\n" +
           predict;
  }
};

// tests/golden/process.R; densities of readings in per cent.
TEST_F(FormulaProcessStudy, ModesOfTheLasersAreThoseOfR) {
  const PosteriorSummary gamma = run(lasers("gamma-process", "scale = \"u\"\n"));
  ASSERT_EQ(gamma.mode->problem, "");
  EXPECT_NEAR(gamma.mode->parameters[0].value, 0.0020371667, 2e-9);
  EXPECT_NEAR(gamma.mode->parameters[1].value, 0.070849331, 2e-7);
  EXPECT_NEAR(gamma.mode->log_likelihood, 69.609359, 2e-6);
  const PosteriorSummary inverse = run(lasers("inverse-gaussian-process", "scale = \"u\"\n"));
  ASSERT_EQ(inverse.mode->problem, "");
  EXPECT_NEAR(inverse.mode->parameters[0].value, 0.0020371667, 2e-9);
  EXPECT_NEAR(inverse.mode->parameters[1].value, 0.076159479, 2e-7);
  EXPECT_NEAR(inverse.mode->log_likelihood, 75.033857, 2e-6);
  // Each laser is left out, not each reading.
  ASSERT_TRUE(gamma.loo.has_value());
  EXPECT_EQ(gamma.loo->loo.terms.size(), 15u);
}

// The example that is shipped, with the other process that its comment offers: tails and searches go far out
// in each laser's rate. The rate of the median laser is near 0.002 %/h (the mode of R above, without scatter).
TEST_F(FormulaProcessStudy, TheExampleFitsAsAGammaProcessToo) {
  const std::filesystem::path example = PROJECT_SOURCE_DIR "/examples/degradation";
  std::filesystem::copy_file(example / "laser.csv", folder() / "laser.csv");
  std::stringstream read;
  read << std::ifstream(example / "study.toml").rdbuf();
  std::string text = read.str();
  const std::string family = "\"inverse-gaussian-process\"";
  ASSERT_NE(text.find(family), text.npos);
  text.replace(text.find(family), family.size(), "\"gamma-process\"");
  const PosteriorSummary result = run(text);
  EXPECT_TRUE(result.trusted);
  ASSERT_TRUE(result.parameters[0].exact.has_value());
  EXPECT_NEAR(result.parameters[0].exact->mean, 0.002, 3 * result.parameters[0].exact->sd);
}

// With noise, by the dense covariance of each laser (R), in both ways of writing it.
TEST_F(FormulaProcessStudy, AWienerProcessWithNoiseIsAJointNormalLaw) {
  const double per_cent = 240 * std::log(100.0);  // densities of plain numbers here
  const auto value = [&](const std::string& spread, double u) {
    const PosteriorStudy study =
        wearwell::read_posterior_study(write("study.toml", lasers("wiener-process", spread)));
    const std::vector<double> x = {0.002e-2 / 3600, u};
    return study.likelihood(study.data_rows)->value(x) - per_cent;
  };
  EXPECT_NEAR(value("scale = \"u\"\nnoise = \"0.1 [%]\"\n", 0.05e-2), 21.92832982, 1e-7);
  EXPECT_NEAR(value("scale = \"u\"\n", 0.05e-2), 29.46228652, 1e-7);
  // sd^2 = scale * mean, 0.05 % of 0.002 %/h, at 1 h.
  EXPECT_NEAR(value("sd = \"u * sqrt(time/1 [h])\"\nnoise = \"0.1 [%]\"\n", 0.01e-2), 21.92832982,
              1e-7);
}

// A rate of its own for each laser and random steps: the integral over each one's rate by the trapezoidal
// rule, wide and fine.
TEST_F(FormulaProcessStudy, UnitsThatDifferTakeRandomSteps) {
  for (const auto& [process, noise] :
       {std::pair(Process::gamma, 0.0), {Process::inverse_gaussian, 0.0}, {Process::wiener, 0.1}}) {
    const ProcessForm& form = form_of(process);
    const std::string noisy = noise > 0 ? "noise = \"0.1 [%]\"\n" : "";
    const std::string text = lasers(std::string(form.form.name), "scale = \"u\"\n" + noisy) +
                             "[random_effects.laser]\nrate = { distribution = \"lognormal\", "
                             "log_sd = \"0.25 + 0*u/1 [%]\" }\n";
    const PosteriorStudy study = wearwell::read_posterior_study(write("study.toml", text));
    const auto density = study.likelihood(study.data_rows);
    std::vector<double> x = {0.002e-2 / 3600, 0.05e-2};
    double expected = 0;
    for (std::size_t u = 0; u < 15; ++u) {
      std::vector<double> y, mean, scale(16, 0.05), error(noise > 0 ? 16 : 0, noise), value(16);
      for (std::size_t i = 0; i < 16; ++i) y.push_back(100 * study.observed[16 * u + i]);
      std::vector<double> terms;
      double highest = -INFINITY;
      for (int k = -1200; k <= 1200; ++k) {
        const double z = 0.005 * k, rate = 0.002 * std::exp(0.25 * z);
        mean.clear();
        for (std::size_t i = 0; i < 16; ++i)
          mean.push_back(rate * 250 * static_cast<double>(i + 1));
        process_terms(form, {y, mean, scale, error}, value, {});
        double sum = -0.5 * z * z - 0.5 * std::log(2 * M_PI);
        for (const double each : value) sum += each;
        terms.push_back(sum);
        highest = std::max(highest, sum);
      }
      double integral = 0;
      for (const double each : terms) integral += 0.005 * std::exp(each - highest);
      expected += highest + std::log(integral) + 16 * std::log(100.0);
    }
    EXPECT_NEAR(density->value(x), expected, 1e-5) << form.form.name;
    std::vector<double> gradient(2);
    density->value_and_gradient(x, gradient);
    for (std::size_t i = 0; i < 2; ++i) {
      const double at = x[i], h = 1e-4 * at;
      x[i] = at + h;
      const double above = density->value(x);
      x[i] = at - h;
      EXPECT_NEAR(gradient[i] * at, (above - density->value(x)) / (2 * h) * at, 1e-3);
      x[i] = at;
    }
  }
}

// Lives at one point of the parameters: those of the law; of a laser that was seen, from its last reading.
TEST_F(FormulaProcessStudy, LivesAreFirstPassages) {
  for (const Process process : {Process::wiener, Process::gamma, Process::inverse_gaussian}) {
    const std::string name(form_of(process).form.name);
    const PosteriorStudy study = wearwell::read_posterior_study(
        write("study.toml", lasers(name, "scale = \"u\"\n", "limit = { increase = \"10 %\" }\n")));
    WeightedDraws draws;
    draws.values.resize(1, 2);
    draws.values << 0.002e-2 / 3600, 0.07e-2;
    draws.weights.setOnes(1);
    const auto lives = study.quantity_groups.front().from_draws(draws);
    ASSERT_EQ(lives.size(), 16u);
    const auto hours = [&](double distance, double p) {
      return passage_quantile(process, distance, 0.07, p) / 0.002;
    };
    const auto expect = [&](const QuantityQuantiles& life, double distance) {
      EXPECT_NEAR(life.q05 / 3600 / hours(distance, 0.05), 1, 4e-3) << name;
      EXPECT_NEAR(life.q50 / 3600 / hours(distance, 0.5), 1, 4e-3) << name;
      EXPECT_NEAR(life.q95 / 3600 / hours(distance, 0.95), 1, 4e-3) << name;
    };
    expect(lives[0], 10);
    expect(lives[3], 10 - 6.88);
    EXPECT_EQ(lives[10].q95, 0);  // 12.21 %
  }
}

// Where a path is by then, and when it first gets there, are one thing of a path that only rises.
TEST_F(FormulaProcessStudy, PathsAheadAreThoseOfTheProcess) {
  for (const Process process : {Process::wiener, Process::gamma, Process::inverse_gaussian}) {
    const std::string name(form_of(process).form.name);
    const PosteriorStudy study = wearwell::read_posterior_study(
        write("study.toml", lasers(name, "scale = \"u\"\n", "at = [\"5000 h\"]\n")));
    WeightedDraws draws;
    draws.values.resize(1, 2);
    draws.values << 0.002e-2 / 3600, 0.07e-2;
    draws.weights.setOnes(1);
    const auto paths = study.quantity_groups.front().from_draws(draws);
    ASSERT_EQ(paths.size(), 16u);
    const auto expect = [&](const QuantityQuantiles& path, double from, double hours) {
      for (const auto& [value, p] :
           {std::pair(path.q05, 0.05), {path.q50, 0.5}, {path.q95, 0.95}}) {
        const double grown = 100 * value - from, mean = 0.002 * hours;
        if (process == Process::wiener) {
          const double off = (grown - mean) / std::sqrt(0.07 * mean);
          EXPECT_NEAR(0.5 * std::erfc(-off / std::sqrt(2.0)), p, 2e-3);
        } else {
          EXPECT_NEAR(passage_quantile(process, grown, 0.07, 1 - p) / mean, 1, 4e-3) << name << p;
        }
      }
    };
    expect(paths[0], 0, 5000);
    expect(paths[3], 6.88, 1000);
  }
}

TEST_F(FormulaProcessStudy, PathsOfAProcessAreDrawn) {
  const PosteriorSummary result = run_study(
      wearwell::read_posterior_study(PROJECT_SOURCE_DIR "/examples/degradation/steps.toml"),
      {Method::exact, 1, {}, 1000, {}}, {}, true);
  const auto& figures = result.plots->figures.at("predictions");
  ASSERT_EQ(figures.size(), 15u);
  EXPECT_EQ(figures[2].title, "Laser 3");
  // The limit: a rule at 10 %.
  EXPECT_NE(figures[2].specification.dump().find(R"("values":"y\n10")"), std::string::npos);
}

TEST_F(FormulaProcessStudy, WhatIsNoProcessIsRefused) {
  const auto refusal = [&](const std::string& text) {
    return message_of<InputError>(
        [&] { wearwell::read_posterior_study(write("study.toml", text)).description(); });
  };
  EXPECT_NE(refusal(lasers("wiener-process", "scale = \"u\"\n", "limit = { rate = \"10 %/h\" }\n"))
                .find("thresholds of this study are of increase"),
            std::string::npos);
  EXPECT_NE(refusal(lasers("wiener-process", "sd = \"u * time/1 [h]\"\n",
                           "limit = { increase = \"10 %\" }\n"))
                .find("proportional to the mean"),
            std::string::npos);
  write("laser.csv", "laser,hours,increase_percent\n1,10,0.5\n1,20,0.4\n2,10,0.1\n2,20,0.3\n");
  EXPECT_NE(refusal(lasers("gamma-process", "scale = \"u\"\n"))
                .find("0.4 % after 0.5: the path of the family gamma"),
            std::string::npos);
  // Readings with an error of their own may fall.
  EXPECT_NO_THROW(wearwell::read_posterior_study(
      write("study.toml", lasers("gamma-process", "scale = \"u\"\nnoise = \"0.1 [%]\"\n"))));
}

// With noise what differs from unit to unit is drawn, and the likelihood is that of each unit's hidden path.
TEST_F(FormulaProcessStudy, NoiseOfAGammaProcessLeavesEffectsToBeDrawn) {
  write("wear.csv", "unit,h,um\n1,100,4\n1,200,9\n1,300,8.5\n2,100,6\n2,200,11\n2,300,19\n");
  const PosteriorStudy study = wearwell::read_posterior_study(
      write("study.toml",
            "model = \"formula\"\n[data]\nfile = \"wear.csv\"\n[data.columns]\n"
            "wear = { column = \"um\", unit = \"um\" }\ntime = { column = \"h\", unit = \"h\" }\n"
            "unit = \"unit\"\n[likelihood.wear]\nfamily = \"gamma-process\"\nmean = \"rate*time\"\n"
            "scale = \"u\"\nnoise = \"s\"\n[prior]\n"
            "rate = { distribution = \"lognormal\", median = \"0.05 um/h\", log_sd = 1 }\n"
            "u = { distribution = \"lognormal\", median = \"2 um\", log_sd = 1 }\n"
            "s = { distribution = \"half-normal\", scale = \"3 um\" }\n"
            "apart = { distribution = \"half-normal\", scale = 1 }\n"
            "[random_effects.unit]\nrate = { distribution = \"lognormal\", log_sd = \"apart\" }\n"
            "[predict]\nalong = \"time\"\n"));
  ASSERT_EQ(study.parameters.size(), 7u);
  const auto likelihood = study.likelihood(study.data_rows);
  const double rate = 5e-8 / 3600, u = 2e-6, s = 1e-6, apart = 0.4;
  std::vector<double> x = {rate, u, s, apart, -0.5, 0.7, 0}, slope(7);
  double expected = 0;
  const std::vector<std::vector<double>> readings = {{4e-6, 9e-6, 8.5e-6}, {6e-6, 11e-6, 19e-6}};
  for (std::size_t i = 0; i < 2; ++i) {
    const double step = rate * std::exp(apart * x[4 + i]) * 360000;
    expected += sum_at(form_of(Process::gamma), readings[i],
                       {{step, 2 * step, 3 * step}, {u, u, u}, {s, s, s}});
  }
  EXPECT_NEAR(likelihood->value_and_gradient(x, slope), expected, 1e-8);
  for (std::size_t i = 0; i < 6; ++i) {
    const double kept = x[i], h = 1e-5 * std::abs(kept);
    x[i] = kept + h;
    const double above = likelihood->value(x);
    x[i] = kept - h;
    const double by_difference = (above - likelihood->value(x)) / (2 * h);
    x[i] = kept;
    EXPECT_NEAR(slope[i] * kept, by_difference * kept, 2e-4) << i;
  }
  const std::vector<double> each = likelihood->pointwise(x);
  EXPECT_EQ(each.size(), 2u);
}

}  // namespace
}  // namespace wearwell::formula_model
