#include "wearwell/models/fatigue/sn_parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/fatigue/sn_guess.h"

namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::SecondSlope;
using fatigue::SnCurve;
using fatigue::SnLaw;

// "log10_Sut": the parameter name of the logarithm of the strength.
std::string log_strength_name(MeanStress correction) {
  const std::string name(strength_name(correction));
  return name == "S_ut" ? "log10_Sut" : name == "S_y" ? "log10_Sy" : "log10_" + name;
}

// Refuses tests whose mean stress exceeds every allowed strength.
void refuse_beyond(const SnData& data, double strength, const std::string& name) {
  for (std::size_t i = 0; i < data.tests.size(); ++i) {
    const double mean = data.tests[i].stress.mean;
    if (mean < strength) continue;
    const std::string column = data.mean_stress_column.empty()
                                   ? ""
                                   : fmt::format(", column '{}'", data.mean_stress_column);
    throw InputError(fmt::format(
        "{}, row {}{}: the mean stress {:.6g} {} is not below {}, which is at most {:.6g} {}",
        data.source, i + 1, column, from_si(data.stress_unit, mean), data.stress_unit.text, name,
        from_si(data.stress_unit, strength), data.stress_unit.text));
  }
}

// Prior knowledge of S-N curves, and the size of the stresses, which are set and not measured
// (docs/reference/priors.md).
class Defaults {
 public:
  explicit Defaults(const SnData& data) : data_(data) {
    for (const LifeTest& test : data.tests) {
      highest_ = std::max(highest_, test.stress.alternating);
      largest_ = std::max(largest_, test.stress.alternating + std::abs(test.stress.mean));
      lowest_ = std::min(lowest_, test.stress.alternating);
      longest_ = std::max({longest_, test.life, test.until});
    }
  }

  // Basquin's b of -0.05 to -0.12 (Basquin 1910, Dowling 2013) raises the highest stress by 2 to 6
  // from 1e5 cycles to 1; welds, of -1/3, by 50.
  DefaultPrior log10_a() const { return logarithm(4 * highest_, 0.7); }
  // Heavy tails: welds have -0.33.
  DefaultPrior b() const { return {"student-t", StudentT{4, -0.12, 0.06}, "1"}; }
  // Slopes from 3 (welds) to 15; the knee near a million cycles (FKM 1e6, Eurocode 5e6); slopes below it
  // from 2k - 1 to 45.
  DefaultPrior k() const { return {"student-t", StudentT{4, 8, 4}, "1", 0}; }
  DefaultPrior k2() const { return {"student-t", StudentT{4, 20, 10}, "1", 0}; }
  DefaultPrior log_knee_life() const { return {"normal", Normal{6.2, 0.5}, "log10(cycles)"}; }
  DefaultPrior log_bend() const { return logarithm(0.5 * lowest_, 0.4); }
  DefaultPrior bend_power() const { return {"normal", Normal{1, 0.5}, "1", 0}; }
  // A factor of 2 of the scatter over two decades of life.
  DefaultPrior growth() const { return {"normal", Normal{0, 0.15}, "1"}; }
  DefaultPrior gamma() const { return {"beta", Beta{4, 3}, "1"}; }
  DefaultPrior sigma(bool logarithmic) const {
    return {"half-normal", HalfNormal{logarithmic ? 0.5 : rounded_up(longest_)},
            logarithmic ? "1" : data_.life_unit.text};
  }
  // Tests run at about half of the strength.
  DefaultPrior log_strength() const { return logarithm(2 * largest_, 0.2); }
  DefaultPrior log_limit() const { return logarithm(lowest_, 0.3); }
  DefaultPrior sigma_limit() const { return {"half-normal", HalfNormal{0.1}, "1"}; }

 private:
  DefaultPrior logarithm(double stress, double sd) const {
    const bool plain = data_.stress_si == "1";
    return {"normal", Normal{std::log10(rounded_up(stress)), sd},
            plain ? "1" : fmt::format("log10({})", data_.stress_unit.text)};
  }

  const SnData& data_;
  double highest_ = 0, largest_ = 0, lowest_ = INFINITY, longest_ = 0;
};

}  // namespace

Parameter read_driver_prior(const TomlReader& root, const std::optional<TomlReader>& priors,
                            const ParameterSpec& spec, const std::string& stress_si,
                            const Unit& stress_unit) {
  try {
    return read_prior(root, priors, spec);
  } catch (const InputError& error) {
    // The stress quantity sets the dimension: if a prior contradicts it, either may be wrong.
    const std::string what = error.what();
    if (stress_si == "Pa" || what.find("wrong dimension") == std::string::npos) throw;
    const std::string message = without_excerpt(what);
    throw InputError(fmt::format("{}, since by data.columns the stress quantity is '{}'{}", message,
                                 stress_unit.text, what.substr(message.size())));
  }
}

std::vector<Parameter> sn_parameters(const TomlReader& root, const SnLaw& law, const SnData& data) {
  const auto priors = root.table("prior");
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    return read_driver_prior(root, priors, spec, data.stress_si, data.stress_unit);
  };
  const Defaults defaults(data);
  const std::string log_stress =
      data.stress_si == "1" ? "1" : fmt::format("log10({})", data.stress_si);
  double largest_mean = 0;
  for (const LifeTest& test : data.tests) largest_mean = std::max(largest_mean, test.stress.mean);
  const std::string strength(strength_name(law.correction));
  double material = std::max(3 * largest_mean, 1e6);
  std::optional<Parameter> log_strength;
  if (law.strength) {
    refuse_beyond(data, *law.strength, strength);
    if (priors && priors->has(log_strength_name(law.correction))) {
      priors->fail(log_strength_name(law.correction),
                   fmt::format("is given, but conditions.{} fixes it; keep one", strength));
    }
    material = *law.strength;
  } else if (law.has_strength()) {
    log_strength = read({log_strength_name(law.correction), log_stress.c_str(), -INFINITY, INFINITY,
                         std::log10(material)},
                        defaults.log_strength());
    refuse_beyond(data, std::pow(10, log_strength->prior.upper), strength);
    const double least = largest_mean > 0 ? std::log10(largest_mean) : -INFINITY;
    if (log_strength->start < least + 0.01) {
      const double upper = std::min(log_strength->prior.upper, least + 1);
      log_strength->start = 0.5 * (least + upper);
    }
    material = std::pow(10, log_strength->start);
  }
  const fatigue::SnGuess guess = fatigue::guess(law, data.tests, material);

  double lowest = INFINITY;
  for (const LifeTest& test : data.tests) {
    lowest = std::min(lowest, std::log10(test.stress.alternating) +
                                  log10_factor(law.correction, test.stress, material, 0.5));
  }
  std::vector<Parameter> parameters;
  const auto add = [&](const char* name, const char* si, double least, double start,
                       const DefaultPrior& prior) {
    parameters.push_back(
        read({name, si, least, name == std::string("b") || name == std::string("c") ? 0 : INFINITY,
              start},
             prior));
  };
  const double at_million = guess.log10_a + 6 * guess.b;  // log10 of the stress
  const double knee = std::max(at_million, lowest + 0.01);
  switch (law.curve) {
    case SnCurve::knee:
      add("k", "1", 0, -1 / guess.b, defaults.k());
      add("log10_N_D", "log10(cycle)", -INFINITY, (knee - guess.log10_a) / guess.b,
          defaults.log_knee_life());
      if (law.limit) break;
      add("log10_S_D", log_stress.c_str(), -INFINITY, knee, defaults.log_limit());
      if (law.second_slope == SecondSlope::free) add("k2", "1", 0, 20, defaults.k2());
      break;
    case SnCurve::bastenaire:
      add("log10_N_B", "log10(cycle)", -INFINITY, 6, defaults.log_knee_life());
      add("log10_B", log_stress.c_str(), -INFINITY, lowest - 0.3, defaults.log_bend());
      add("C", "1", 0, 1, defaults.bend_power());
      add("log10_limit", log_stress.c_str(), -INFINITY, lowest - 0.1, defaults.log_limit());
      break;
    case SnCurve::strain_life:
      add("log10_elastic", "1", -INFINITY, -2.3, {"normal", Normal{-2.3, 0.3}, "1"});
      add("b", "1", -INFINITY, -0.09, {"student-t", StudentT{4, -0.09, 0.02}, "1"});
      add("log10_plastic", "1", -INFINITY, -0.3, {"normal", Normal{-0.3, 0.4}, "1"});
      add("c", "1", -INFINITY, -0.6, {"student-t", StudentT{4, -0.6, 0.08}, "1"});
      break;
    case SnCurve::basquin:
    case SnCurve::stromeyer:
      add("log10_a", log_stress.c_str(), -INFINITY, guess.log10_a, defaults.log10_a());
      add("b", "1", -INFINITY, guess.b, defaults.b());
      if (law.curve == SnCurve::stromeyer)
        add("log10_limit", log_stress.c_str(), -INFINITY, lowest - 0.1, defaults.log_limit());
  }
  if (log_strength) parameters.push_back(*log_strength);
  if (law.has_gamma()) parameters.push_back(read({"gamma", "1", 0, 1, 0.5}, defaults.gamma()));
  const char* sigma_si = law.logarithmic() ? "1" : "cycle";
  parameters.push_back(
      read({"sigma", sigma_si, 0, INFINITY, guess.sigma}, defaults.sigma(law.logarithmic())));
  if (law.scatter_grows) add("sigma_growth", "1", -INFINITY, 0, defaults.growth());
  if (law.limit) {
    if (law.curve == SnCurve::knee) {
      add("log10_S_D", log_stress.c_str(), -INFINITY, knee, defaults.log_limit());
    } else {
      add("log10_limit", log_stress.c_str(), -INFINITY, lowest - 0.05, defaults.log_limit());
    }
    parameters.push_back(read({"sigma_limit", "1", 0, INFINITY, 0.05}, defaults.sigma_limit()));
  }
  if (!law.logarithmic()) {
    Parameter& sigma = parameters[static_cast<std::size_t>(law.sigma_index())];
    sigma.unit = life_unit(sigma.unit);
  }
  return parameters;
}

std::vector<std::string> sn_meanings(const SnLaw& law) {
  std::vector<std::string> words = {"logarithm of the stress at one cycle", "Basquin's exponent"};
  if (law.curve == SnCurve::stromeyer) {
    words = {"logarithm of the stress above the limit at one cycle", "Stromeyer's exponent",
             "logarithm of the fatigue limit"};
  } else if (law.curve == SnCurve::bastenaire) {
    words = {"logarithm of Bastenaire's life", "logarithm of Bastenaire's stress",
             "Bastenaire's exponent", "logarithm of the fatigue limit"};
  } else if (law.curve == SnCurve::strain_life) {
    words = {"logarithm of the elastic line's sigma_f'/E", "its exponent",
             "logarithm of the plastic line's eps_f'", "its exponent"};
  } else if (law.curve == SnCurve::knee) {
    words = {"slope above the knee", "logarithm of the knee's life"};
    if (!law.limit) words.emplace_back("logarithm of the knee's stress");
    if (law.curve_dimension() == 4) words.emplace_back("slope below the knee");
  }
  if (law.has_strength()) {
    words.emplace_back(law.correction == MeanStress::soderberg ? "logarithm of the yield strength"
                       : law.correction == MeanStress::morrow
                           ? "logarithm of the true fracture strength"
                           : "logarithm of the ultimate strength");
  }
  if (law.has_gamma()) words.emplace_back("Walker's exponent");
  words.emplace_back(law.scatter_grows   ? "scatter of log10 life at a million cycles"
                     : law.logarithmic() ? "scatter of log10 life"
                                         : "scatter of life");
  if (law.scatter_grows)
    words.emplace_back("decades by which the scatter grows per decade of life");
  if (law.limit) {
    words.emplace_back("logarithm of the median fatigue limit");
    words.emplace_back("scatter of the logarithm of the fatigue limit");
  }
  if (law.limit == StandardDistribution::smallest_extreme_value) {
    words[words.size() - 2] = "logarithm of the fatigue limit with 63.2 % below it";
  }
  return words;
}

}  // namespace wearwell
