#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "wearwell/prob/response_block.h"

namespace wearwell {

/// The distribution of a life in a population of several subpopulations, of which a share may never fail and a
/// share may be dead on arrival:
///
///     P(T > t) = (1 - d) (1 - p F(t)),  F(t) = sum over subpopulations of share times F_k(t),  t >= 0,
///
/// with p the share of the working parts that can fail at all (limited failure population: Meeker 1987, Technometrics 29,
/// 51-65; Meeker and Escobar 1998, sec. 11.5) and d the share dead on arrival, an atom at life 0. One subpopulation without
/// p and d is the plain family.
///
/// Parameters stand in one row of `parameters()` numbers, SI: those of subpopulation k from k `most_response_parameters` on,
/// then, where it is not plain, the shares of the subpopulations (that of `rest` is not read: it has what the others leave),
/// then p and d, then those of the rate of use.
///
/// With a rate of use the life is an age: lives F_k are in use, and each unit is used at its own rate (use_rate.h).
struct LifeMixture {
  static constexpr std::size_t most = 4;  ///< subpopulations
  static constexpr std::size_t most_parameters =
      most * (most_response_parameters + 1) + 2 + most_response_parameters;

  std::vector<ResponseFamily>
      families;          ///< of the subpopulations, at least one; all of positive values
  std::size_t rest = 0;  ///< the subpopulation whose share is what the others leave
  bool limited = false;  ///< p is a parameter; else 1
  bool dead = false;     ///< d is a parameter; else 0
  std::optional<ResponseFamily> rate = {};  ///< of use; set if the life is an age

  bool plain() const { return families.size() == 1 && !limited && !dead && !rate; }
  std::size_t parameters() const {
    return plain() ? most_response_parameters : of_rate() + (rate ? most_response_parameters : 0);
  }
  std::size_t share(std::size_t k) const { return families.size() * most_response_parameters + k; }
  std::size_t share_defective() const { return share(families.size()); }
  std::size_t share_dead() const { return share_defective() + 1; }
  std::size_t of_rate() const { return share_dead() + 1; }

  /// Whether all shares are probabilities; always of a plain one.
  bool allowed(const double* parameters) const;
  double share_of(std::size_t k, const double* parameters) const;
  /// The share that fails at all, d + (1 - d) p, and the share dead at life 0.
  double failing(const double* parameters) const;
  double dead_share(const double* parameters) const { return dead ? parameters[share_dead()] : 0; }

  /// Log density or log probability of one observation, given that it lies above `entry` > 0; an exact life of 0 is a part
  /// dead on arrival. A left-censored life may have been 0, an interval from 0 excludes it. `slope` has `parameters()`
  /// entries, or none.
  double log_response(const Response& response, const double* parameters,
                      std::span<double> slope = {}) const;
  double log_cdf(double life, const double* parameters) const;  ///< log P(T <= life), life >= 0
  double log_survival(double life, const double* parameters) const;
  double log_density(double life, const double* parameters) const;  ///< life > 0
  /// The life by which a share has failed: 0 up to the share dead on arrival, infinite from the share that fails at all on.
  double quantile(double share, const double* parameters) const;
  /// The median of the parts that can fail and are not dead on arrival.
  double middle(const double* parameters) const;
  /// With a rate of use: the share that fails before both an age and a use (use_rate.h).
  double failing_within(double age, double use, const double* parameters) const;
  /// The share of subpopulation k among those that have survived to a life.
  double share_among_survivors(std::size_t k, double life, const double* parameters) const;
};

/// `log_responses` (response_block.h) of a mixture: `parameters()` family parameters and slopes a row.
void log_responses(const LifeMixture& mixture, const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope);

}  // namespace wearwell
