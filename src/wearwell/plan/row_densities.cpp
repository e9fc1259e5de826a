#include "wearwell/plan/row_densities.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/input/columns.h"
#include "wearwell/math/constants.h"
#include "wearwell/plan/new_level_integral.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

// The study with the rows of tests, at nodes of the posterior.
class JoinedStudy {
 public:
  JoinedStudy(const TestStudy& study, const Table& tests, const Points& nodes)
      : study_(study), histories_(with_histories(study, tests)), nodes_(nodes) {
    Source source = with_rows(study, histories_.rows);
    for (std::size_t i = 0; i < study.parameters.size(); ++i)
      source.starts[study.parameters[i]] = nodes(0, static_cast<Index>(i));
    const auto read = study.read(source);
    const PosteriorStudy& joined = require_posterior_study(*read);
    find_places(joined.parameters);
    likelihood_ = joined.likelihood(joined.data_rows);
    tests_ = tests.rows;
    first_ = first_new();
  }

  Points densities(EffectIntegral integral) const {
    Points all(nodes_.rows(), static_cast<Index>(tests_));
    tbb::parallel_for(Index{0}, nodes_.rows(), [&](Index j) {
      const std::vector<double> of_node = densities_at(j, integral);
      std::copy(of_node.begin(), of_node.end(), all.row(j).data());
    });
    return all;
  }

 private:
  // Where each parameter is in a node; -1 for the effect of a level without data.
  void find_places(const std::vector<Parameter>& parameters) {
    for (const Parameter& each : parameters) {
      const auto own = std::find(study_.parameters.begin(), study_.parameters.end(), each.name);
      if (own != study_.parameters.end()) {
        place_.push_back(own - study_.parameters.begin());
      } else if (each.of_model) {
        place_.push_back(-1);
        ++effects_;
      } else {
        throw InputError(fmt::format(
            "plan: the parameters of this study depend on its rows ({} is of these tests alone), "
            "so that a row has no distribution of its own",
            each.name));
      }
    }
    if (effects_ > 1)
      throw InputError(fmt::format(
          "plan: a test at levels without data has {} effects that are not known, and one can be "
          "integrated over; name levels of the data in the table of candidates",
          effects_));
  }

  std::vector<double> factors(Index j, double effect) const {
    std::vector<double> x;
    for (const Index place : place_) x.push_back(place >= 0 ? nodes_(j, place) : effect);
    return likelihood_->pointwise(x);
  }

  // Where the factors of the tests stand, by unit or by row: the study's own stay as they are
  // before and after them.
  std::size_t first_new() {
    const std::vector<double> own =
        study_.own->pointwise({nodes_.row(0).data(), static_cast<std::size_t>(nodes_.cols())});
    const std::vector<double> all = factors(0, 0);
    if (all.size() < own.size()) refuse_dependent_rows();
    const std::size_t count = all.size() - own.size();
    if (count == histories_.blocks.size()) {
      blocks_.assign(count, 1);
    } else if (count == histories_.rows.rows && study_.roles.measured.size() <= 1) {
      blocks_ = histories_.blocks;
    } else {
      refuse_dependent_rows();
    }
    std::size_t first = 0;
    while (first < own.size() && same_factor(own[first], all[first])) ++first;
    for (std::size_t i = first; i < own.size(); ++i)
      if (!same_factor(own[i], all[i + count])) refuse_dependent_rows();
    return first;
  }

  // Of the tests and of the copies alone: the sum of the log factors of each.
  std::vector<double> new_factors(Index j, double effect) const {
    check_stop();
    const std::vector<double> all = factors(j, effect);
    std::vector<double> sums;
    std::size_t at = first_;
    for (const std::size_t size : blocks_) {
      sums.push_back(0);
      for (std::size_t i = 0; i < size; ++i) sums.back() += all[at++];
    }
    return sums;
  }

  // Of the tests at one node. Units that the study has are given their own rows.
  std::vector<double> densities_at(Index j, EffectIntegral integral) const {
    std::vector<double> factor = effects_ == 0                       ? new_factors(j, 0)
                                 : integral == EffectIntegral::rough ? rough_factors(j)
                                                                     : integrated_factors(j);
    for (std::size_t i = 0; i < tests_; ++i) {
      const std::size_t unit = histories_.unit[i];
      if (unit != Histories::none) factor[i] -= factor[tests_ + unit];
      if (std::isnan(factor[i])) factor[i] = -infinity;
    }
    factor.resize(tests_);
    return factor;
  }

  // The logarithms of the factors at the nodes of an integral; those known are every second one.
  Eigen::MatrixXd at_levels(Index j, const NewLevelIntegral& level,
                            const Eigen::MatrixXd& known = {}) const {
    Eigen::MatrixXd log_density(std::ssize(level.z()), std::ssize(blocks_));
    for (Index k = 0; k < log_density.rows(); ++k) {
      if (known.rows() > 0 && k % 2 == 0) {
        log_density.row(k) = known.row(k / 2);
        continue;
      }
      const std::vector<double> at = new_factors(j, level.z()[static_cast<std::size_t>(k)]);
      log_density.row(k) = Eigen::Map<const Eigen::RowVectorXd>(at.data(), std::ssize(at));
    }
    return log_density;
  }

  std::vector<double> rough_factors(Index j) const {
    const NewLevelIntegral& level = new_level_integrals()[1];
    return level.rough_log_means(at_levels(j, level));
  }

  std::vector<double> integrated_factors(Index j) const {
    Eigen::MatrixXd known;
    std::vector<double> before;
    for (const NewLevelIntegral& level : new_level_integrals()) {
      known = at_levels(j, level, known);
      std::vector<double> after = level.log_means(known);
      if (!before.empty() && steady(before, after)) return after;
      before = std::move(after);
    }
    throw InputError(
        "plan: the effect of a level without data is so large beside the scatter of a reading that "
        "the integral over it is not resolved; name a level of the data in the table of "
        "candidates");
  }

  static bool steady(const std::vector<double>& before, const std::vector<double>& after) {
    constexpr double allowed = 1e-3;
    const double top = *std::max_element(after.begin(), after.end());
    if (!std::isfinite(top)) return true;
    for (std::size_t i = 0; i < after.size(); ++i)
      if (std::abs(std::exp(after[i] - top) - std::exp(before[i] - top)) > allowed) return false;
    return true;
  }

  const TestStudy& study_;
  Histories histories_;
  const Points& nodes_;
  std::shared_ptr<const LogDensity> likelihood_;
  std::vector<Index> place_;
  int effects_ = 0;
  std::size_t tests_ = 0, first_ = 0;
  std::vector<std::size_t> blocks_;  // numbers of factors of each test, then of each copy alone
};

}  // namespace

void refuse_dependent_rows() {
  throw InputError(
      "plan: the rows of this study depend on each other, so that a row to come has no "
      "distribution of its own (paths whose steps or sums continue from row to row). For units "
      "in use see wearwell plan inspect and wearwell decide --inspect-after");
}

bool same_factor(double a, double b) {
  if (!std::isfinite(a) || !std::isfinite(b)) return a == b || (std::isnan(a) && std::isnan(b));
  return std::abs(a - b) <= 1e-7 * (1 + std::abs(a));
}

bool has_new_levels(const TestStudy& study, const Table& conditions) {
  for (const ConditionColumn& each : study.conditions) {
    if (!each.varies || each.heading == study.unit) continue;
    const Column& column = conditions.column(each.heading);
    for (std::size_t row = 0; row < conditions.rows; ++row)
      if (each.is_new(cell_word(column, row))) return true;
  }
  return false;
}

Points row_densities(const TestStudy& study, const Table& rows, const Points& nodes,
                     EffectIntegral integral) {
  return JoinedStudy(study, rows, nodes).densities(integral);
}

}  // namespace wearwell::plan
