#include "wearwell/models/recurrence/process.h"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <limits>

#include "wearwell/base/stop_scope.h"
#include "wearwell/math/dual.h"

namespace wearwell::recurrence {
namespace {

// log(1 - exp(-h)) for h > 0.
template <class T>
T log_failed(const T& h) {
  using std::exp, std::log;
  constexpr double small = 1e-4;
  if (scalar(h) < small) return log(h) - h / 2.0 + h * h / 24.0;
  return log(1.0 - exp(-h));
}

// The expected number of failures in the gap, or its cumulative hazard.
template <class T>
T cumulative_hazard(const Process& process, const Gap& gap, const T* x) {
  return process.minimal_repair() ? process.mean_by(x, gap.to) - process.mean_by(x, gap.from)
                                  : weibull_hazard(x, gap.to - gap.from);
}

template <class T>
T log_factor(const Process& process, const Gap& gap, const T* x) {
  using std::log;
  if (!process.minimal_repair() && gap.failed && !(gap.to > gap.from))
    return log_failed(weibull_hazard(x, process.rounding)) - std::log(process.rounding);
  const T hazard = cumulative_hazard(process, gap, x);
  if (gap.count && *gap.count > 0) {
    const auto count = static_cast<double>(*gap.count);
    return count * log(hazard) - hazard - std::lgamma(count + 1);
  }
  if (!gap.failed) return -hazard;
  if (process.kind == ProcessKind::phases) return -log(x[process.phase_at(gap.to)]) - hazard;
  if (process.minimal_repair())
    return log(x[0] * x[1] / gap.to) + x[0] * std::log(gap.to / process.reference) - hazard;
  const double length = gap.to - gap.from;
  return log(x[0] / length) + x[0] * (std::log(length) - log(x[1])) - hazard;
}

// By the failures and the time of observation of each phase.
class PhaseLikelihood final : public LogDensity {
 public:
  PhaseLikelihood(const Process& process, const RecurrenceData& data)
      : process_(process),
        gaps_(data.gaps),
        failures_(process.parameters()),
        time_(process.parameters()) {
    for (const Gap& gap : gaps_) {
      if (gap.failed) failures_[process.phase_at(gap.to)] += 1;
      if (gap.count && *gap.count > 0) {
        const auto count = static_cast<double>(*gap.count);
        failures_[process.phase_at(gap.to)] += count;
        constant_ += count * std::log(gap.to - gap.from) - std::lgamma(count + 1);
      }
      for (std::size_t k = 0; k < time_.size(); ++k)
        time_[k] += process.time_in_phase(k, gap.to) - process.time_in_phase(k, gap.from);
    }
  }

  int dimension() const override { return static_cast<int>(time_.size()); }
  double value(std::span<const double> x) const override {
    double sum = constant_;
    for (std::size_t k = 0; k < time_.size(); ++k) {
      sum -= time_[k] / x[k];
      if (failures_[k] > 0) sum -= failures_[k] * std::log(x[k]);
    }
    return std::isfinite(sum) ? sum : -std::numeric_limits<double>::infinity();
  }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    for (std::size_t k = 0; k < time_.size(); ++k)
      gradient[k] = (time_[k] / x[k] - failures_[k]) / x[k];
    return value(x);
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    std::vector<double> terms;
    terms.reserve(gaps_.size());
    for (const Gap& gap : gaps_) {
      check_stop();
      terms.push_back(log_factor(process_, gap, x.data()));
    }
    return terms;
  }

 private:
  Process process_;
  std::vector<Gap> gaps_;
  std::vector<double> failures_, time_;
  double constant_ = 0;  // of grouped failures
};

class ProcessLikelihood final : public LogDensity {
 public:
  ProcessLikelihood(const Process& process, const RecurrenceData& data)
      : process_(process), gaps_(data.gaps) {
    for (const Gap& gap : gaps_) {
      if (gap.count && *gap.count > 0) grouped_.push_back(gap);
      if (!gap.failed) continue;
      ++failures_;
      log_ages_ += std::log(gap.to / process.reference);
      log_products_ += std::log(gap.to);
    }
    for (const UnitHistory& unit : data.units) {
      ends_.push_back({unit.end, 1});
      if (unit.start > 0) ends_.push_back({unit.start, -1});
    }
    std::sort(ends_.begin(), ends_.end());
    std::vector<std::pair<double, double>> merged;  // units of one age together
    for (const auto& [age, count] : ends_) {
      if (merged.empty() || merged.back().first != age) merged.push_back({age, 0});
      merged.back().second += count;
    }
    ends_ = std::move(merged);
  }

  int dimension() const override { return 2; }
  double value(std::span<const double> x) const override { return sum(x.data()); }
  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    return wearwell::value_and_gradient<2>([this](const auto* p) { return sum(p); }, x, gradient);
  }
  std::vector<double> pointwise(std::span<const double> x) const override {
    std::vector<double> terms;
    terms.reserve(gaps_.size());
    for (const Gap& gap : gaps_) {
      check_stop();
      terms.push_back(finite(log_factor(process_, gap, x.data())));
    }
    return terms;
  }

 private:
  static double finite(double value) {
    return std::isnan(value) ? -std::numeric_limits<double>::infinity() : value;
  }

  template <class T>
  T sum(const T* x) const {
    using std::log;
    T total(0.0);
    if (process_.minimal_repair()) {
      for (const auto& [age, units] : ends_) total -= units * process_.mean_by(x, age);
      for (const Gap& gap : grouped_) {
        const auto count = static_cast<double>(*gap.count);
        total += count * log(cumulative_hazard(process_, gap, x)) - std::lgamma(count + 1);
      }
      if (failures_ > 0) total += failures_ * log(x[0] * x[1]) + x[0] * log_ages_ - log_products_;
    } else {
      for (const Gap& gap : gaps_) total += log_factor(process_, gap, x);
    }
    // Beyond the range of numbers the likelihood is 0.
    return std::isfinite(scalar(total)) ? total : T(-std::numeric_limits<double>::infinity());
  }

  Process process_;
  std::vector<Gap> gaps_, grouped_ = {};
  std::vector<std::pair<double, double>>
      ends_;  // ages, with the number of units whose observation ends or begins
  double failures_ = 0, log_ages_ = 0, log_products_ = 0;
};

// The scores between which a Poisson number with this mean lies.
NormalScore score_of_count(std::size_t count, double mean) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  if (!(mean > 0)) return {-infinity, infinity};
  const auto up_to = [&](double n) {
    return normal_score(std::log(boost::math::gamma_q(n + 1, mean)),
                        std::log(boost::math::gamma_p(n + 1, mean)));
  };
  const auto n = static_cast<double>(count);
  return {count > 0 ? up_to(n - 1) : -infinity, up_to(n)};
}

double score_at(double hazard) {
  if (!(hazard > 0)) return -std::numeric_limits<double>::infinity();
  return normal_score(log_failed(hazard), -hazard);
}

}  // namespace

std::shared_ptr<const LogDensity> process_likelihood(const Process& process,
                                                     const RecurrenceData& data) {
  if (process.kind == ProcessKind::phases) return std::make_shared<PhaseLikelihood>(process, data);
  return std::make_shared<ProcessLikelihood>(process, data);
}

Scores process_scores(const Process& process, const RecurrenceData& data) {
  return [process, gaps = data.gaps](const double* x) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::vector<NormalScore> scores;
    scores.reserve(gaps.size());
    for (const Gap& gap : gaps) {
      check_stop();
      if (gap.count) {
        scores.push_back(score_of_count(*gap.count, cumulative_hazard(process, gap, x)));
        continue;
      }
      if (gap.failed && !(gap.to > gap.from)) {
        const double hazard = process.minimal_repair()
                                  ? process.intensity(x, gap.to) * process.rounding
                                  : weibull_hazard(x, process.rounding);
        scores.push_back({-infinity, score_at(hazard)});
        continue;
      }
      const double score = score_at(cumulative_hazard(process, gap, x));
      scores.push_back({score, gap.failed ? score : infinity});
    }
    return scores;
  };
}

}  // namespace wearwell::recurrence
