#pragma once

#include <optional>
#include <span>
#include <vector>

#include "wearwell/prognosis/weighted_lives.h"

namespace wearwell::prognosis {

/// Costs of decisions, all in one currency.
struct Costs {
  /// of a unit that reaches its threshold in service, including its replacement
  double failure = 0;
  double replacement = 0;  ///< of a preventive replacement
  double inspection = 0;   ///< of one inspection
};

/// Lives of units whose population is uncertain: one entry per possible population. Units share the
/// population, so long-run costs are averaged over populations, but lives are not. One entry: the
/// population is known, or each unit comes from another.
struct PopulationLives {
  std::vector<WeightedLives> lives;
  std::vector<double> weight = {1};

  PopulationLives() = default;
  PopulationLives(WeightedLives known) : lives{std::move(known)} {}
  PopulationLives(std::vector<WeightedLives> each, std::vector<double> weights)
      : lives(std::move(each)), weight(std::move(weights)) {}

  double survival(double x) const;  ///< of a new unit
  /// Its life with this probability of failure, 0 < p < 1; infinite if it is never reached.
  double quantile(double p) const;
  WeightedLives mixture() const;  ///< its life, averaged over the populations
};

/// Long-run cost per unit of the axis if each unit is replaced at failure or at this age, whichever
/// comes first: [c_p S(T) + c_f F(T)] / integral of S from 0 to T (Barlow and Proschan,
/// Mathematical Theory of Reliability, 1965, chapter 3; Barlow and Hunter, Operations Research 8
/// (1960) 90), averaged over populations. Infinite `age`: at failure only, which costs nothing if
/// some never fail.
double cost_rate(const PopulationLives& lives, const Costs& costs, double age);

/// The age replacement of least cost.
struct AgeReplacement {
  double age = 0;         ///< infinite: at failure only, which costs at most 0.1 % more
  double rate = 0;        ///< cost per unit of the axis
  double at_failure = 0;  ///< the same, replaced at failure only
  double from = 0,
         to = 0;  ///< the first and last age whose rate is at most 1 % above; `to` may be infinite
  double failing = 0;  ///< the share of units that fail before that age
  /// The minimum is at the end of the computed lives: some never fail within this range, and their
  /// later behaviour is unknown.
  bool beyond_known = false;
  /// Estimated relative errors of the age and of its cost if the populations are few points of the posterior.
  std::optional<double> age_error = {}, rate_error = {};
};
AgeReplacement cheapest_age(const PopulationLives& lives, const Costs& costs);
/// Sets the errors to twice the difference from the same over fewer points (study/numerical_error.h).
void estimate_errors(AgeReplacement& age, const AgeReplacement& coarse);

/// The time of replacement of one running unit.
struct UnitReplacement {
  double after = 0;  ///< from now on; 0: now; infinite: at failure only
  double cost =
      0;  ///< c_p S + c_f F - rate * use until then: compared with a fleet that costs `rate`
  double now = 0;      ///< the same, replaced now: c_p
  double waiting = 0;  ///< the same, replaced at failure only
  double failing = 0;  ///< the probability that it fails before
};

/// The time of least cost, given the fleet's cost per further unit of the axis: a unit continues as
/// long as its own risk costs less, h(t) (c_f - c_p) < rate (Bergman, Journal of Applied
/// Probability 15 (1978) 106). `remaining` is of a unit that has not failed. A moment that
/// saves less than 0.1 % of a replacement against replacement now, or else at failure, is not named.
UnitReplacement cheapest_moment(const WeightedLives& remaining, const Costs& costs, double rate);

/// The time of replacement of a unit of which nothing but its age `now` is known, in each population: at the fleet's age
/// of least cost; if it is older, now or at failure, whichever costs less. Costs are compared, in each population, with
/// a fleet that replaces at this age or at failure, whichever is cheaper there: with the average rate of all, long lives
/// far in the tail of the posterior would decide. `remaining` has the weights of the populations given the survival to
/// `now`; lives of weight 0 may be empty.
UnitReplacement replacement_by_age(const PopulationLives& fresh, const PopulationLives& remaining,
                                   const Costs& costs, double now, double best_age);

/// The same cost at a given time.
double moment_cost(const WeightedLives& remaining, const Costs& costs, double rate, double after);

/// Points of change of the distribution of lives, ascending, thinned to about `most`: candidate
/// ages.
std::vector<double> ages_of(std::span<const WeightedLives> lives, std::size_t most = 400);

}  // namespace wearwell::prognosis
