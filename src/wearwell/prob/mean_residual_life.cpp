#include "wearwell/prob/mean_residual_life.h"

#include <cmath>
#include <limits>
#include <type_traits>

#include "wearwell/prob/families.h"

namespace wearwell {
namespace {

using namespace families;

constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

template <class F, class... Among>
constexpr bool is_one_of = (std::is_same_v<F, Among> || ...);

template <class F>
constexpr bool is_life = F::positive && !F::counted && !F::prior_only;

// The mean of a family, infinite where it does not exist (`mean` is then the median).
template <class F>
std::optional<double> mean_from_start(const double* s) {
  if constexpr (is_one_of<F, Loglogistic>) {
    const double angle = M_PI / s[1];
    return s[1] > 1 ? s[0] * angle / std::sin(angle) : infinity;
  } else if constexpr (is_one_of<F, Frechet>) {
    return s[1] > 1 ? F::mean(s) : infinity;
  } else if constexpr (is_one_of<F, GeneralizedGamma>) {
    return s[2] < 0 && !(-s[2] * s[1] < 1) ? infinity : F::mean(s);
  } else {
    return F::mean(s);
  }
}

// None where it loses its digits, far in the tail.
std::optional<double> difference(double all, double from) {
  return all - from > 1e-5 * from ? std::optional(all - from) : std::nullopt;
}

// E[T; T > from]/P(T > from) of a lognormal life is its mean times this, at z = (ln from - mu)/sd.
double lognormal_growth(double z, double log_sd) {
  return std::exp(log_survival_value(StandardDistribution::normal, z - log_sd) -
                  log_survival_value(StandardDistribution::normal, z));
}

// Q(a, x) e^x Gamma(a)/x^a, x >= a + 1: tends to 1/x, and has no large terms.
double upper_fraction(double a, double x) {
  return std::exp(log_gamma_upper(a, x, 0.0));
}

// Weibull: eta/beta e^H times the upper incomplete gamma function of 1/beta at H = (from/eta)^beta.
double weibull_beyond(double from, double eta, double beta) {
  const double a = 1 / beta, hazard = std::pow(from / eta, beta);
  if (!(hazard > 0)) return eta * std::tgamma(1 + a) - from;
  if (!std::isfinite(hazard)) return undefined;
  if (hazard < a + 1)
    return eta * std::tgamma(1 + a) * std::exp(log_gamma_upper(a, hazard) + hazard);
  return a * from * upper_fraction(a, hazard);
}

// Gamma of this shape k: Q(k + 1, x) = Q(k, x) + x^k e^-x/Gamma(k + 1).
double gamma_beyond(double from, double shape, double theta) {
  const double x = from / theta;
  if (x >= shape + 1) return theta * (shape - x + 1 / upper_fraction(shape, x));
  const double growth =
      std::exp(shape * std::log(x) - x - std::lgamma(shape + 1) - log_gamma_upper(shape, x));
  return theta * (shape * (1 + growth) - x);
}

// With w = kappa exp(lambda omega), of a gamma distribution of shape kappa: life is proportional to
// w^(sigma/lambda), so that E[T; T > from] is the mean times a tail of the shape kappa + sigma/lambda.
std::optional<double> generalized_gamma_beyond(double from, const double* s) {
  constexpr double least = 0.1;  // of |lambda|
  const double sigma = s[1], lambda = s[2];
  if (std::abs(lambda) < least) return {};
  const double mean = *mean_from_start<GeneralizedGamma>(s);
  if (mean == infinity) return infinity;
  const double kappa = 1 / (lambda * lambda), grown = kappa + sigma / lambda;
  const double w = kappa * std::pow(from / s[0], lambda / sigma);
  if (!(w > 0) || !std::isfinite(w)) return {};
  const auto log_tail = [&](double shape) {
    return lambda > 0 ? log_gamma_upper(shape, w) : log_gamma_lower(shape, w);
  };
  return difference(mean * std::exp(log_tail(grown) - log_tail(kappa)), from);
}

template <class F>
std::optional<double> mean_from(double from, const double* s) {
  if constexpr (is_one_of<F, Weibull>) {
    return weibull_beyond(from, s[0], s[1]);
  } else if constexpr (is_one_of<F, Exponential>) {
    return s[0];
  } else if constexpr (is_one_of<F, Gamma>) {
    return gamma_beyond(from, s[0], s[1]);
  } else if constexpr (is_one_of<F, Lognormal, Log10Normal, LognormalOfMoments>) {
    const auto c = F::prepared(s);
    return difference(F::mean(s) * lognormal_growth((std::log(from) - c[0]) / c[1], c[1]), from);
  } else if constexpr (is_one_of<F, GeneralizedGamma>) {
    return generalized_gamma_beyond(from, s);
  } else {
    return {};
  }
}

// A life with a threshold below 0 may end at once; its mean is left to the integral.
template <class F>
std::optional<double> residual(double from, const double* s) {
  if (!allowed<F>(s)) return undefined;
  const double start = lower_end<F>(s);
  if (start < 0) return {};
  if (from > start) return mean_from<Base<F>>(from - start, s);
  const auto mean = mean_from_start<Base<F>>(s);
  return mean ? std::optional(start - std::max(from, 0.0) + *mean) : std::nullopt;
}

using Residual = std::optional<double> (*)(double from, const double* s);

constexpr FamilyTable<Residual> residuals = [] {
  FamilyTable<Residual> all{};
  for_each_family([&all]<class F>(std::size_t i) {
    if constexpr (is_life<Base<F>>) all[i] = residual<F>;
  });
  return all;
}();

}  // namespace

std::optional<double> mean_residual_life(ResponseFamily family, double from,
                                         const double* family_parameters) {
  const Residual of = residuals[static_cast<std::size_t>(family)];
  return of ? of(from, family_parameters) : std::nullopt;
}

}  // namespace wearwell
