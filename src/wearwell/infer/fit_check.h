#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

/// Tests whether the model can have produced the data. Residuals are scores (PIT on the normal
/// scale, bayes/normal_score.h): if prior and model are correct, the scores under one posterior
/// draw are exactly independent standard normal for any number of observations (Johnson 2007,
/// Bayesian Analysis 2, 719-734: the draw and the data have the joint distribution of the truth and
/// the data). So tests that are exact for normal samples are exact here. An interval-censored
/// observation has a random score from its interval (randomized PIT). The p values of many draws
/// are combined into one that is valid under any dependence: twice their median (Meinshausen,
/// Meier, Buhlmann 2009, JASA 104, 1671-1681). Tests are combined by Bonferroni's bound. Almost all
/// tests do not depend on the common size of residuals, which a fitted scatter absorbs.
namespace wearwell {

/// A variable on which observations may depend in a way that is missing in the model.
struct Driver {
  std::string name;           ///< "friction work"
  std::vector<double> value;  ///< of each observation
};

/// A monotonicity that the model guarantees: the observed quantity does not decrease while its
/// driver increases.
struct Rise {
  std::string expected;  ///< "worn volume grows with friction work"
  std::vector<double> driver, value;
  std::vector<std::size_t> group;  ///< items with separate levels; empty for one
  bool from_zero = false;          ///< the response is zero at zero driver
};

/// A standardized random effect: the effects of the observed units under a posterior draw are a
/// standard normal sample, like residuals.
struct UnitEffect {
  std::string name;             ///< "rate"
  std::vector<std::string> of;  ///< "laser 1", ...
};

/// A label of observations: a machine, a supplier.
struct Label {
  std::string name;
  std::vector<std::size_t> level;  ///< of each observation
};

/// The measured values, to find copied rows.
struct MeasuredValues {
  std::vector<double> value;  ///< of each observation, in its written unit; NaN if not exact
  std::vector<double> unit;   ///< of each observation: that unit in SI
  /// log density of each observation in SI; empty: taken from leave-one-out.
  std::function<std::vector<double>(const double* x)> log_density = {};
};

/// Advice for the user, as sentences; empty ones are replaced by general advice.
struct Remedies {
  std::string scatter;      ///< for scatter that follows the mean or a driver
  std::string heavy_tails;  ///< for long tails on both sides
  std::string offset;
  bool life = false;  ///< observations are lives: advice on modes, thresholds, truncation
};

/// A study's data for the check of fit.
struct FitData {
  Scores scores;                ///< of the observations, then of `effects`, effect by effect
  std::vector<int> counts;      ///< repetitions of each observation; empty: 1
  std::vector<Driver> drivers;  ///< the first one defines neighbours
  std::optional<Rise> rise;
  std::string noun = "row";
  bool terms = true;                   ///< scores belong to single factors of the likelihood
  bool cheap = true;                   ///< cheap enough for every node of a quadrature
  std::vector<std::size_t> unit = {};  ///< of each observation, if there are units
  std::vector<UnitEffect> effects = {};
  std::vector<Label> labels = {};
  /// The fitted value of each observation, if it depends on more than one driver; else empty.
  std::function<std::vector<double>(const double* x)> fitted = {};
  std::vector<std::size_t> column = {};  ///< of each observation, if several columns are measured
  MeasuredValues measured = {};          ///< empty: no search for copies
  Remedies remedies = {};
  std::vector<std::string> names =
      {};            ///< of the observations, in messages; empty: `noun` and number
  double share = 1;  ///< of the items of each row that `counts` has
};

/// One test, combined over all draws.
struct FitTest {
  std::string name;     ///< "trend with friction work"
  double p = 1;         ///< p value
  std::string finding;  ///< message for a small p
  std::string advice;
  double share = 1;      ///< share of the check's level; p is divided by it
  bool may_fail = true;  ///< else it only warns

  double judged() const { return p < share ? p / share : 1; }
};

/// Observations that repeat another one in all measured values.
struct CopiedRows {
  std::size_t rows = 0, of = 0;
  double expected = 0;  ///< expected by chance, for rounded numbers
  double p = 1;         ///< of this number by chance
};

struct FitOutcome {
  std::vector<FitTest> tests;
  /// The median score of each observation over the draws; empty if the tests are of outcomes.
  std::vector<double> residuals;
  double p = 1;  ///< combined: the smallest p over its share
  /// Of the items of each row with a count that were judged, where rows stand for very many.
  double share = 1;
  std::optional<CopiedRows> copies = {};
};

/// A correct model causes a warning in at most one study of a hundred, and a failure in one of a
/// thousand.
inline constexpr double fit_warns_below = 0.01, fit_fails_below = 0.001;

/// `loo` may lack tail probabilities; the most extreme residual is then tested by its size among
/// the others.
FitOutcome judge_fit(const FitData& data, const WeightedDraws& draws, const Loo& loo);

Check fit_check(const FitOutcome& outcome);

}  // namespace wearwell
