#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/infer/check.h"
#include "wearwell/infer/fit.h"
#include "wearwell/infer/loo.h"

/// Could the law have made these data? Residuals of observations are judged as scores (PIT on the
/// normal scale, bayes/normal_score.h): when prior and law are right, those under one draw of the
/// posterior are independent standard normal, exactly, whatever the number of observations (Johnson
/// 2007, Bayesian Analysis 2, 719-734: the draw and the data have the joint law of the truth and the
/// data). A test that is exact for normal samples is exact for them; an observation known only to
/// lie in an interval has a score drawn from it (randomized PIT). From the p values of many draws
/// one is made that holds its level however they depend: twice their median (Meinshausen, Meier,
/// Buhlmann 2009, JASA 104, 1671-1681). Tests are joined by Bonferroni's bound. Almost all tests do
/// not see the common size of residuals, which a fitted scatter absorbs.
namespace wearwell {

/// What observations may depend on in a way that the law does not know.
struct Driver {
  std::string name;           ///< "friction work"
  std::vector<double> value;  ///< of each observation
};

/// What a law can never do: let the observed fall while its driver grows.
struct Rise {
  std::string expected;  ///< "worn volume grows with friction work"
  std::vector<double> driver, value;
  std::vector<std::size_t> group;  ///< items whose own levels differ; empty for one
  bool from_zero = false;          ///< the law vanishes with its driver
};

/// What differs from unit to unit, in standard normal terms: effects that a draw of the posterior says of
/// the units seen are a sample of the standard normal law, as residuals are.
struct UnitEffect {
  std::string name;             ///< "rate"
  std::vector<std::string> of;  ///< "laser 1", ...
};

/// What tells observations apart by name: a machine, a supplier.
struct Label {
  std::string name;
  std::vector<std::size_t> level;  ///< of each observation
};

/// What was measured, to find rows that are copies.
struct MeasuredValues {
  std::vector<double>
      value;  ///< of each observation, in the unit it was written in; NaN where not exact
  std::vector<double> unit;  ///< of each observation: that unit in SI
  /// log density of each observation in SI; empty: leave-one-out has them as terms.
  std::function<std::vector<double>(const double* x)> log_density = {};
};

/// What a user can try, in sentences; an empty one is replaced by a general one.
struct Remedies {
  std::string scatter;      ///< that follows the mean or a driver
  std::string heavy_tails;  ///< on both sides
  std::string offset;
  bool life = false;  ///< observations are lives: modes, thresholds, truncation
};

/// What a study tells of its observations.
struct FitData {
  Scores scores;  ///< of the observations, then those of `effects`, one effect after the other
  std::vector<int> counts;      ///< so many observations were alike; empty: one each
  std::vector<Driver> drivers;  ///< along the first one neighbours are judged
  std::optional<Rise> rise;
  std::string noun = "row";
  bool terms = true;                   ///< scores are of the factors of the likelihood, one by one
  bool cheap = true;                   ///< may be asked for at every node of a quadrature
  std::vector<std::size_t> unit = {};  ///< of each observation, where units differ
  std::vector<UnitEffect> effects = {};
  std::vector<Label> labels = {};
  /// What the law expects of each observation, where that is more than one driver's; empty where it is not.
  std::function<std::vector<double>(const double* x)> fitted = {};
  std::vector<std::size_t> column =
      {};                        ///< of each observation, where several columns are measured
  MeasuredValues measured = {};  ///< empty: copies are not looked for
  Remedies remedies = {};
};

/// One test, over all draws.
struct FitTest {
  std::string name;     ///< "trend with friction work"
  double p = 1;         ///< of something as far off, when the law is right
  std::string finding;  ///< in words, for when it is small
  std::string advice;
  double share = 1;  ///< of the level of the check: what p is divided by

  double judged() const { return p < share ? p / share : 1; }
};

/// Observations that repeat another one in all that was measured.
struct CopiedRows {
  std::size_t rows = 0, of = 0;
  double expected = 0;  ///< by chance, of rounded numbers
  double p = 1;         ///< of as many by chance
};

struct FitOutcome {
  std::vector<FitTest> tests;
  std::vector<double> residuals;  ///< the median score of each observation over the draws
  double p = 1;                   ///< of all tests together: the smallest p over its share
  std::optional<CopiedRows> copies = {};
};

/// A right law is warned of in one study of a hundred at most, and fails in one of a thousand.
inline constexpr double fit_warns_below = 0.01, fit_fails_below = 0.001;

/// `loo` may have no tails; then the outermost residual is judged by its size among the others.
FitOutcome judge_fit(const FitData& data, const WeightedDraws& draws, const Loo& loo);

Check fit_check(const FitOutcome& outcome);

}  // namespace wearwell
