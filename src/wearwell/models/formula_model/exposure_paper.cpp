#include "wearwell/models/formula_model/exposure_paper.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/bayes/normal_score.h"
#include "wearwell/present/plot.h"
#include "wearwell/prob/plotting_positions.h"
#include "wearwell/prob/standard_distribution.h"
#include "wearwell/study/plot_study.h"

namespace wearwell::formula_model {
namespace {

std::vector<double> posterior_medians(const WeightedDraws& draws) {
  std::vector<double> medians;
  for (Eigen::Index k = 0; k < draws.values.cols(); ++k)
    medians.push_back(
        QuantityDistribution(draws, [k](const double* p) { return p[k]; }).quantile(0.5));
  return medians;
}

// An observation on the scale of normal scores.
Response response_of(const NormalScore& score) {
  if (score.exact()) return {Censoring::none, score.low};
  if (std::isinf(score.high)) return {Censoring::right, score.low};
  if (std::isinf(score.low)) return {Censoring::left, score.high};
  return {Censoring::interval, score.low, score.high};
}

html::Figure exposure_figure(const FormulaModel& model, const FitData& data, const Fit& fit) {
  const Measured& measured = model.measured.front();
  const StandardDistribution paper = measured.form->paper.distribution;
  const std::vector<double> medians = posterior_medians(fit.exact ? fit.exact->nodes : fit.pooled);
  std::vector<Response> responses;
  for (const NormalScore& each : data.scores(medians.data()))
    responses.push_back(response_of(each));
  const std::vector<int> counts =
      data.counts.empty() ? std::vector<int>(responses.size(), 1) : data.counts;
  std::vector<double> x, y, expected, observed;
  double least = 0.05, most = 0.95;
  for (const PlottingPosition& each : plotting_positions(responses, counts)) {
    const double share = normal_cdf(each.at);
    if (!(share > 0 && share < 1)) continue;
    x.push_back(quantile(paper, share));
    y.push_back(quantile(paper, each.p));
    expected.push_back(100 * share);
    observed.push_back(100 * each.p);
    least = std::min({least, share, each.p});
    most = std::max({most, share, each.p});
  }
  std::vector<std::pair<double, std::string>> ticks;
  for (const double percent : {0.1, 1., 5., 10., 50., 90., 99., 99.9})
    if (percent >= 100 * least && percent <= 100 * most)
      ticks.emplace_back(quantile(paper, percent / 100), fmt::format("{:g}", percent));
  const double low = quantile(paper, least), high = quantile(paper, most);
  const auto axis = [&](const char* title) {
    plot::Axis each{title, false, low, high};
    each.ticks = ticks;
    return each;
  };
  return {
      "exposure-paper",
      fmt::format("Probability plot of the standardized exposures on {} paper",
                  measured.form->paper.name),
      "Each failure stands at the share that the fit (posterior medians) expects failed by its "
      "exposure, against the share that has failed: Kaplan-Meier or Turnbull. Points along the "
      "line support the distribution and the effect of the stress.",
      plot::plot(
          "Share failed against the share that the fit expects, by exposure",
          axis("Expected failed [%]"), axis("Failed [%]"),
          {plot::line({{"x", {low, high}}, {"y", {low, high}}},
                      {plot::colour::posterior, "fitted", 1, 2}),
           plot::points({{"x", x}, {"y", y}, {"expected [%]", expected}, {"failed [%]", observed}},
                        {plot::colour::measured, "observed", 1, 0, false, 60})},
          340, true),
      {},
      true};
}

}  // namespace

void show_exposure_paper(std::shared_ptr<const FormulaModel> model, PosteriorStudy& study) {
  const Measured& measured = model->measured.front();
  if (model->measured.size() > 1 || model->modes || model->has_random_effects() ||
      measured.form->counted || measured.observed.failures == 0 || !study.fit_data)
    return;
  study.figures = [model, data = *study.fit_data, before = study.figures](const Fit& fit) {
    auto figures = before ? before(fit) : std::map<std::string, std::vector<html::Figure>>();
    figures["verdict"].push_back(exposure_figure(*model, data, fit));
    return figures;
  };
}

}  // namespace wearwell::formula_model
