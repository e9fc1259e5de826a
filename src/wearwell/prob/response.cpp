#include "wearwell/prob/response.h"

#include <algorithm>
#include <cmath>

#include "wearwell/prob/families.h"
#include "wearwell/prob/log_between.h"

namespace wearwell {
namespace {

using namespace families;

template <class F, class T>
T log_density_anywhere(double y, const T* s) {
  return y > lower_end<F>(s) ? T(families::log_density<F>(y, s)) : T(-infinity);
}

template <class F, class T>
T log_survival_anywhere(double y, const T* s) {
  if (!(y > lower_end<F>(s))) return T(0);
  return y == infinity ? T(-infinity) : T(families::log_survival<F>(y, s));
}

template <class F, class T>
T log_cdf_anywhere(double y, const T* s) {
  if (!(y > lower_end<F>(s))) return T(-infinity);
  return y == infinity ? T(0) : T(families::log_cdf<F>(y, s));
}

template <class F, class T>
T log_known(const Response& y, const T* s) {
  if constexpr (Base<F>::counted) {
    return y.seen == Censoring::none ? F::log_density(y.at, s, y.trials) : T(std::nan(""));
  } else {
    switch (y.seen) {
      case Censoring::none:
        return log_density_anywhere<F>(y.at, s);
      case Censoring::right:
        return log_survival_anywhere<F>(y.at, s);
      case Censoring::left:
        return log_cdf_anywhere<F>(y.at, s);
      case Censoring::interval:
        break;
    }
    return families::log_between<F>(y.at, y.until, s);
  }
}

template <class F, class T>
T log_response_of(const Response& y, const T* s) {
  if (!allowed<F>(s)) return T(-infinity);
  T term = log_known<F>(y, s);
  if constexpr (!Base<F>::counted) {
    if (y.entry > -infinity) term = term - log_survival_anywhere<F>(y.entry, s);
  }
  return std::isnan(scalar(term)) ? T(-infinity) : term;
}

// P(Y <= y) for counts.
template <class F>
double counted_cdf(double y, const double* s, double trials) {
  double sum = 0;
  const double last = trials > 0 ? std::min(y, trials) : y;
  for (double k = 0; k <= last; ++k) {
    const double term = std::exp(F::log_density(k, s, trials));
    sum += term;
    if (trials == 0 && k > F::mean(s) && term < 1e-17 * sum) break;
  }
  return std::min(sum, 1.0);
}

// The functions of a family, with uniform signatures.
template <class F>
struct Of {
  static ResponseTerm term(const Response& response, const double* family_parameters) {
    constexpr int n = static_cast<int>(parameter_count<F>());
    Dual<n> seeded[n];
    for (int i = 0; i < n; ++i) seeded[i] = Dual<n>(family_parameters[i], i);
    const Dual<n> y = log_response_of<F>(response, static_cast<const Dual<n>*>(seeded));
    ResponseTerm term{y.a, {}};
    for (int i = 0; i < n; ++i) term.slope[i] = y.v[i];
    return term;
  }
  static double value(const Response& response, const double* family_parameters) {
    return log_response_of<F>(response, family_parameters);
  }
  static double log_cdf(double y, const double* family_parameters, double trials) {
    if (!allowed<F>(family_parameters)) return std::nan("");
    if constexpr (Base<F>::counted) {
      return std::log(counted_cdf<F>(y, family_parameters, trials));
    } else {
      return log_cdf_anywhere<F>(y, family_parameters);
    }
  }
  static double log_survival(double y, const double* family_parameters, double trials) {
    if (!allowed<F>(family_parameters)) return std::nan("");
    if constexpr (Base<F>::counted) {
      return std::log1p(-counted_cdf<F>(y, family_parameters, trials));
    } else {
      return log_survival_anywhere<F>(y, family_parameters);
    }
  }
  static double quantile(double p, const double* family_parameters) {
    if constexpr (Base<F>::counted) {
      return std::nan("");
    } else {
      return allowed<F>(family_parameters) ? families::quantile<F>(p, family_parameters)
                                           : std::nan("");
    }
  }
  static double center(const double* family_parameters) { return mean<F>(family_parameters); }
};

struct Functions {
  ResponseTerm (*term)(const Response&, const double*);
  double (*value)(const Response&, const double*);
  double (*log_cdf)(double, const double*, double);
  double (*log_survival)(double, const double*, double);
  double (*quantile)(double, const double*);
  double (*center)(const double*);
};

constexpr FamilyTable<Functions> table = [] {
  FamilyTable<Functions> all{};
  for_each_family([&all]<class F>(std::size_t i) {
    if constexpr (!Base<F>::prior_only) {
      all[i] = {Of<F>::term,         Of<F>::value,    Of<F>::log_cdf,
                Of<F>::log_survival, Of<F>::quantile, Of<F>::center};
    }
  });
  return all;
}();

const Functions& functions(ResponseFamily family) {
  return table[static_cast<std::size_t>(family)];
}

}  // namespace

ResponseTerm log_response(ResponseFamily family, const Response& response,
                          const double* family_parameters) {
  return functions(family).term(response, family_parameters);
}

double log_response_value(ResponseFamily family, const Response& response,
                          const double* family_parameters) {
  return functions(family).value(response, family_parameters);
}

double log_cdf(ResponseFamily family, double y, const double* family_parameters, double trials) {
  return functions(family).log_cdf(y, family_parameters, trials);
}

double log_survival(ResponseFamily family, double y, const double* family_parameters,
                    double trials) {
  return functions(family).log_survival(y, family_parameters, trials);
}

double quantile(ResponseFamily family, double p, const double* family_parameters) {
  return functions(family).quantile(p, family_parameters);
}

double center(ResponseFamily family, const double* family_parameters) {
  return functions(family).center(family_parameters);
}

}  // namespace wearwell
