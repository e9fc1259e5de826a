#include "wearwell/study/sense.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/present/plain.h"
#include "wearwell/study/answers.h"

namespace wearwell {
namespace {

std::string with_unit(const std::string& unit) {
  return unit == "1" ? "" : " " + unit;
}

class Sense {
 public:
  // A 90 % interval, and the other reported values of the same quantity.
  void interval(const std::string& what, const std::string& unit, double q05, double q95,
                const std::vector<double>& others, bool may_never_end) {
    bool defined = !std::isnan(q05) && !std::isnan(q95);
    for (const double each : others) defined = defined && !std::isnan(each);
    if (!defined) {
      findings_.add(
          Verdict::fail, fmt::format("{} could not be computed", what),
          "Some parameter values in the posterior give no finite result: bound the prior that "
          "allows them. A remaining useful life has no value if the unit rarely reaches the point "
          "from which it is counted; choose other units or an earlier point.");
      return;
    }
    if (std::isinf(q95) && may_never_end) {
      findings_.add(
          Verdict::warn,
          fmt::format(
              "{} may be infinite: its 90 % interval begins at {:.3g}{} and has no upper end", what,
              q05, with_unit(unit)),
          advice);
      return;
    }
    if (!(q05 > 0) || !std::isfinite(q95)) return;
    const double decades = std::log10(q95 / q05);
    if (decades <= widest_interval) return;
    findings_.add(decades > absurd_interval ? Verdict::fail : Verdict::warn,
                  fmt::format("the 90 % interval of {} spans {:.1f} decades, {:.3g} to {:.3g}{}",
                              what, decades, q05, q95, with_unit(unit)),
                  advice);
  }

  // No quantity of any unit is as large: the posterior has no finite integral, and its mode was
  // searched for up to the largest numbers of the machine.
  void magnitude(const std::string& what, const std::string& unit, double q05, double q95) {
    constexpr double largest = 1e100;
    if (std::abs(q05) < largest && std::abs(q95) < largest) return;
    findings_.add(
        Verdict::fail,
        fmt::format("the 90 % interval of {} is {:.3g} to {:.3g}{}: the posterior may be "
                    "improper",
                    what, q05, q95, with_unit(unit)),
        fmt::format("The data alone do not determine {}: state prior knowledge of it.", what));
  }

  Check result() {
    return findings_.result(
        fmt::format("every result is a number, and no 90 % interval spans more than {:.0f} decades",
                    widest_interval));
  }

 private:
  static constexpr const char* advice =
      "The data contain little information about it. Test more, or closer to the conditions of the "
      "prediction.";
  Findings findings_{"sense"};
};

}  // namespace

Check extrapolation_check(const std::vector<Reach>& reaches) {
  Findings findings("extrapolation");
  double farthest = 0;
  for (const Reach& each : reaches) {
    const double times = each.asked / each.seen;
    farthest = std::max(farthest, times);
    if (times <= farthest_reach) continue;
    findings.add(times > absurd_reach ? Verdict::fail : Verdict::warn,
                 fmt::format("{} is {:.3g} times as far as the data reach: {}", each.what, times,
                             each.seen_as),
                 "No data lie in that range, so the prediction rests on the model. Inspect earlier "
                 "and fit again.");
  }
  return findings.result(
      fmt::format("predictions lie within {:.3g} times the range of the data (up to {:.3g} passes)",
                  farthest, farthest_reach));
}

Check limit_check(const LifeSummary& life) {
  Findings findings("limit");
  const std::string passed = fmt::format(
      "after {} {} the limit is already passed with a probability of {}; {} % is tolerated",
      plain_given(life.now), life.unit, probability_text(life.best().passed), 100 * life.risk);
  if (life.passed_beyond_risk()) {
    findings.add(Verdict::fail, passed,
                 "Do not wait for the next inspection: replace or measure now. The interval to the "
                 "next inspection holds only if the limit is not passed.");
  }
  return findings.result(passed);
}

Check sense_check(const PosteriorSummary& result) {
  Sense sense;
  for (const ParameterSummary& each : result.parameters) {
    const ExactSummary p = each.best();
    // Another check covers means and deviations that do not exist.
    if (std::isnan(p.q05) || std::isnan(p.q95)) {
      sense.interval(each.name, each.unit, p.q05, p.q95, {}, false);
    } else {
      sense.magnitude(each.name, each.unit, p.q05, p.q95);
    }
  }
  for (const PredictionSummary& each : result.predictions) {
    const Prediction& p = each.best();
    sense.interval(
        fmt::format("the {} at {} {}", each.quantity, plain_given(each.at), each.at_word()),
        each.unit, p.ci05, p.ci95, {p.mean, p.pi05, p.pi95}, false);
  }
  for (const QuantitySummary& each : result.quantities) {
    QuantityQuantiles q = each.best();
    if (q.mean && std::isnan(q.q50)) q.q05 = q.q50 = q.q95 = *q.mean;  // one number
    sense.interval(fmt::format("{} of {}{}{}", each.name, item_text(each.of),
                               each.at.empty() ? "" : " ", each.at),
                   each.unit, q.q05, q.q95,
                   {q.q50, q.b1, q.b10, q.b50, q.predictive.value_or(0), q.bound.value_or(0),
                    q.upper_bound.value_or(0)},
                   false);
  }
  if (result.life) {
    const Life& life = result.life->best();
    sense.interval(
        fmt::format("the life to {:.6g} {}", result.life->limit, result.life->limit_unit),
        result.life->unit, life.q05, life.q95,
        {life.b1, life.b10, life.b50, life.inspect_within, life.passed}, true);
  }
  return sense.result();
}

}  // namespace wearwell
