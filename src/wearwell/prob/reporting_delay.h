#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "wearwell/prob/life_mixture.h"

namespace wearwell {

/// The times that the age at a report has and the life of the part has not: from the sale to the start of use, and from the
/// failure to its report. Their sum D is independent of the life T and discrete, with `share[j] = P(D = time[j])`:
///
///     P(reported by the age t) = sum over j of share[j] P(T <= min(t - time[j], warranty)),  time[j] < t.
///
/// A part that fails beyond the warranty is never reported (Lawless 1994, Can. J. Stat. 22, 15-31; Kalbfleisch, Lawless and
/// Robinson 1991, Technometrics 33, 273-285). SI.
struct ReportingDelay {
  std::vector<double> time;   ///< not negative, ascending
  std::vector<double> share;  ///< positive; they add up to 1
  double warranty = std::numeric_limits<double>::infinity();

  double least() const { return time.front(); }
  double most() const { return time.back(); }
};

/// log P(no report by this age), where `log_survival(life)` is that of the life.
template <class LogSurvival>
double log_unreported(const ReportingDelay& delay, double age, const LogSurvival& log_survival) {
  double sum = 0;
  for (std::size_t j = 0; j < delay.time.size(); ++j) {
    const double life = std::min(age - delay.time[j], delay.warranty);
    sum += delay.share[j] * (life > 0 ? std::exp(log_survival(life)) : 1);
  }
  return std::log(sum);
}

/// log P(report by this age) and log P(no report by it).
double log_reported(const LifeMixture& life, const ReportingDelay& delay, double age,
                    const double* parameters);
double log_unreported(const LifeMixture& life, const ReportingDelay& delay, double age,
                      const double* parameters);

/// Log probability that the age at the report lies as `response` says; -infinity for an exact age. `slope` has
/// `life.parameters()` entries, or none.
double log_response(const LifeMixture& life, const ReportingDelay& delay, const Response& response,
                    const double* parameters, std::span<double> slope = {});

/// The same of rows (response_block.h): `life.parameters()` family parameters and slopes a row.
void log_responses(const LifeMixture& life, const ReportingDelay& delay,
                   const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope);

}  // namespace wearwell
