#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

/// What is asked of a life.
struct LifeQuestion {
  std::string unit = {};                     ///< "J7"; empty of a new one
  std::optional<std::string> survived = {};  ///< "1e4 cycles": what it has come to
  std::optional<std::string> horizon = {};   ///< "500 h": from then on
  std::optional<double> risk = {};           ///< that is tolerated until the next inspection
};

/// The life of one unit, all that is unknown averaged in. Lives count from `from` on.
struct UnitLife {
  std::string of = {}, at = {}, unit = {};  ///< "machine J7", "to wear = 100 um", "h"
  std::string name = {};                    ///< "life", or "remaining useful life"
  std::optional<double> from = {};          ///< along the axis
  std::optional<double> passed = {};        ///< the probability that the end lies before that
  std::optional<double> never = {};  ///< where that may be: the probability that life has no end
  /// Rising: the life by which so many have ended; the last may be infinite.
  std::vector<double> share = {}, life = {};
  double risk = 0.01, inspect_within = 0;
  std::optional<double> horizon = {}, reached = {};  ///< the probability of the end within it
  std::optional<double> numerical_error = {};  ///< of lives, relative (study/numerical_error.h)

  double quantile(double p) const;  ///< between the shares a straight line in probits of log life
};

/// Percentages at which lives are told, rising, with the risk of the question among them.
std::vector<double> life_percentages(double risk);
/// "1e4 cycles" in the unit in which lives are told. Throws InputError that names the option.
double along_life(const char* option, const std::string& text, const std::string& unit);
/// What follows: the next inspection from the shares, and what the horizon asks from `cdf`, the distribution of the
/// life in its unit, from `from` on. Throws InputError.
void answer(const LifeQuestion& question, UnitLife& life,
            const std::function<double(double until)>& cdf);

/// Reads a study of the same data and law with other wishes.
using ReadAsked = std::function<std::unique_ptr<const Study>(const Source& source)>;

/// Of a posterior of this study. Throws InputError where the study has no life, or not of such a unit.
UnitLife unit_life(const Source& source, const ReadAsked& read, const WeightedDraws& posterior,
                   const LifeQuestion& question);

}  // namespace wearwell::prognosis
