#include "wearwell/embed/residuals.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::embed {
namespace {

constexpr Eigen::Index most_draws = 400;

double middle_score(const NormalScore& score) {
  if (score.exact()) return score.low;
  return normal_score(std::log((normal_cdf(score.low) + normal_cdf(score.high)) / 2),
                      std::log((normal_cdf(-score.low) + normal_cdf(-score.high)) / 2));
}

double median_of(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  if (values.size() % 2 == 1) return *middle;
  return (*middle + *std::max_element(values.begin(), middle)) / 2;
}

}  // namespace

Residuals residuals(const Run& run) {
  const PosteriorStudy& study = require_posterior_study(*run.of.study);
  const std::shared_ptr<const PosteriorSummary>& summary = run.result->posterior;
  if (!study.fit_data || !summary || !summary->fit || summary->fit->pooled.values.rows() == 0)
    throw InputError("this model has no residuals: its observations have no scores");
  const FitData& data = *study.fit_data;
  const Eigen::MatrixXd& draws = summary->fit->pooled.values;
  const Eigen::Index count = std::min(draws.rows(), most_draws);
  std::vector<std::vector<NormalScore>> scores(static_cast<std::size_t>(count));
  tbb::parallel_for(std::size_t{0}, scores.size(), [&](std::size_t s) {
    check_stop();
    const Eigen::VectorXd x = draws.row(static_cast<Eigen::Index>(s) * draws.rows() / count);
    scores[s] = data.scores(x.data());
  });
  std::size_t rows = scores.front().size();
  for (const UnitEffect& effect : data.effects) rows -= effect.of.size();
  Residuals found{{}, {}, data.noun};
  for (std::size_t i = 0; i < rows; ++i) {
    check_stop();
    std::vector<double> values;
    for (const std::vector<NormalScore>& each : scores) values.push_back(middle_score(each[i]));
    const int times = data.counts.empty() ? 1 : data.counts[i];
    found.score.insert(found.score.end(), static_cast<std::size_t>(times),
                       median_of(std::move(values)));
    found.censored.insert(found.censored.end(), static_cast<std::size_t>(times),
                          scores.front()[i].exact() ? 0 : 1);
  }
  return found;
}

}  // namespace wearwell::embed
