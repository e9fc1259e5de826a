#include "wearwell/models/fatigue/sn_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/fatigue/design_curve.h"
#include "wearwell/models/fatigue/sn_data.h"
#include "wearwell/models/fatigue/sn_figures.h"
#include "wearwell/models/fatigue/sn_fit_data.h"
#include "wearwell/models/fatigue/sn_likelihood.h"
#include "wearwell/models/fatigue/sn_parameters.h"
#include "wearwell/models/fatigue/sn_predictions.h"

namespace wearwell {
namespace {

using fatigue::LifeFamily;
using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::SecondSlope;
using fatigue::SnCurve;
using fatigue::SnLaw;

// The form of the curve and its scatter, unless it is Basquin's with constant scatter.
void read_curve(const TomlReader& table, bool random_limit, SnLaw& law) {
  const auto curve =
      table.choice("curve", {"basquin", "knee", "stromeyer", "bastenaire", "strain-life"});
  const auto slope = table.choice("second_slope", {"free", "haibach", "infinite"});
  const auto scatter = table.choice("scatter", {"constant", "grows"});
  if (curve == "knee") law.curve = SnCurve::knee;
  if (curve == "bastenaire") law.curve = SnCurve::bastenaire;
  if (curve == "strain-life") {
    law.curve = SnCurve::strain_life;
    if (law.correction != MeanStress::none)
      table.fail("mean_stress",
                 "must be \"none\": strain-life curves are for fully reversed tests");
    if (random_limit)
      table.fail("fatigue_limit", "is not possible: a strain-life curve has no fatigue limit");
  }
  // With an individual limit for each item Stromeyer's curve becomes that of a random fatigue
  // limit.
  if (curve == "stromeyer" && !random_limit) law.curve = SnCurve::stromeyer;
  if (slope && law.curve != SnCurve::knee) {
    table.fail("second_slope", "needs curve = \"knee\": it is the slope below the knee");
  }
  if (slope == "haibach") law.second_slope = SecondSlope::haibach;
  if (slope == "infinite") law.second_slope = SecondSlope::infinite;
  if (law.curve == SnCurve::knee && random_limit != (slope == "infinite")) {
    table.fail(random_limit ? "second_slope" : "fatigue_limit",
               "below a knee life has either a second slope (second_slope = \"free\" or "
               "\"haibach\"), or is infinite with a random limit: second_slope = \"infinite\" and "
               "fatigue_limit = \"random\" together");
  }
  if (law.curve == SnCurve::bastenaire && random_limit) {
    table.fail(
        "fatigue_limit",
        "Bastenaire's curve has one common limit; use random with basquin, stromeyer or knee");
  }
  law.scatter_grows = scatter == "grows";
  if (law.scatter_grows && random_limit) {
    table.fail("scatter",
               "lives already scatter more near a random fatigue limit; use grows with "
               "fatigue_limit = \"none\"");
  }
}

std::string curve_text(const SnLaw& law) {
  switch (law.curve) {
    case SnCurve::knee:
      return law.limit ? "N = N_D (S_f/S_D)^-k"
             : law.second_slope == SecondSlope::haibach
                 ? "N = N_D (S_f/S_D)^-k, below S_D with 2k - 1 for k"
                 : "N = N_D (S_f/S_D)^-k, below S_D with k2 for k";
    case SnCurve::stromeyer:
      return "S_f - limit = a N^b";
    case SnCurve::bastenaire:
      return "N = N_B B/(S_f - limit) exp(-((S_f - limit)/B)^C)";
    case SnCurve::strain_life:
      return "S_f = elastic (2N)^b + plastic (2N)^c, S_f a strain";
    case SnCurve::basquin:
      break;
  }
  return law.limit ? "S_f - limit = a N^b" : "S_f = a N^b";
}

std::string description(const SnLaw& law) {
  const std::string strength(strength_name(law.correction));
  std::string reversed;
  switch (law.correction) {
    case MeanStress::none:
      reversed = "S_a";
      break;
    case MeanStress::gerber:
      reversed = "S_a/(1 - (S_m/S_ut)^2)";
      break;
    case MeanStress::goodman:
    case MeanStress::soderberg:
    case MeanStress::morrow:
      reversed = fmt::format("S_a/(1 - S_m/{})", strength);
      break;
    case MeanStress::swt:
      reversed = "((S_m + S_a) S_a)^0.5";
      break;
    case MeanStress::walker:
      reversed = "(S_m + S_a)^(1 - gamma) S_a^gamma";
      break;
  }
  std::string words = fmt::format("S_f = {}, {}", reversed, curve_text(law));
  if (law.strength) words += fmt::format(", {} = {:.6g} MPa", strength, *law.strength * 1e-6);
  if (law.gamma) words += fmt::format(", gamma = {:.4g}", *law.gamma);
  words += law.family == LifeFamily::log10_normal
               ? fmt::format("; log10 N scatters normally with standard deviation sigma{}",
                             law.scatter_grows ? " (N/1e6)^sigma_growth" : "")
           : law.family == LifeFamily::weibull
               ? "; N is Weibull of shape 1/(sigma ln 10), 63.2 % below the curve"
               : "; N scatters normally with standard deviation sigma";
  if (law.limit) {
    words += fmt::format(
        "; log10 of the limit is {} with location {} and scale sigma_limit, and life is infinite "
        "below it",
        *law.limit == StandardDistribution::normal ? "normal" : "smallest extreme value",
        law.curve == SnCurve::knee ? "log10_S_D" : "log10_limit");
  }
  return words;
}

// "9 tests: 8 failures, 1 runout", with the ranges of stresses and lives.
std::vector<std::string> notes(const SnLaw& law, const SnData& data) {
  static constexpr const char* outcomes[] = {"failure", "runout", "left-censored", "interval"};
  long long counts[4] = {}, all = 0;
  std::vector<double> alternating, mean, life;
  for (const LifeTest& test : data.tests) {
    counts[static_cast<int>(test.outcome)] += test.count;
    all += test.count;
    alternating.push_back(from_si(data.stress_unit, test.stress.alternating));
    mean.push_back(from_si(data.stress_unit, test.stress.mean));
    life.push_back(from_si(data.life_unit, test.life));
  }
  std::string tests = fmt::format("{} test{}:", all, all == 1 ? "" : "s");
  const char* separator = " ";
  for (int i = 0; i < 4; ++i) {
    if (counts[i] == 0) continue;
    tests += fmt::format("{}{} {}{}", separator, counts[i], outcomes[i],
                         counts[i] > 1 && i < 2 ? "s" : "");
    separator = ", ";
  }
  const auto span = [](const std::vector<double>& values, const Unit& unit) {
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    return fmt::format("{:.5g} to {:.5g}{}", *least, *most, after_number(unit));
  };
  std::string stresses = "alternating stress " + span(alternating, data.stress_unit);
  if (law.correction != MeanStress::none)
    stresses += ", mean stress " + span(mean, data.stress_unit);
  return {tests, stresses, "life " + span(life, data.life_unit)};
}

// Of the strains of a strain-life curve: Ramberg and Osgood's cyclic stress-strain curve, eps = sigma/E +
// (sigma/K')^(1/n'), whose parts are the two lines: n' = b/c, K' = sigma_f'/eps_f'^n'.
QuantityGroup cyclic_curve(const TomlReader& root) {
  const auto conditions = root.table("conditions");
  const auto modulus = conditions ? conditions->quantity("E", "Pa") : std::nullopt;
  if (modulus && !(modulus->si() > 0)) conditions->fail("E", "must be positive");
  const double e = modulus ? modulus->si() : 1;
  const Unit stress = modulus ? read_unit("MPa", "Pa") : Unit{"1", 1, 0};
  const auto request = [](const std::string& name, const Unit& unit) {
    return QuantityRequest{name, "cyclic curve", "", unit, true, false, {}, {}, {}};
  };
  return {{request("n'", Unit{"1", 1, 0}), request(modulus ? "K'" : "K'/E", stress)},
          [=](const WeightedDraws& draws) {
            const QuantityDistribution n(draws, [](const double* x) { return x[1] / x[3]; });
            const QuantityDistribution k(draws, [=](const double* x) {
              return e * std::pow(10, x[0] - x[1] / x[3] * x[2]);
            });
            std::vector<QuantityQuantiles> both;
            for (const QuantityDistribution* each : {&n, &k})
              both.push_back(
                  {each->quantile(0.05), each->quantile(0.5), each->quantile(0.95), 0, 0, 0});
            return both;
          }};
}

}  // namespace

SnLaw read_sn_law(const TomlReader& root) {
  SnLaw law;
  const auto table = root.table("law");
  const auto correction =
      table ? table->choice("mean_stress", fatigue::mean_stress_names()) : std::nullopt;
  if (!correction) {
    root.fail("law",
              "needs mean_stress, the mean-stress correction: [law] mean_stress = \"goodman\", "
              "\"gerber\", \"soderberg\", \"morrow\", \"swt\", \"walker\" or \"none\"");
  }
  law.correction = *fatigue::mean_stress_named(*correction);
  const auto limit = table->choice("fatigue_limit", {"none", "random"});
  const std::vector<std::string> families = {"normal", "smallest-extreme-value"};
  const auto limit_family = table->choice("limit_family", families);
  if (limit == "random") {
    law.limit = limit_family == families[1] ? StandardDistribution::smallest_extreme_value
                                            : StandardDistribution::normal;
  } else if (limit_family) {
    table->fail("limit_family", "needs fatigue_limit = \"random\"");
  }
  read_curve(*table, limit == "random", law);
  if (const auto likelihood = root.table("likelihood")) {
    const auto family = likelihood->choice("family", {"log10-normal", "weibull", "normal"});
    if (family == "weibull") law.family = LifeFamily::weibull;
    if (family == "normal") law.family = LifeFamily::normal;
    if (law.limit && law.family == LifeFamily::normal) {
      likelihood->fail(
          "family",
          "normal on life does not combine with a random fatigue limit; use log10-normal");
    }
    if (!law.straight() && law.family == LifeFamily::normal) {
      likelihood->fail("family",
                       "normal on life needs a straight curve with constant scatter; use "
                       "log10-normal or weibull");
    }
  }
  const auto conditions = root.table("conditions");
  const std::string strength(strength_name(law.correction));
  if (conditions && !strength.empty()) {
    if (const auto known = conditions->quantity(strength, "Pa")) {
      if (!(known->si() > 0)) conditions->fail(strength, "must be positive");
      law.strength = known->si();
    }
  }
  if (conditions && law.correction == MeanStress::walker) {
    if (const auto known = conditions->quantity("gamma", "1")) law.gamma = known->si();
  }
  return law;
}

namespace {

// A failure contributes a density, any other test a probability.
DensityUnit density_of(const SnData& data) {
  DensityUnit unit{data.life_unit.text, {}, 0};
  for (const LifeTest& test : data.tests) {
    const bool exact = test.outcome == fatigue::Outcome::failure;
    unit.terms.push_back(exact ? std::log(data.life_unit.scale) : 0);
    unit.total += test.count * unit.terms.back();
  }
  return unit;
}

}  // namespace

void read_sn_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const SnLaw law = read_sn_law(root);
  const SnData data = read_sn_data(root, source, law.correction);
  if (law.curve == SnCurve::strain_life && data.stress_si != "1") {
    root.required_table("law").fail(
        "curve", fmt::format("\"strain-life\" needs strains, but data.columns.alternating_stress "
                             "is in {}; use a unit of strain: %, um/m or 1",
                             data.stress_unit.text));
  }
  if (data.stress_si != "Pa" && law.strength) {
    root.required_table("conditions")
        .fail(std::string(strength_name(law.correction)),
              fmt::format("is a stress, but the stress quantity of the tests is in {}; use "
                          "law.mean_stress = \"none\", \"swt\" or \"walker\"",
                          data.stress_unit.text));
  }
  if (study.stages) {
    root.required_table("update").fail(
        "stages",
        "is not possible for model \"sn\": tests have no order; fit the first tests as a separate "
        "study (data.sql = \"select ... limit 6\")");
  }
  study.parameters = sn_parameters(root, law, data);
  study.equation = description(law);
  study.data_rows = data.tests.size();
  study.quantity = "life";
  for (const LifeTest& test : data.tests) {
    const double seen[] = {static_cast<double>(test.outcome), test.life, test.until,
                           static_cast<double>(test.count)};
    study.observed.insert(study.observed.end(), std::begin(seen), std::end(seen));
  }
  study.density = density_of(data);
  study.meanings = sn_meanings(law);
  study.likelihood = [=, tests = data.tests](std::size_t rows) {
    return fatigue::sn_likelihood(law, tests, rows);
  };
  study.fit_data = sn_fit_data(law, data, study.parameters);
  study.data_notes = notes(law, data);
  study.data_columns = data.columns;
  study.data_layout = data.layout;
  SnPredictions predictions;
  if (const auto predict = root.table("predict")) {
    predictions = read_sn_predictions(*predict, law, data);
  }
  add_sn_quantities(law, data, predictions, study);
  if (law.curve == SnCurve::strain_life) {
    study.quantity_groups.push_back(cyclic_curve(root));
  } else if (law.curve != SnCurve::knee && law.curve != SnCurve::bastenaire)
    study.curve = [=](const WeightedDraws& draws) {
      const double log10_a = draws.weights.dot(draws.values.col(0)),
                   b = draws.weights.dot(draws.values.col(1));
      return fmt::format(
          "the mean curve is {} = {:.4g}{} × N^({:.4g})", law.bends() ? "S_f - limit" : "S_f",
          from_si(data.stress_unit, std::pow(10, log10_a)), after_number(data.stress_unit), b);
    };
  study.coverage = [=](const WeightedDraws& draws) { return sn_coverage(law, data, draws); };
  study.addition = [=](const Fit& fit) { return sn_addition(law, data, fit); };
  study.figures = [=](const Fit& fit) { return sn_figures(law, data, predictions, fit); };
  study.checks = [=](const Fit& fit) { return sn_checks(law, data, predictions, fit); };
}

}  // namespace wearwell
