#include "wearwell/prob/response.h"

#include <boost/math/special_functions/beta.hpp>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/math/root.h"
#include "wearwell/prob/gamma_tail.h"
#include "wearwell/prob/standard_law.h"
#include "wearwell/prob/standard_values.h"

// Longer than others: the families side by side, each with every censoring.
namespace wearwell {
namespace {

using std::exp;
using std::log;
using std::log1p;
using std::sqrt;
using Slopes = Dual<most_response_slots>;

template <class T>
T nothing() {
  return T(-infinity);
}

// What a family with a place on the line of a standard law makes of y.
template <class T>
struct Standardized {
  StandardLaw law;
  T z;
  T log_rate;  // log dz/dy
};

enum class Side { inside, below, above };  // of the support

template <bool rated, class T>
Standardized<T> of_log(StandardLaw law, double log_y, const T& log_center, const T& scale) {
  Standardized<T> at{law, (log_y - log_center) / scale, T(0)};
  if constexpr (rated) at.log_rate = -log(scale) - log_y;
  return at;
}

bool is_standardized(ResponseFamily family) {
  switch (family) {
    case ResponseFamily::student_t:
    case ResponseFamily::gamma:
    case ResponseFamily::inverse_gaussian:
    case ResponseFamily::poisson:
    case ResponseFamily::binomial:
      return false;
    default:
      return true;
  }
}

bool on_whole_line(ResponseFamily family) {
  return family == ResponseFamily::normal || family == ResponseFamily::student_t ||
         family == ResponseFamily::smallest_extreme_value ||
         family == ResponseFamily::largest_extreme_value;
}

// y inside the support. Probabilities need no rate.
template <bool rated, class T>
Standardized<T> standardize(ResponseFamily family, double y, const T* s) {
  const auto linear = [&](StandardLaw law) {
    Standardized<T> at{law, (y - s[0]) / s[1], T(0)};
    if constexpr (rated) at.log_rate = -log(s[1]);
    return at;
  };
  switch (family) {
    case ResponseFamily::lognormal:
      return of_log<rated>(StandardLaw::normal, std::log(y), T(log(s[0])), s[1]);
    case ResponseFamily::lognormal_by_moments: {
      const T ratio = s[1] / s[0];
      const T variance = log1p(ratio * ratio);
      return of_log<rated>(StandardLaw::normal, std::log(y), T(log(s[0]) - 0.5 * variance),
                           T(sqrt(variance)));
    }
    case ResponseFamily::log10_normal:
      return of_log<rated>(StandardLaw::normal, std::log(y), T(log(s[0])), T(ln10 * s[1]));
    case ResponseFamily::weibull: {
      const T beyond = y - s[2], log_beyond = log(beyond);
      Standardized<T> at{StandardLaw::smallest_extreme_value, (log_beyond - log(s[0])) * s[1],
                         T(0)};
      if constexpr (rated) at.log_rate = log(s[1]) - log_beyond;
      return at;
    }
    case ResponseFamily::exponential:
      return of_log<rated>(StandardLaw::smallest_extreme_value, std::log(y), T(log(s[0])), T(1.0));
    case ResponseFamily::loglogistic: {
      const double log_y = std::log(y);
      Standardized<T> at{StandardLaw::logistic, (log_y - log(s[0])) * s[1], T(0)};
      if constexpr (rated) at.log_rate = log(s[1]) - log_y;
      return at;
    }
    case ResponseFamily::smallest_extreme_value:
      return linear(StandardLaw::smallest_extreme_value);
    case ResponseFamily::largest_extreme_value:
      return linear(StandardLaw::largest_extreme_value);
    default:
      return linear(StandardLaw::normal);
  }
}

double survival_of(const Standardized<double>& at) {
  return log_survival_value(at.law, at.z);
}
template <int N>
Dual<N> survival_of(const Standardized<Dual<N>>& at) {
  return log_survival(at.law, at.z);
}

double probability_of(const Standardized<double>& at) {
  return log_cdf_value(at.law, at.z);
}
template <int N>
Dual<N> probability_of(const Standardized<Dual<N>>& at) {
  return log_cdf(at.law, at.z);
}

// log(1 + x) and so on of a logarithm: log(e^a - e^b) for a > b.
template <class T>
T log_difference(const T& a, const T& b) {
  return a + detail::log_rest(T(b - a));
}

// ---- Student's t by degrees of freedom, location, scale.

// log P(T > t), t >= 0, by the series of the incomplete beta function, where its value is no number.
double student_far_out(double df, double t) {
  const double x = df / (df + t * t), a = 0.5 * df;
  double term = 1, sum = 1;
  for (int n = 0; n < 100'000 && term > 1e-17 * sum; ++n) {
    term *= x * (a + 0.5 + n) / (a + 1 + n);
    sum += term;
  }
  return std::log(0.5) + a * std::log(x) + 0.5 * std::log1p(-x) + std::log(sum) - std::log(a) -
         (boost::math::lgamma(a, Quiet()) + boost::math::lgamma(0.5, Quiet()) -
          boost::math::lgamma(a + 0.5, Quiet()));
}

double student_log_survival(double df, double t) {
  if (t < 0) {
    const double mirrored = student_log_survival(df, -t);
    return std::log1p(-std::exp(mirrored));
  }
  const double x = df / (df + t * t);
  const double p = t * t < df ? 0.5 - 0.5 * boost::math::ibeta(0.5, 0.5 * df, 1 - x, Quiet())
                              : 0.5 * boost::math::ibeta(0.5 * df, 0.5, x, Quiet());
  return p > 1e-280 ? std::log(p) : student_far_out(df, t);
}

template <class T>
T student_log_kernel(const T& df, const T& t) {  // log density of t
  const T half = 0.5 * df;
  return log_gamma(T(half + 0.5)) - log_gamma(half) - 0.5 * log(M_PI * df) -
         (half + 0.5) * log1p(t * t / df);
}

double student_tail(double df, double t) {
  return student_log_survival(df, t);
}
template <int N>
Dual<N> student_tail(const Dual<N>& df, const Dual<N>& t) {
  const double value = student_log_survival(df.a, t.a);
  // By the degrees of freedom there is no closed form: a central difference, good to 1e-8.
  const double step = 1e-4 * df.a;
  const double by_df =
      df.v.isZero()
          ? 0
          : (student_log_survival(df.a + step, t.a) - student_log_survival(df.a - step, t.a)) /
                (2 * step);
  const double by_t = -std::exp(student_log_kernel(df.a, t.a) - value);
  return Dual<N>(value, by_df * df.v + by_t * t.v);
}

// ---- Inverse Gaussian by mean and shape: Chhikara and Folks (1989), ch. 2.

template <class T>
T inverse_gaussian_log_density(double y, const T& mean, const T& shape) {
  const T off = (y - mean) / mean;
  return 0.5 * (log(shape) - std::log(2 * M_PI) - 3 * std::log(y)) - shape * off * off / (2 * y);
}
template <class T>
T inverse_gaussian_log_cdf(double y, const T& mean, const T& shape) {
  const T root = sqrt(shape / y), a = root * (y / mean - 1.0), b = root * (y / mean + 1.0);
  const T first = log_cdf(StandardLaw::normal, a),
          second = 2.0 * shape / mean + log_cdf(StandardLaw::normal, T(-b));
  return scalar(first) > scalar(second) ? T(first + log1p(exp(second - first)))
                                        : T(second + log1p(exp(first - second)));
}
template <class T>
T inverse_gaussian_log_survival(double y, const T& mean, const T& shape) {
  const T root = sqrt(shape / y), a = root * (y / mean - 1.0), b = root * (y / mean + 1.0);
  return log_difference(log_survival(StandardLaw::normal, a),
                        T(2.0 * shape / mean + log_cdf(StandardLaw::normal, T(-b))));
}

// ---- Any family.

template <class T>
bool allowed(ResponseFamily family, const T* s) {
  const auto positive = [&](int i) { return scalar(s[i]) > 0 && std::isfinite(scalar(s[i])); };
  const auto finite = [&](int i) { return std::isfinite(scalar(s[i])); };
  switch (family) {
    case ResponseFamily::normal:
    case ResponseFamily::smallest_extreme_value:
    case ResponseFamily::largest_extreme_value:
      return finite(0) && positive(1);
    case ResponseFamily::student_t:
      return positive(0) && finite(1) && positive(2);
    case ResponseFamily::weibull:
      return positive(0) && positive(1) && finite(2);
    case ResponseFamily::exponential:
      return positive(0);
    case ResponseFamily::poisson:
      return scalar(s[0]) >= 0 && finite(0);
    case ResponseFamily::binomial:
      return scalar(s[0]) >= 0 && scalar(s[0]) <= 1;
    default:
      return positive(0) && positive(1);
  }
}

template <class T>
double threshold(ResponseFamily family, const T* s) {
  if (on_whole_line(family)) return -infinity;
  return family == ResponseFamily::weibull ? scalar(s[2]) : 0;
}

template <class T>
T log_density_of(ResponseFamily family, double y, const T* s, double trials) {
  if (family == ResponseFamily::poisson) {
    if (scalar(s[0]) == 0) return y == 0 ? T(-s[0]) : nothing<T>();
    return y * log(s[0]) - s[0] - boost::math::lgamma(y + 1, Quiet());
  }
  if (family == ResponseFamily::binomial) {
    const double ways = boost::math::lgamma(trials + 1, Quiet()) -
                        boost::math::lgamma(y + 1, Quiet()) -
                        boost::math::lgamma(trials - y + 1, Quiet());
    const double p = scalar(s[0]);
    if ((p == 0 && y > 0) || (p == 1 && y < trials)) return nothing<T>();
    T sum(ways);
    if (y > 0) sum = sum + y * log(s[0]);
    if (y < trials) sum = sum + (trials - y) * log1p(-s[0]);
    return sum;
  }
  if (!(y > threshold(family, s))) return nothing<T>();
  if (is_standardized(family)) {
    const Standardized<T> at = standardize<true>(family, y, s);
    return log_density(at.law, at.z) + at.log_rate;
  }
  switch (family) {
    case ResponseFamily::student_t:
      return student_log_kernel(s[0], T((y - s[1]) / s[2])) - log(s[2]);
    case ResponseFamily::gamma:
      return detail::log_gamma_kernel(s[0], T(y / s[1])) - std::log(y);
    default:
      return inverse_gaussian_log_density(y, s[0], s[1]);
  }
}

template <class T>
T log_survival_of(ResponseFamily family, double y, const T* s) {
  if (!(y > threshold(family, s))) return T(0);
  if (y == infinity) return nothing<T>();
  if (is_standardized(family)) return survival_of(standardize<false>(family, y, s));
  switch (family) {
    case ResponseFamily::student_t:
      return student_tail(s[0], T((y - s[1]) / s[2]));
    case ResponseFamily::gamma:
      return log_gamma_upper(s[0], T(y / s[1]));
    default:
      return inverse_gaussian_log_survival(y, s[0], s[1]);
  }
}

template <class T>
T log_cdf_of(ResponseFamily family, double y, const T* s) {
  if (!(y > threshold(family, s))) return nothing<T>();
  if (y == infinity) return T(0);
  if (is_standardized(family)) return probability_of(standardize<false>(family, y, s));
  switch (family) {
    case ResponseFamily::student_t:
      return student_tail(s[0], T(-(y - s[1]) / s[2]));
    case ResponseFamily::gamma:
      return log_gamma_lower(s[0], T(y / s[1]));
    default:
      return inverse_gaussian_log_cdf(y, s[0], s[1]);
  }
}

// Of a narrow interval by Gauss-Legendre, where a difference would cancel.
template <class T>
T log_narrow(ResponseFamily family, double a, double b, const T* s) {
  static const GaussLegendre rule = gauss_legendre(12);
  const double half = 0.5 * (b - a);
  const T highest = log_density_of(family, a + half, s, 0);
  T sum(0);
  for (std::size_t i = 0; i < rule.node.size(); ++i) {
    const double y = a + half + half * rule.node[i];
    sum = sum + rule.weight[i] * exp(log_density_of(family, y, s, 0) - highest);
  }
  return highest + log(half * sum);
}

template <class T>
T log_between_of(ResponseFamily family, double a, double b, const T* s) {
  if (!(a > threshold(family, s))) return log_cdf_of(family, b, s);
  if (b == infinity) return log_survival_of(family, a, s);
  if (is_standardized(family)) {
    constexpr double thin = 0.01;
    const Standardized<T> low = standardize<false>(family, a, s),
                          high = standardize<false>(family, b, s);
    if (scalar(high.z) - scalar(low.z) < thin) return log_narrow(family, a, b, s);
    return log_between(low.law, low.z, high.z);
  }
  constexpr double narrow = 0.1;
  const T below_b = log_cdf_of(family, b, s), below_a = log_cdf_of(family, a, s);
  const bool low = scalar(below_b) < std::log(0.5);
  const T large = low ? below_b : log_survival_of(family, a, s);
  const T small = low ? below_a : log_survival_of(family, b, s);
  if (scalar(large) - scalar(small) < narrow) return log_narrow(family, a, b, s);
  return log_difference(large, small);
}

template <class T>
T log_response_of(ResponseFamily family, const Response& y, const T* s) {
  if (!allowed(family, s)) return nothing<T>();
  T term(0);
  switch (y.seen) {
    case Seen::exactly:
      term = log_density_of(family, y.at, s, y.trials);
      break;
    case Seen::above:
      term = log_survival_of(family, y.at, s);
      break;
    case Seen::below:
      term = log_cdf_of(family, y.at, s);
      break;
    case Seen::between:
      term = log_between_of(family, y.at, y.until, s);
  }
  if (y.entry > -infinity) term = term - log_survival_of(family, y.entry, s);
  return std::isnan(scalar(term)) ? nothing<T>() : term;
}

double counted_cdf(ResponseFamily family, double y, const double* s, double trials) {
  double sum = 0;
  const double last = family == ResponseFamily::binomial ? std::min(y, trials) : y;
  for (double k = 0; k <= last; ++k) {
    const double term = std::exp(log_density_of(family, k, s, trials));
    sum += term;
    if (k > s[0] && family == ResponseFamily::poisson && term < 1e-17 * sum) break;
  }
  return std::min(sum, 1.0);
}

bool counted(ResponseFamily family) {
  return family == ResponseFamily::poisson || family == ResponseFamily::binomial;
}

}  // namespace

std::span<const ResponseForm> response_forms() {
  using enum ResponseFamily;
  constexpr SlotKind place = SlotKind::place, size = SlotKind::size, number = SlotKind::number;
  static const std::vector<ResponseForm> forms = {
      {"normal", normal, {{"mean", place}, {"sd", size}}},
      {"lognormal", lognormal, {{"median", size}, {"log_sd", number}}, true},
      {"lognormal", lognormal_by_moments, {{"mean", size}, {"sd", size}}, true},
      {"log10-normal", log10_normal, {{"median", size}, {"log10_sd", number}}, true},
      {"student-t", student_t, {{"df", number}, {"location", place}, {"scale", size}}},
      {"weibull", weibull, {{"scale", size}, {"shape", number}, {"threshold", place, true}}, true},
      {"smallest-extreme-value", smallest_extreme_value, {{"location", place}, {"scale", size}}},
      {"largest-extreme-value", largest_extreme_value, {{"location", place}, {"scale", size}}},
      {"exponential", exponential, {{"mean", size}}, true},
      {"gamma", gamma, {{"shape", number}, {"scale", size}}, true},
      {"loglogistic", loglogistic, {{"scale", size}, {"shape", number}}, true},
      {"inverse-gaussian", inverse_gaussian, {{"mean", size}, {"shape", size}}, true},
      {"poisson", poisson, {{"mean", size}}, false, true},
      {"binomial", binomial, {{"probability", SlotKind::probability}}, false, true},
  };
  return forms;
}

ResponseTerm log_response(ResponseFamily family, const Response& response, const double* slots) {
  Slopes seeded[most_response_slots];
  for (int i = 0; i < most_response_slots; ++i) seeded[i] = Slopes(slots[i], i);
  const Slopes y = log_response_of(family, response, static_cast<const Slopes*>(seeded));
  ResponseTerm term{y.a, {}};
  for (int i = 0; i < most_response_slots; ++i) term.slope[i] = y.v[i];
  return term;
}

double log_response_value(ResponseFamily family, const Response& response, const double* slots) {
  return log_response_of(family, response, slots);
}

double log_cdf(ResponseFamily family, double y, const double* slots, double trials) {
  if (!allowed(family, slots)) return std::nan("");
  return counted(family) ? std::log(counted_cdf(family, y, slots, trials))
                         : log_cdf_of(family, y, slots);
}

double log_survival(ResponseFamily family, double y, const double* slots, double trials) {
  if (!allowed(family, slots)) return std::nan("");
  return counted(family) ? std::log1p(-counted_cdf(family, y, slots, trials))
                         : log_survival_of(family, y, slots);
}

namespace {

// The same share is asked for at very many points of a posterior.
double normal_quantile(double p) {
  static thread_local double last = 0.5, z = 0;
  if (p != last) {
    z = quantile(StandardLaw::normal, p);
    last = p;
  }
  return z;
}

}  // namespace

double quantile(ResponseFamily family, double p, const double* s) {
  if (!allowed(family, s)) return std::nan("");
  const auto normal = [&](double scale) { return scale * normal_quantile(p); };
  switch (family) {
    case ResponseFamily::normal:
      return s[0] + normal(s[1]);
    case ResponseFamily::smallest_extreme_value:
      return s[0] + s[1] * quantile(StandardLaw::smallest_extreme_value, p);
    case ResponseFamily::largest_extreme_value:
      return s[0] + s[1] * quantile(StandardLaw::largest_extreme_value, p);
    case ResponseFamily::lognormal:
      return s[0] * std::exp(normal(s[1]));
    case ResponseFamily::log10_normal:
      return s[0] * std::exp(normal(ln10 * s[1]));
    case ResponseFamily::lognormal_by_moments: {
      const double variance = std::log1p(s[1] / s[0] * (s[1] / s[0]));
      return s[0] * std::exp(normal(std::sqrt(variance)) - 0.5 * variance);
    }
    case ResponseFamily::weibull:
      return s[2] + s[0] * std::pow(-std::log1p(-p), 1 / s[1]);
    case ResponseFamily::exponential:
      return -s[0] * std::log1p(-p);
    case ResponseFamily::loglogistic:
      return s[0] * std::exp((std::log(p) - std::log1p(-p)) / s[1]);
    default:
      break;
  }
  const double middle = center(family, s);
  if (family == ResponseFamily::student_t) {
    return solve_increasing([&](double y) { return std::exp(log_cdf_of(family, y, s)) - p; },
                            middle, s[2], {.relative = 1e-12});
  }
  const double log_y =
      solve_increasing([&](double x) { return std::exp(log_cdf_of(family, std::exp(x), s)) - p; },
                       std::log(middle), 0.5, {.absolute = 1e-12}, -700, 700);
  return std::exp(log_y);
}

double center(ResponseFamily family, const double* s) {
  switch (family) {
    case ResponseFamily::lognormal:
      return s[0] * std::exp(0.5 * s[1] * s[1]);
    case ResponseFamily::log10_normal:
      return s[0] * std::exp(0.5 * ln10 * ln10 * s[1] * s[1]);
    case ResponseFamily::student_t:
      return s[1];
    case ResponseFamily::weibull:
      return s[2] + s[0] * std::tgamma(1 + 1 / s[1]);
    case ResponseFamily::smallest_extreme_value:
      return s[0] - s[1] * 0.57721566490153286;
    case ResponseFamily::largest_extreme_value:
      return s[0] + s[1] * 0.57721566490153286;
    case ResponseFamily::gamma:
      return s[0] * s[1];
    default:
      return s[0];  // of the loglogistic law the median
  }
}

}  // namespace wearwell
