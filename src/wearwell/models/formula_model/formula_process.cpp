#include "wearwell/models/formula_model/formula_process.h"

#include <algorithm>
#include <cmath>

#include "wearwell/math/boost_policy.h"
#include "wearwell/math/constants.h"

#include "wearwell/models/formula_model/formula_hidden_path.h"

namespace wearwell::formula_model {
namespace {

// The contribution of a row: means, variances, and the information of its reading.
struct Step {
  double mean, variance, noise_variance;
};

Step step_of(const ProcessForm& form, const ProcessRows& rows, std::size_t i) {
  const double before = i > 0 ? rows.mean[i - 1] : 0;
  const double dm = rows.mean[i] - before, s = rows.spread[i];
  const double earlier = i > 0 ? rows.spread[i - 1] : 0;
  const double noise = rows.noise.empty() ? 0 : rows.noise[i];
  return {dm, form.by_sd ? s * s - earlier * earlier : s * dm, noise * noise};
}

// Kalman's recursion: before a row the path is normal; its reading updates it.
struct Filtered {
  double off, predicted, all, at, variance;  // reading less forecast; variances; then the path
};

Filtered filter(const Step& step, double reading, double at, double variance) {
  Filtered f;
  f.off = reading - (at + step.mean);
  f.predicted = variance + step.variance;
  f.all = f.predicted + step.noise_variance;
  const double gain = f.all > 0 ? f.predicted / f.all : 0;
  f.at = at + step.mean + gain * f.off;
  f.variance = f.all > 0 ? f.predicted * step.noise_variance / f.all : 0;
  return f;
}

void fail(std::span<double> value, std::span<double> slope) {
  std::fill(value.begin(), value.end(), 0.0);
  value[0] = -infinity;
  std::fill(slope.begin(), slope.end(), 0.0);
}

// Passes the derivative by the mean of a step, and by its variance, to the distribution parameters.
class Slopes {
 public:
  Slopes(const ProcessForm& form, const ProcessRows& rows, std::span<double> slope)
      : form_(form), rows_(rows), slope_(slope), n_(rows.mean.size()) {
    std::fill(slope.begin(), slope.end(), 0.0);
  }
  void give(std::size_t i, double by_mean, double by_variance, double by_noise_variance) {
    if (form_.by_sd) {
      slope_[n_ + i] += 2 * rows_.spread[i] * by_variance;
      if (i > 0) slope_[n_ + i - 1] -= 2 * rows_.spread[i - 1] * by_variance;
    } else {
      const double dm = rows_.mean[i] - (i > 0 ? rows_.mean[i - 1] : 0);
      slope_[n_ + i] += dm * by_variance;
      by_mean += rows_.spread[i] * by_variance;
    }
    slope_[i] += by_mean;
    if (i > 0) slope_[i - 1] -= by_mean;
    if (!rows_.noise.empty()) slope_[2 * n_ + i] += 2 * rows_.noise[i] * by_noise_variance;
  }

 private:
  const ProcessForm& form_;
  const ProcessRows& rows_;
  std::span<double> slope_;
  std::size_t n_;
};

// An expensive function of successive rows. Steps of a unit are often equal except for the last
// digit: then it extrapolates along the slope, with an error below one digit.
class Logarithm {
 public:
  double operator()(double x) {
    if (x == at_) return value_;
    const double away = (x - at_) / at_;
    if (std::abs(away) < 1e-9) return value_ + away;
    at_ = x;
    return value_ = std::log(x);
  }

 private:
  double at_ = std::nan(""), value_ = 0;
};

class LogGamma {
 public:
  double value(double x) {
    go_to(x);
    return x == at_ ? value_ : value_ + (x - at_) * slope_there();
  }
  double slope(double x) {
    go_to(x);
    return slope_there();  // its relative change is less than theirs
  }

 private:
  void go_to(double x) {
    if (std::abs(x - at_) < 1e-9 * x) return;
    at_ = x;
    value_ = std::lgamma(x);
    digamma_ = std::nan("");
  }
  double slope_there() {
    if (std::isnan(digamma_)) digamma_ = digamma(at_);
    return digamma_;
  }
  double at_ = std::nan(""), value_ = 0, digamma_ = std::nan("");
};

void wiener_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope) {
  const std::size_t n = rows.reading.size();
  static thread_local std::vector<Filtered> all;
  all.clear();
  Logarithm log_of_variance;
  double at = 0, variance = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Step step = step_of(form, rows, i);
    const Filtered f = filter(step, rows.reading[i], at, variance);
    if (!(step.variance >= 0) || !(f.all > 0) || !std::isfinite(f.off)) return fail(value, slope);
    value[i] = -0.5 * (log_two_pi + log_of_variance(f.all) + f.off * f.off / f.all);
    at = f.at;
    variance = f.variance;
    all.push_back(f);
  }
  if (slope.empty()) return;
  Slopes slopes(form, rows, slope);
  double by_at = 0, by_variance = 0;  // of the path after the row
  for (std::size_t i = n; i-- > 0;) {
    const Filtered& f = all[i];
    const double gain = f.predicted / f.all;
    const double by_off = by_at * gain - f.off / f.all;
    const double by_gain = by_at * f.off - by_variance * f.predicted;
    const double by_all = -0.5 / f.all + 0.5 * f.off * f.off / (f.all * f.all) -
                          by_gain * f.predicted / (f.all * f.all);
    by_variance = by_variance * (1 - gain) + by_gain / f.all + by_all;
    by_at -= by_off;
    slopes.give(i, by_at, by_variance, by_all);
  }
}

// Increments observed without error. If the mean is constant, so is the path.
void growing_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                   std::span<double> slope) {
  const bool gamma = form.process == Process::gamma, sloped = !slope.empty();
  const std::size_t n = rows.reading.size();
  if (sloped) std::fill(slope.begin(), slope.end(), 0.0);
  Logarithm log_of_scale, log_of_mean;
  LogGamma log_gamma;
  double mean_before = 0, reading_before = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double dm = rows.mean[i] - mean_before, u = rows.spread[i];
    const double dy = rows.reading[i] - reading_before;
    mean_before = rows.mean[i];
    reading_before = rows.reading[i];
    value[i] = 0;
    if (dm == 0 && dy == 0) continue;
    if (!(dm > 0 && dy > 0 && u > 0 && std::isfinite(dm))) return fail(value, slope);
    const double log_u = log_of_scale(u);
    const double log_dy = rows.log_growth.empty() ? std::log(dy) : rows.log_growth[i];
    double by_mean = 0, by_scale = 0;
    if (gamma) {
      const double a = dm / u, log_share = log_dy - log_u;
      if (!(a >= least_gamma_argument)) return fail(value, slope);
      value[i] = (a - 1) * log_share - dy / u - log_u - log_gamma.value(a);
      if (!sloped) continue;
      const double off = log_share - log_gamma.slope(a);
      by_mean = off / u;
      by_scale = -a / u * off + (dy / u - a) / u;
    } else {
      const double off = dy - dm;
      value[i] =
          log_of_mean(dm) - 0.5 * (log_two_pi + log_u + 3 * log_dy) - off * off / (2 * u * dy);
      if (!sloped) continue;
      by_mean = 1 / dm + off / (u * dy);
      by_scale = -0.5 / u + off * off / (2 * u * u * dy);
    }
    slope[i] += by_mean;
    if (i > 0) slope[i - 1] -= by_mean;
    slope[n + i] += by_scale;
  }
}

}  // namespace

std::span<const ProcessForm> process_forms() {
  constexpr auto location = ParameterKind::location, scale = ParameterKind::scale;
  static const std::vector<ProcessForm> forms = {
      {Process::wiener,
       false,
       {"wiener-process",
        ResponseFamily::normal,
        {{"mean", location}, {"scale", scale}, {"noise", scale, true}}}},
      {Process::wiener,
       true,
       {"wiener-process",
        ResponseFamily::normal,
        {{"mean", location}, {"sd", scale}, {"noise", scale, true}}}},
      {Process::gamma,
       false,
       {"gamma-process",
        ResponseFamily::normal,
        {{"mean", location}, {"scale", scale}, {"noise", scale, true}}}},
      {Process::inverse_gaussian,
       false,
       {"inverse-gaussian-process",
        ResponseFamily::normal,
        {{"mean", location}, {"scale", scale}, {"noise", scale, true}}}},
  };
  return forms;
}

void process_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                   std::span<double> slope) {
  if (rows.reading.empty()) return;
  if (is_hidden(form, rows)) {
    hidden_terms(form, rows, value, slope);
  } else if (form.process == Process::wiener) {
    wiener_terms(form, rows, value, slope);
  } else {
    growing_terms(form, rows, value, slope);
  }
  const auto is_finite = [](double x) { return std::isfinite(x); };
  const bool whole = std::all_of(value.begin(), value.end(), is_finite) &&
                     std::all_of(slope.begin(), slope.end(), is_finite);
  if (!whole) fail(value, slope);
}

Standing standing(const ProcessForm& form, const ProcessRows& rows) {
  if (is_hidden(form, rows)) return hidden_standing(form, rows);
  Standing stands;
  for (std::size_t i = 0; i < rows.reading.size(); ++i) {
    stands.mean = rows.mean[i];
    if (form.process == Process::wiener) {
      const Filtered f =
          filter(step_of(form, rows, i), rows.reading[i], stands.at, stands.variance);
      stands.at = f.at;
      stands.variance = f.variance;
    } else {
      stands.at = rows.reading[i];
    }
  }
  return stands;
}

void process_scores(const ProcessForm& form, const ProcessRows& rows,
                    std::vector<NormalScore>& scores) {
  if (is_hidden(form, rows)) return hidden_scores(form, rows, scores);
  scores.clear();
  double at = 0, variance = 0;
  for (std::size_t i = 0; i < rows.reading.size(); ++i) {
    const Step step = step_of(form, rows, i);
    if (form.process == Process::wiener) {
      const Filtered f = filter(step, rows.reading[i], at, variance);
      at = f.at;
      variance = f.variance;
      const double z = f.off / std::sqrt(f.all);
      scores.push_back({z, z});
      continue;
    }
    const double dy = rows.reading[i] - (i > 0 ? rows.reading[i - 1] : 0), u = rows.spread[i];
    if (!(step.mean > 0)) {  // it is constant, which adds no information
      scores.push_back({-infinity, infinity});
      continue;
    }
    const bool gamma = form.process == Process::gamma;
    const ResponseFamily family = gamma ? ResponseFamily::gamma : ResponseFamily::inverse_gaussian;
    const double family_parameters[most_response_parameters] = {
        gamma ? step.mean / u : step.mean, gamma ? u : step.mean * step.mean / u};
    const double z = normal_score(log_cdf(family, dy, family_parameters),
                                  log_survival(family, dy, family_parameters));
    scores.push_back({z, z});
  }
}

}  // namespace wearwell::formula_model
