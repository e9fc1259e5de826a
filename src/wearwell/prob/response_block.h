#pragma once

#include <cstddef>
#include <span>

#include "wearwell/prob/response.h"

namespace wearwell {

/// A slot's values over rows: one for each, or one for all.
struct ParameterValues {
  const double* at = nullptr;
  bool uniform = false;

  double operator[](std::size_t i) const { return uniform ? *at : at[i]; }
};

/// Observations that are evaluated together repeatedly.
struct ResponseColumn {
  std::vector<Response> rows;
  /// Whether all are exact without truncation; families with a row formula then use plain numbers.
  bool plain = false;
  std::vector<double> at, log_at;  ///< for plain ones; log_at only for positive ones

  explicit ResponseColumn(std::vector<Response> responses = {});
};

/// `log_response` of rows begin .. begin + value.size() - 1 under the slots of these rows; with
/// `slope` its derivatives, `slope[s * value.size() + i]` of slot s. `family_parameters` has at least those of
/// the family; further entries are ignored.
void log_responses(ResponseFamily family, const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope);

}  // namespace wearwell
