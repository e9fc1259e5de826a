#include "wearwell/models/fatigue/sn_predictions.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/math/root.h"
#include "wearwell/models/fatigue/mean_life.h"
#include "wearwell/models/fatigue/reversed_at.h"
#include "wearwell/study/life_levels.h"

// Longer than others: lives, survival, stress allowed and coverage share the reduced draws and their groups.
namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::MixedLife;
using fatigue::Outcome;
using fatigue::ReversedAt;
using fatigue::SnLaw;
using fatigue::Stress;
using fatigue::StressLine;

// The number of slices of the population of fatigue limits per point of the posterior.
constexpr std::size_t slices_of_next = 25;

const Unit& percent() {
  static const Unit unit{"%", 0.01, 0};
  return unit;
}

std::string description(const Quantity& quantity) {
  return fmt::format("{:.6g}{}", quantity.value, after_number(quantity.unit));
}

// The tests whose lives are predicted: all, or an even selection if nearly each has its own stress.
std::vector<std::size_t> covered_tests(std::size_t tests, std::size_t stresses) {
  constexpr std::size_t most_stresses = 500;
  const std::size_t count = stresses > most_stresses ? most_stresses : tests;
  std::vector<std::size_t> covered;
  for (std::size_t i = 0; i < count; ++i) {
    covered.push_back(count == tests ? i : i * (tests - 1) / (count - 1));
  }
  return covered;
}

bool same(const Stress& a, const Stress& b) {
  return a.alternating == b.alternating && a.mean == b.mean;
}

std::vector<StressPoint> points_of_types(const TomlReader& predict, const SnLaw& law,
                                         const SnData& data) {
  const std::vector<std::string> wanted = predict.texts("types");
  const std::vector<StressPoint> tested = tested_points(law, data);
  if (wanted == std::vector<std::string>{"all"}) return tested;
  std::vector<StressPoint> points;
  for (const std::string& type : wanted) {
    const std::size_t before = points.size();
    const std::string name = "type " + type;
    for (const StressPoint& point : tested) {
      if (point.name == name || point.name.starts_with(name + " at ")) points.push_back(point);
    }
    if (points.size() == before) {
      std::vector<std::string> known = {"all"};
      for (const std::string& label : data.labels) {
        if (!label.empty() && std::find(known.begin(), known.end(), label) == known.end()) {
          known.push_back(label);
        }
      }
      predict.fail("types",
                   fmt::format("'{}' is not a type in the data; use one of {} (nearest: '{}')",
                               type, fmt::join(known, ", "), nearest_name(type, known)));
    }
  }
  return points;
}

using Reduction = std::function<void(const double* x, double* y)>;

// A posterior in terms of `count` quantities derived from its parameters.
WeightedDraws reduced(const WeightedDraws& draws, Eigen::Index count, const Reduction& reduction) {
  const auto reduce = [&](const Points& points) {
    Points values(points.rows(), count);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      reduction(points.row(i).data(), values.row(i).data());
    }
    return values;
  };
  const Eigen::Index n = draws.has_cells() ? draws.cells.mass.size() : draws.values.rows();
  WeightedDraws result{reduce(draws.values.topRows(n)), draws.weights.head(n), {}, {}, draws.cells};
  for (const Points& ends : draws.lower) result.lower.push_back(reduce(ends));
  for (const Points& ends : draws.upper) result.upper.push_back(reduce(ends));
  return result;
}

// Lives under one stress, over a posterior.
class LivesAt {
 public:
  LivesAt(const SnLaw& law, const WeightedDraws& draws, const Stress& stress)
      : law_(law), stress_(stress), next_(next_life(law, draws, stress)) {
    next_.merge();
    if (law.limit) {
      draws_ = draws;
      return;
    }
    // Only the center of a point's lives and their scatter matter here.
    ReversedAt reversed(law, stress);
    draws_ = reduced(draws, 2, [&](const double* x, double* y) {
      y[0] = life_center(law, x, reversed(x));
      y[1] = law.sigma_at(x, y[0]);
    });
  }

  const MixedLife& next() const { return next_; }

  // On the scale on which lives scatter.
  QuantityDistribution quantile(double share) const {
    if (law_.limit) {
      return {draws_, [&](const double* x) { return life_quantile(law_, x, stress_, share); }};
    }
    const double z = wearwell::quantile(law_.standard(), share);
    return {draws_, [z](const double* x) { return x[0] + z * x[1]; }};
  }

  // Without a random limit, where it is infinite.
  QuantityDistribution mean() const {
    return {draws_, [family = law_.family](const double* x) {
              return fatigue::mean_life(family, x[0], x[1]);
            }};
  }

  // The mean over the posterior.
  double share_of_mean_beyond(double life) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < draws_.values.rows(); ++i)
      sum += draws_.cell_weight(i) * fatigue::share_of_mean_beyond(law_.family, draws_.values(i, 0),
                                                                   draws_.values(i, 1), life);
    return sum;
  }

  QuantityDistribution survival(double life) const {
    if (law_.limit) {
      return {draws_, [&](const double* x) { return fatigue::survival(law_, x, stress_, life); }};
    }
    const double at = law_.logarithmic() ? std::log10(life) : life;
    const StandardDistribution standard = law_.standard();
    return {draws_, [=](const double* x) { return 1 - cdf(standard, (at - x[0]) / x[1]); }};
  }

 private:
  const SnLaw& law_;
  Stress stress_;
  MixedLife next_;
  WeightedDraws draws_;
};

// The predictive life; then for all items, B-lives and survival.
std::vector<QuantityQuantiles> at_point(const SnLaw& law, const WeightedDraws& draws,
                                        const Stress& stress, const SnPredictions& predictions) {
  const LivesAt lives(law, draws, stress);
  const MixedLife& next = lives.next();
  std::map<double, double> known;
  const auto of_next = [&](double p) {
    const auto [at, fresh] = known.try_emplace(p);
    if (fresh) at->second = next.quantile(p);
    return at->second;
  };
  std::vector<QuantityQuantiles> all = {
      {of_next(0.05), of_next(0.5), of_next(0.95), of_next(0.01), of_next(0.1), of_next(0.5)}};
  for (const double percent_failed : predictions.percents) {
    const QuantityDistribution at = lives.quantile(percent_failed / 100);
    struct Cycles {
      const SnLaw& law;
      const QuantityDistribution& of;
      double quantile(double p) const { return cycles(law, of.quantile(p)); }
    };
    all.push_back(b_life(Cycles{law, at}, of_next(percent_failed / 100), predictions.levels));
  }
  if (predictions.mean) {
    // Without a predictive value: over the posterior a mean of means need not exist.
    const QuantityDistribution mean = lives.mean();
    all.push_back({mean.quantile(0.05), mean.quantile(0.5), mean.quantile(0.95), 0, 0, 0});
    add_bounds(mean, predictions.levels, all.back());
  }
  for (const Quantity& to : predictions.survival_to) {
    const QuantityDistribution share = lives.survival(to.si());
    all.push_back(b_life(share, 1 - next.cdf(to.si()), predictions.levels));
  }
  return all;
}

QuantityDistribution allowed_distribution(const SnLaw& law, const WeightedDraws& draws,
                                          const AllowedStress& allowed) {
  const WeightedDraws stresses = reduced(draws, 1, [&](const double* x, double* y) {
    y[0] =
        alternating_allowed(law, x, allowed.line,
                            log10_reversed_allowed(law, x, allowed.life.si(), allowed.reliability));
  });
  return {stresses, [](const double* x) { return x[0]; }};
}

QuantityQuantiles allowed_quantiles(const SnLaw& law, const WeightedDraws& draws,
                                    const AllowedStress& allowed, const LifeLevels& levels) {
  const QuantityDistribution stress = allowed_distribution(law, draws, allowed);
  return b_life(stress,
                next_allowed(law, draws, allowed.line, allowed.life.si(), allowed.reliability),
                levels);
}

std::string description(const SnLaw& law, const SnData& data, const StressLine& line) {
  if (line.ratio) return fmt::format(", R = {:.6g}", *line.ratio);
  if (law.correction == MeanStress::none) return "";
  if (line.mean == 0) return ", fully reversed";
  return fmt::format(", mean {:.6g}{}", from_si(data.stress_unit, line.mean),
                     after_number(data.stress_unit));
}

double ratio_of(const Stress& stress) {
  return (stress.mean - stress.alternating) / (stress.mean + stress.alternating);
}

struct Span {
  double low = INFINITY, high = -INFINITY;

  void take(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
  bool holds(double x) const {
    const double slack = 1e-9 * std::max(std::abs(low), std::abs(high));
    return low - slack <= x && x <= high + slack;
  }
  std::string in(const Unit& unit) const {
    return fmt::format("{:.6g} to {:.6g} {}", from_si(unit, low), from_si(unit, high), unit.text);
  }
};

// The range of the tests.
struct Tested {
  Span alternating, mean, ratio, life;
  long count = 0;

  explicit Tested(const SnData& data) {
    for (const LifeTest& test : data.tests) {
      alternating.take(test.stress.alternating);
      mean.take(test.stress.mean);
      ratio.take(ratio_of(test.stress));
      life.take(test.life);
      if (test.outcome == Outcome::interval) life.take(test.until);
      count += test.count;
    }
  }
};

Check extrapolation(const SnLaw& law, const SnData& data, const SnPredictions& predictions,
                    const Fit& fit) {
  const Tested tested(data);
  Findings findings("extrapolation");
  const std::string advice =
      "There are no tests there: the result rests on the model. Test there, or stay in the tested "
      "range.";
  for (const StressPoint& point : predictions.points) {
    if (!tested.alternating.holds(point.stress.alternating)) {
      findings.add(Verdict::warn,
                   fmt::format("the alternating stress of {}, {:.6g} {}, lies outside those tested "
                               "({})",
                               point.name, from_si(data.stress_unit, point.stress.alternating),
                               data.stress_unit.text, tested.alternating.in(data.stress_unit)),
                   advice);
    }
    if (law.correction != MeanStress::none && !tested.mean.holds(point.stress.mean)) {
      findings.add(Verdict::warn,
                   fmt::format("the mean stress of {}, {:.6g} {}, lies outside those tested ({})",
                               point.name, from_si(data.stress_unit, point.stress.mean),
                               data.stress_unit.text, tested.mean.in(data.stress_unit)),
                   advice);
    }
    if (law.correction == MeanStress::none && data.has_mean_stress &&
        !tested.ratio.holds(ratio_of(point.stress))) {
      findings.add(
          Verdict::warn,
          fmt::format(
              "the stress ratio of {}, {:.4g}, lies outside those tested ({:.4g} to {:.4g}), and "
              "mean_stress = \"none\" does not correct for it",
              point.name, ratio_of(point.stress), tested.ratio.low, tested.ratio.high),
          "Give law.mean_stress a correction, such as \"goodman\", or test at this ratio.");
    }
  }
  for (const AllowedStress& allowed : predictions.allowed) {
    const double stress = allowed_distribution(law, fit.pooled, allowed).quantile(0.5);
    const std::string where =
        fmt::format("{} at {:.6g} %", description(allowed.life), 100 * allowed.reliability);
    if (!tested.alternating.holds(stress)) {
      findings.add(Verdict::warn,
                   fmt::format("the allowed alternating stress for {}, in the median {:.4g} {}, "
                               "lies outside those tested ({})",
                               where, from_si(data.stress_unit, stress), data.stress_unit.text,
                               tested.alternating.in(data.stress_unit)),
                   advice);
    }
    const double mean = allowed.line.at(stress).mean;
    if (law.correction != MeanStress::none && !tested.mean.holds(mean)) {
      findings.add(Verdict::warn,
                   fmt::format("the mean stress of the allowed stress for {}, {:.4g} {}, lies "
                               "outside those tested ({})",
                               where, from_si(data.stress_unit, mean), data.stress_unit.text,
                               tested.mean.in(data.stress_unit)),
                   advice);
    }
    if (allowed.life.si() > tested.life.high) {
      findings.add(Verdict::warn,
                   fmt::format("no test lasted {} (they lasted {})", description(allowed.life),
                               tested.life.in(data.life_unit)),
                   advice);
    }
  }
  return findings.result("every requested stress and life lies in the tested range");
}

// The lowest of n tests lies with equal probability above and below the life by which a share 1 -
// 2^(-1/n) has failed; below it only the assumed distribution counts. The same rule, at a chosen
// confidence, gives the numbers of tests of ISO 12107.
Check few_tests(const SnData& data, const SnPredictions& predictions) {
  const auto n = static_cast<double>(Tested(data).count);
  const double lowest = 100 * -std::expm1(-std::log(2.0) / n);
  const std::string supported =
      fmt::format("the lowest of {:.0f} tests is near B{:.2g}", n, lowest);
  std::vector<double> asked = predictions.percents;
  for (const AllowedStress& allowed : predictions.allowed) {
    asked.push_back(100 * (1 - allowed.reliability));
  }
  std::sort(asked.begin(), asked.end());
  asked.erase(std::unique(asked.begin(), asked.end(),
                          [](double a, double b) { return std::abs(a - b) < 1e-9 * b; }),
              asked.end());
  std::vector<std::string> below;
  for (const double percent : asked) {
    if (percent >= lowest) continue;
    below.push_back(fmt::format("B{:.4g} (needs {:.0f} tests)", percent,
                                std::ceil(std::log(0.5) / std::log1p(-percent / 100) - 1e-9)));
  }
  Findings findings("percentile-support");
  if (!below.empty()) {
    findings.add(
        Verdict::warn, fmt::format("{}; requested: {}", supported, fmt::join(below, ", ")),
        "Below the lowest test the result rests on the distribution of scatter, not on data. "
        "Design with the lower bound, not with the posterior predictive, and try another family.");
  }
  return findings.result(fmt::format("{}, and nothing below it is requested", supported));
}

// The longest life that was seen under a stress; of all, where there is no test.
double longest_life(const SnData& data, const Stress& stress) {
  double there = 0;
  for (const LifeTest& test : data.tests) {
    if (!same(test.stress, stress)) continue;
    there = std::max({there, test.life, test.outcome == Outcome::interval ? test.until : 0.0});
  }
  return there > 0 ? there : Tested(data).life.high;
}

std::string percent_text(double share) {
  return share < 0.1 ? fmt::format("{:.2g} %", 100 * share) : fmt::format("{:.0f} %", 100 * share);
}

// How much of a mean life comes from lives that no test has reached.
Check tail_of_means(const SnLaw& law, const SnData& data, const SnPredictions& predictions,
                    const Fit& fit) {
  constexpr double dominating = 0.5;
  Findings findings("mean-life");
  double most = 0;
  for (const StressPoint& point : predictions.points) {
    const double longest = longest_life(data, point.stress);
    const double share = LivesAt(law, fit.pooled, point.stress).share_of_mean_beyond(longest);
    most = std::max(most, share);
    if (share > dominating)
      findings.add(Verdict::warn,
                   fmt::format("{} of the mean life of {} comes from lives beyond {:.4g} {}, "
                               "the longest that was seen",
                               percent_text(share), point.name, from_si(data.life_unit, longest),
                               data.life_unit.text),
                   "This mean rests on the upper tail of the distribution of scatter, not on data. "
                   "Read the median (B50), or test until more items fail.");
  }
  return findings.result(fmt::format("at most {} of a mean life comes from lives beyond those seen",
                                     percent_text(most)));
}

}  // namespace

std::string description(const SnLaw& law, const SnData& data, const Stress& stress) {
  const auto value = [&](double si) { return from_si(data.stress_unit, si); };
  const std::string alternating =
      fmt::format("{:.5g}{}", value(stress.alternating), after_number(data.stress_unit));
  if (law.correction == MeanStress::none) return alternating;
  if (stress.mean == 0) return alternating + " amplitude, fully reversed";
  const double highest = stress.mean + stress.alternating;
  const std::string mean =
      fmt::format("{:.5g}{}", value(stress.mean), after_number(data.stress_unit));
  // A ratio of pulsating compression is unbounded.
  if (!(std::abs(highest) > 1e-9 * stress.alternating))
    return fmt::format("{} amplitude, mean {}", alternating, mean);
  return fmt::format("{} amplitude, R = {:.3g} (mean {})", alternating,
                     (stress.mean - stress.alternating) / highest, mean);
}

std::vector<StressPoint> tested_points(const SnLaw& law, const SnData& data) {
  std::vector<StressPoint> points;
  std::map<std::string, int> stresses;
  for (std::size_t i = 0; i < data.tests.size(); ++i) {
    const Stress& stress = data.tests[i].stress;
    const std::string name =
        data.labels[i].empty() ? description(law, data, stress) : "type " + data.labels[i];
    const bool known = std::any_of(points.begin(), points.end(), [&](const StressPoint& point) {
      return point.name == name && same(point.stress, stress);
    });
    if (known) continue;
    points.push_back({name, stress});
    ++stresses[name];
  }
  // A type that was tested under several stresses counts as one of each.
  for (StressPoint& point : points) {
    if (stresses[point.name] > 1) {
      point.name += " at " + description(law, data, point.stress);
    }
  }
  return points;
}

MixedLife next_life(const SnLaw& law, const WeightedDraws& draws, const Stress& stress) {
  MixedLife life(law.family);
  ReversedAt reversed(law, stress);
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double* x = draws.values.row(i).data();
    add_life(life, draws.weights[i], law, x, reversed(x),
             {slices_of_next, static_cast<std::size_t>(i)});
  }
  return life;
}

double next_allowed(const SnLaw& law, const WeightedDraws& draws, const StressLine& line,
                    double life, double reliability) {
  const auto excess = [&](double log10_alternating) {
    const Stress stress = line.at(std::pow(10, log10_alternating));
    return next_life(law, draws, stress).cdf(life) - (1 - reliability);
  };
  // Below or above, no specimen is ever tested.
  constexpr double least = 0, most = 13;
  const double root = solve_increasing(excess, 8, 0.25, {.absolute = 1e-8}, least, most);
  return root == least ? 0 : root == most ? INFINITY : std::pow(10, root);
}

fatigue::DamageSum read_part_damage_sum(const TomlReader& predict, const SnLaw& law) {
  const std::string key = "damage_sum";
  const auto text = predict.text(key);
  if (!text) return {};
  if (!law.logarithmic())
    predict.fail(key,
                 "is not possible with lives that are normal in cycles: damage cannot be summed; "
                 "fit likelihood.family = \"log10-normal\" or \"weibull\"");
  try {
    return fatigue::read_damage_sum(key, *text);
  } catch (const InputError& error) {
    predict.fail(key, std::string(error.what()).substr(key.size() + 2));
  }
}

SnPredictions read_sn_predictions(const TomlReader& predict, const SnLaw& law, const SnData& data) {
  SnPredictions result;
  read_part_damage_sum(predict, law);
  if (predict.has("types")) result.points = points_of_types(predict, law, data);
  if (const auto stresses = predict.table("stress")) {
    for (const std::string& name : stresses->keys()) {
      const TomlReader table = stresses->required_table(name);
      const Stress stress = read_stress(table, law.correction, data.spring, data.stress_si);
      for (const char* key : {"mean_stress", "stress_ratio"}) {
        if (table.has(key) && !data.has_mean_stress)
          table.fail(
              key,
              fmt::format("has no effect: the study does not have the {} of its tests; add it to "
                          "[data.columns] or [conditions], or remove this key",
                          key));
      }
      result.points.push_back({name, stress});
    }
  }
  result.levels = read_life_levels(predict);
  result.percents = predict.has("b_lives") ? result.levels.percents : std::vector<double>();
  const auto share = [&](const char* key, const Quantity& quantity) {
    if (!(quantity.si() > 0 && quantity.si() < 1)) {
      predict.fail(key, "must lie between 0 and 1 (or 0 % and 100 %)");
    }
    return quantity.si();
  };
  result.mean = predict.boolean("mean_life").value_or(false);
  if (result.mean && law.limit)
    predict.fail(
        "mean_life",
        "does not exist with law.fatigue_limit: items whose own limit is not reached never "
        "fail, so that the mean life is infinite; read B-lives, or survival_to");
  result.survival_to = read_lives(predict, "survival_to");
  if (result.points.empty()) {
    for (const char* key : {"b_lives", "mean_life", "survival_to"}) {
      if (predict.has(key)) {
        predict.fail(key, "needs stresses: predict.types = \"all\", or [predict.stress]");
      }
    }
  } else if (result.percents.empty()) {
    result.percents = {1, 10};
  }

  const std::vector<Quantity> required = read_lives(predict, "required_life");
  const std::vector<Quantity> reliabilities = predict.quantities("reliability", "1");
  if (required.empty() != reliabilities.empty()) {
    predict.fail(required.empty() ? "reliability" : "required_life",
                 "needs the other key: required_life and reliability together give the allowable "
                 "alternating stress");
  }
  if (required.empty()) return result;
  StressLine line;
  if (law.correction != MeanStress::none) line = read_line(predict, data.stress_si);
  for (const Quantity& life : required) {
    for (const Quantity& reliability : reliabilities) {
      result.allowed.push_back({life, share("reliability", reliability), line});
    }
  }
  return result;
}

namespace {

// The life by which a share has failed, on the scale on which lives scatter: it determines log10_a.
// With a random limit it would be an integral.
ProfiledQuantity life_by_likelihood(const SnLaw& law, const Stress& stress, double share) {
  const double z = quantile(law.standard(), share);
  return {0,
          [=](const double* x) {
            return life_center(law, x, law.log10_reversed(x, stress)) + z * x[law.sigma_index()];
          },
          [=](const double* x, double life) {
            const double center = life - z * x[law.sigma_index()];
            const double log10_life = law.logarithmic() ? center : std::log10(center);
            return law.log10_reversed(x, stress) - x[1] * log10_life;
          }};
}

}  // namespace

void add_sn_quantities(const SnLaw& law, const SnData& data, const SnPredictions& predictions,
                       PosteriorStudy& study) {
  // Of several percentages the one nearest to 10 %, of several reliabilities the highest.
  const auto nearest = std::min_element(
      predictions.percents.begin(), predictions.percents.end(),
      [](double a, double b) { return std::abs(std::log(a / 10)) < std::abs(std::log(b / 10)); });
  double most_reliable = 0;
  for (const AllowedStress& allowed : predictions.allowed)
    most_reliable = std::max(most_reliable, allowed.reliability);
  const auto request = [&](const std::string& name, const std::string& of, const std::string& at,
                           const Unit& unit) {
    QuantityRequest result{name, of, at, unit, true, false, {}, {}, {}};
    ask_bounds(predictions.levels, result);
    result.safe_end = 0.05;  // the shorter life, the smaller share and stress
    return result;
  };
  for (const StressPoint& point : predictions.points) {
    const std::string words = description(law, data, point.stress);
    const std::string of = point.name == words ? "specimen" : point.name;
    const std::string at = of.ends_with(words) ? "" : "at " + words;
    QuantityGroup group;
    // An unseen item is a new one, as for bearings.
    group.requests.push_back(request("life", "new " + of, at, data.life_unit));
    group.requests.back().is_life = true;
    group.requests.back().credible_level.reset();
    for (const double percent_failed : predictions.percents) {
      group.requests.push_back(
          request(fmt::format("B{:.6g} life", percent_failed), of, at, data.life_unit));
      group.requests.back().headline = percent_failed == *nearest;
      if (!law.straight()) continue;
      study.profiled.push_back({group.requests.back().name, of, at, data.life_unit,
                                life_by_likelihood(law, point.stress, percent_failed / 100),
                                [=](double life) { return cycles(law, life); }});
    }
    if (predictions.mean) group.requests.push_back(request("mean life", of, at, data.life_unit));
    for (const Quantity& to : predictions.survival_to) {
      group.requests.push_back(request("survival to " + description(to), of, at, percent()));
    }
    group.from_draws = [=, stress = point.stress](const WeightedDraws& draws) {
      return at_point(law, draws, stress, predictions);
    };
    group.lives = [=, stress = point.stress](const WeightedDraws& draws) {
      auto next = std::make_shared<MixedLife>(next_life(law, draws, stress));
      next->merge();
      return std::vector<PredictiveLife>{{{[next](double life) { return next->cdf(life); },
                                           [next](double p) { return next->quantile(p); }}}};
    };
    study.quantity_groups.push_back(std::move(group));
  }
  for (const AllowedStress& allowed : predictions.allowed) {
    QuantityRequest stress =
        request("allowed alternating stress", "specimen",
                fmt::format("for {:.6g} % to outlast {}{}", 100 * allowed.reliability,
                            description(allowed.life), description(law, data, allowed.line)),
                data.stress_unit);
    stress.headline = allowed.reliability == most_reliable;
    study.quantity_groups.push_back({{stress}, [=](const WeightedDraws& draws) {
                                       return std::vector<QuantityQuantiles>{allowed_quantiles(
                                           law, draws, allowed, predictions.levels)};
                                     }});
  }
}

CoverageTable sn_coverage(const SnLaw& law, const SnData& data, const WeightedDraws& draws) {
  static constexpr const char* outcomes[] = {"failure", "runout", "left", "interval"};
  // Tests of one stress have one prediction.
  using Key = std::pair<double, double>;
  const auto key = [&](std::size_t test) {
    return Key{data.tests[test].stress.alternating, data.tests[test].stress.mean};
  };
  std::set<Key> stresses;
  for (std::size_t i = 0; i < data.tests.size(); ++i) stresses.insert(key(i));
  const std::vector<std::size_t> tests = covered_tests(data.tests.size(), stresses.size());

  struct Predicted {
    std::optional<MixedLife> life;
    double q05 = 0, q95 = 0, b10 = 0;
  };
  std::map<Key, Predicted> predicted;
  for (const std::size_t i : tests) predicted[key(i)];
  std::vector<std::pair<const Key, Predicted>*> each;
  for (auto& entry : predicted) each.push_back(&entry);
  const auto in_unit = [&](double value) { return from_si(data.life_unit, value); };
  tbb::parallel_for(std::size_t{0}, each.size(), [&](std::size_t i) {
    auto& [stress, p] = *each[i];
    p.life = next_life(law, draws, {stress.first, stress.second});
    p.life->merge();
    p.q05 = in_unit(p.life->quantile(0.05));
    p.q95 = in_unit(p.life->quantile(0.95));
    p.b10 = in_unit(p.life->quantile(0.1));
  });

  CoverageTable table{data.life_unit.text, {}, data.tests.size()};
  for (const std::size_t i : tests) {
    const LifeTest& test = data.tests[i];
    const Predicted& p = predicted.at(key(i));
    table.rows.push_back({i + 1,
                          data.labels[i],
                          outcomes[static_cast<int>(test.outcome)],
                          in_unit(test.life),
                          {},
                          p.life->cdf(test.life),
                          p.q05,
                          p.q95,
                          p.b10});
    if (test.outcome == Outcome::interval) table.rows.back().until = in_unit(test.until);
  }
  return table;
}

std::vector<Check> sn_checks(const SnLaw& law, const SnData& data, const SnPredictions& predictions,
                             const Fit& fit) {
  if (predictions.points.empty() && predictions.allowed.empty()) return {};
  std::vector<Check> checks = {extrapolation(law, data, predictions, fit)};
  if (!predictions.percents.empty() || !predictions.allowed.empty()) {
    checks.push_back(few_tests(data, predictions));
  }
  if (predictions.mean && !predictions.points.empty())
    checks.push_back(tail_of_means(law, data, predictions, fit));
  return checks;
}

}  // namespace wearwell
