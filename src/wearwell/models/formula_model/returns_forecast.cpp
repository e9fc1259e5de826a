#include "wearwell/models/formula_model/returns_forecast.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/predict/count_quantile.h"
#include "wearwell/predict/thinned_posterior.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t points_of_counts = 1000;
constexpr double lower_share = 0.05, upper_share = 0.95;

}  // namespace

ReturnsForecast::ReturnsForecast(const FieldReturns& returns, std::span<const Risk> risks,
                                 const WeightedDraws& draws, int most_after, bool by_mode)
    : ages_(static_cast<std::size_t>(most_after) + 2) {
  const ThinnedPosterior few(draws, points_of_counts);
  weight_ = few.weights;
  log_survival_.resize(weight_.size() * ages_);
  LifeAtPoint life(risks);
  for (std::size_t i = 0; i < weight_.size(); ++i) {
    life.move_to(few.values.row(static_cast<Eigen::Index>(i)).data());
    for (std::size_t a = 0; a < ages_; ++a) {
      const double age = to_si(returns.period, returns.age(static_cast<int>(a) - 1));
      const auto log_survival = [&](double used) { return life.log_survival(used); };
      log_survival_[i * ages_ + a] = !(age > 0) ? 0
                                     : returns.reporting
                                         ? log_unreported(*returns.reporting, age, log_survival)
                                         : log_survival(age);
    }
  }
  if (by_mode && risks.size() > 1) add_incidence(risks, returns, few.values);
}

// The integral of each mode is known to 1e-7 of it; of a period, the modes share what fails in all, which has a closed form.
void ReturnsForecast::add_incidence(std::span<const Risk> risks, const FieldReturns& returns,
                                    const Points& points) {
  modes_ = risks.size();
  incidence_.resize(weight_.size() * modes_ * ages_);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, weight_.size()), [&](const auto& range) {
    LifeAtPoint life(risks);
    std::vector<double> before(modes_), step(modes_);
    for (std::size_t i = range.begin(); i < range.end(); ++i) {
      life.move_to(points.row(static_cast<Eigen::Index>(i)).data());
      std::fill(before.begin(), before.end(), 0.0);
      double survival = 1;
      for (std::size_t a = 1; a < ages_; ++a) {
        const double age = to_si(returns.period, returns.age(static_cast<int>(a) - 1));
        double all = 0;
        for (std::size_t k = 0; k < modes_; ++k) {
          const double until = age > 0 ? life.incidence(k, age) : 0;
          step[k] = std::max(0.0, until - before[k]);
          all += step[k];
          before[k] = until;
        }
        const double now = std::exp(log_survival_[i * ages_ + a]);
        for (std::size_t k = 0; k < modes_; ++k) {
          double* const sum = &incidence_[(i * modes_ + k) * ages_ + a];
          *sum = sum[-1] + (all > 0 ? step[k] / all * (survival - now) : 0);
        }
        survival = now;
      }
    }
  });
}

ReturnsCount ReturnsForecast::count(std::span<const UnitsAtRisk> groups) const {
  return count_of(groups, [this](std::size_t i, const UnitsAtRisk& each) {
    const double* const log_survival = &log_survival_[i * ages_ + 1];  // by period after the sale
    const double now = log_survival[each.seen], from = log_survival[each.first - 1],
                 to = log_survival[each.last];
    // Where none can have survived until now, none are left.
    return std::isfinite(now) ? std::exp(from - now) * -std::expm1(to - from) : 0;
  });
}

ReturnsCount ReturnsForecast::count(std::span<const UnitsAtRisk> groups, std::size_t risk) const {
  return count_of(groups, [this, risk](std::size_t i, const UnitsAtRisk& each) {
    const double now = (&log_survival_[i * ages_ + 1])[each.seen];
    const double* const until = &incidence_[(i * modes_ + risk) * ages_ + 1];
    return std::isfinite(now) ? (until[each.last] - until[each.first - 1]) * std::exp(-now) : 0;
  });
}

template <class Fails>
ReturnsCount ReturnsForecast::count_of(std::span<const UnitsAtRisk> groups,
                                       const Fails& fails) const {
  std::vector<CountAtPoint> points(weight_.size());
  Points means(static_cast<Eigen::Index>(weight_.size()), 1);
  double square = 0, variance = 0;
  ReturnsCount found;
  for (std::size_t i = 0; i < points.size(); ++i) {
    CountAtPoint& at = points[i];
    at.weight = weight_[i];
    for (const UnitsAtRisk& each : groups) {
      const double p = std::min(1.0, fails(i, each));
      if (!(p > 0)) continue;
      at.mean += each.units * p;
      at.variance += each.units * p * (1 - p);
    }
    means(static_cast<Eigen::Index>(i), 0) = at.mean;
    found.expected += at.weight * at.mean;
    square += at.weight * at.mean * at.mean;
    variance += at.weight * at.variance;
  }
  found.sd = std::sqrt(std::max(0.0, square - found.expected * found.expected) + variance);
  WeightedDraws of_mean;
  of_mean.values = means;
  of_mean.weights = Eigen::Map<const Eigen::VectorXd>(weight_.data(), means.rows());
  const QuantityDistribution expected(of_mean, [](const double* x) { return x[0]; });
  found.low = expected.quantile(lower_share);
  found.high = expected.quantile(upper_share);
  const double shares[] = {lower_share, upper_share};
  const std::vector<double> ends = count_quantiles(points, shares);
  found.count_low = ends[0];
  found.count_high = ends[1];
  return found;
}

}  // namespace wearwell::formula_model
