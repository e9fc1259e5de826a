#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

/// The question about a life.
struct LifeQuestion {
  std::string unit = {};                     ///< "J7"; empty for a new unit
  std::optional<std::string> survived = {};  ///< "1e4 cycles": the use it has survived
  std::optional<std::string> horizon = {};   ///< "500 h": from then on
  std::optional<double> risk = {};           ///< risk tolerated until the next inspection
  std::vector<double> shares = {};  ///< further shares that have ended, of bounds of the life
};

/// The life of one unit, averaged over all uncertainty. Lives count from `from`.
struct UnitLife {
  std::string of = {}, at = {}, unit = {};  ///< "machine J7", "to wear = 100 um", "h"
  std::string name = {};                    ///< "life", or "remaining useful life"
  std::optional<double> from = {};          ///< along the axis
  std::optional<double> passed = {};        ///< the probability that the end lies before that
  std::optional<double> never = {};  ///< reason for it: the probability that the unit never fails
  /// Ascending: the life by which this share has ended; the last may be infinite.
  std::vector<double> share = {}, life = {};
  double risk = 0.01, inspect_within = 0;
  std::optional<double> horizon = {}, reached = {};  ///< the probability of the end within it
  std::optional<double> numerical_error = {};  ///< of lives, relative (study/numerical_error.h)

  double quantile(double p) const;  ///< between the shares a straight line in probits of log life
};

/// Percentages at which lives are reported, ascending, including the risk and the shares of the question.
std::vector<double> life_percentages(double risk, const std::vector<double>& shares);
/// "1e4 cycles" in the unit of reported lives. Throws InputError that names the option.
double along_life(const char* option, const std::string& text, const std::string& unit);
/// The rest: the next inspection from the shares, and the probability within the horizon from
/// `cdf`, the distribution of the life in its unit, from `from` on. Throws InputError.
void answer(const LifeQuestion& question, UnitLife& life,
            const std::function<double(double until)>& cdf);

/// Reads a study of the same data and model with another [predict].
using ReadAsked = std::function<std::unique_ptr<const Study>(const Source& source)>;

/// For a posterior of this study. Throws InputError if the study has no life, or none of such a
/// unit.
UnitLife unit_life(const Source& source, const ReadAsked& read, const WeightedDraws& posterior,
                   const LifeQuestion& question);

}  // namespace wearwell::prognosis
