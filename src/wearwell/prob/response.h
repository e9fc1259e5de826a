#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace wearwell {

/// The law of one observed number about what a formula says of it.
enum class ResponseFamily {
  normal,
  lognormal,             ///< by median and the standard deviation of its natural logarithm
  lognormal_by_moments,  ///< by its own mean and standard deviation
  log10_normal,
  student_t,
  weibull,
  smallest_extreme_value,
  largest_extreme_value,
  exponential,
  gamma,
  loglogistic,
  inverse_gaussian,
  poisson,
  binomial,
};

/// What a slot of a family holds.
enum class SlotKind {
  place,        ///< a value of what is observed
  size,         ///< a size of the same dimension, positive
  number,       ///< a pure number, positive
  probability,  ///< a pure number, 0 to 1
};

struct SlotForm {
  std::string_view name;
  SlotKind kind;
  bool optional = false;
};

/// A family as a study names it, with its slots in order.
struct ResponseForm {
  std::string_view name;
  ResponseFamily family;
  std::vector<SlotForm> slots;
  bool positive = false;  ///< what is observed is above 0
  bool counted = false;   ///< it is a count; nothing is censored
};

/// All there are; the lognormal family is there twice.
std::span<const ResponseForm> response_forms();

inline constexpr int most_response_slots = 3;

/// How much is known of an observation.
enum class Seen {
  exactly,
  above,    ///< a run-out: larger than `at`
  below,    ///< smaller than `at`
  between,  ///< more than `at`, up to `until`
};

/// One observation, in SI.
struct Response {
  Seen seen = Seen::exactly;
  double at = 0;
  double until = 0;
  /// It would not have been seen below that (left truncation).
  double entry = -std::numeric_limits<double>::infinity();
  double trials = 0;  ///< of the binomial family
};

/// A log density or log probability with its derivatives by the slots.
struct ResponseTerm {
  double value = 0;
  double slope[most_response_slots] = {};
};

/// Of one observation, natural logarithm; -infinity where the slots lie outside their kind or the
/// observation outside the law. All digits stay far in the tails. A slot that is optional and not
/// given is 0.
ResponseTerm log_response(ResponseFamily family, const Response& response, const double* slots);
double log_response_value(ResponseFamily family, const Response& response, const double* slots);

/// log P(Y <= y) and log P(Y > y); of counts P(Y <= y) is that of whole numbers up to y.
double log_cdf(ResponseFamily family, double y, const double* slots, double trials = 0);
double log_survival(ResponseFamily family, double y, const double* slots, double trials = 0);

/// The y with P(Y <= y) = p, 0 < p < 1, of a family that is no count.
double quantile(ResponseFamily family, double p, const double* slots);

/// The mean, where it exists; else the median.
double center(ResponseFamily family, const double* slots);

}  // namespace wearwell
