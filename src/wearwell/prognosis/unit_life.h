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
  std::string name = {};                    ///< "life", or "remaining life"
  std::optional<double> from = {};          ///< along the axis
  std::optional<double> passed = {};        ///< the probability that the end lies before that
  /// Rising: the life by which so many have ended; the last may be infinite.
  std::vector<double> share = {}, life = {};
  double risk = 0.01, inspect_within = 0;
  std::optional<double> horizon = {}, reached = {};  ///< the probability of the end within it

  double quantile(double p) const;  ///< between the shares a straight line in probits of log life
  double cdf(double life_until) const;
};

/// Reads a study of the same data and law with other wishes.
using ReadAsked = std::function<std::unique_ptr<const Study>(const Source& source)>;

/// Of a posterior of this study. Throws InputError where the study has no life, or not of such a unit.
UnitLife unit_life(const Source& source, const ReadAsked& read, const WeightedDraws& posterior,
                   const LifeQuestion& question);

}  // namespace wearwell::prognosis
