#include "wearwell/study/plot_study.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"
#include "wearwell/bayes/cell_shares.h"
#include "wearwell/bayes/posterior.h"
#include "wearwell/math/systematic.h"
#include "wearwell/predict/prediction.h"
#include "wearwell/study/describe.h"

namespace wearwell {
namespace {

constexpr int curve_points = 120, bins = 40, grid_cells = 56, life_points = 120;
constexpr std::size_t item_points = 20'000;
constexpr std::size_t most_data_sets = 500;  // plotted and predicted

struct Range {
  double low, high;
};

// Quadrature if available, else draws.
const WeightedDraws& best(const Fit& fit) {
  return fit.exact ? fit.exact->nodes : fit.pooled;
}

std::vector<double> spaced(Range range, int intervals) {
  std::vector<double> points;
  for (int i = 0; i <= intervals; ++i) {
    points.push_back(std::lerp(range.low, range.high, static_cast<double>(i) / intervals));
  }
  return points;
}

// The density of each interval, at its midpoint.
Curve density_curve(const QuantityDistribution& distribution, const std::vector<double>& edges) {
  Curve curve;
  double below = distribution.cdf(edges.front());
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double until = distribution.cdf(edges[i + 1]);
    curve.x.push_back(0.5 * (edges[i] + edges[i + 1]));
    curve.y.push_back((until - below) / (edges[i + 1] - edges[i]));
    below = until;
  }
  return curve;
}

// The same for a parameter, from adjacent cells.
Curve density_curve(const Parameter& parameter, Eigen::Index index, const WeightedDraws& nodes,
                    Range range) {
  const std::vector<double> edges = spaced(range, curve_points);
  const std::vector<double> shares = cell_shares(
      nodes, [&](const double* x) { return from_si(parameter.unit, x[index]); }, edges);
  Curve curve;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    curve.x.push_back(0.5 * (edges[i] + edges[i + 1]));
    curve.y.push_back(shares[i] / (edges[i + 1] - edges[i]));
  }
  return curve;
}

Range within_bounds(const Parameter& parameter, Range range) {
  return {std::max(range.low, from_si(parameter.unit, parameter.prior.lower)),
          std::min(range.high, from_si(parameter.unit, parameter.prior.upper))};
}

// Nearly all of the posterior, and of the prior unless that makes the posterior too narrow to see.
Range range_of(const Parameter& parameter, const QuantityDistribution& posterior) {
  Range range{from_si(parameter.unit, posterior.quantile(0.0005)),
              from_si(parameter.unit, posterior.quantile(0.9995))};
  const double margin = 0.05 * (range.high - range.low);
  range = within_bounds(parameter, {range.low - margin, range.high + margin});
  if (parameter.prior.proper) {
    const Range both{
        std::min(range.low, from_si(parameter.unit, quantile(parameter.prior, 0.002))),
        std::max(range.high, from_si(parameter.unit, quantile(parameter.prior, 0.998)))};
    if (both.high - both.low < 5 * (range.high - range.low)) range = both;
  }
  return range;
}

Histogram histogram(const Parameter& parameter, Eigen::Index index, const Draws& draws,
                    Range range) {
  Histogram result{spaced(range, bins), {}};
  const double width = (range.high - range.low) / bins;
  for (const Chain& chain : draws) {
    std::vector<double> density(bins, 0.0);
    const double share = 1 / (static_cast<double>(chain.values.rows()) * width);
    for (const double si : chain.values.col(index)) {
      const double bin = std::floor((from_si(parameter.unit, si) - range.low) / width);
      if (bin >= 0 && bin < bins) density[static_cast<std::size_t>(bin)] += share;
    }
    result.density.push_back(std::move(density));
  }
  return result;
}

Curve prior_curve(const Parameter& parameter, Range range) {
  Curve curve;
  const std::vector<double> edges = spaced(range, curve_points);
  double area = 0;
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const double x = 0.5 * (edges[i] + edges[i + 1]);
    const double si = to_si(parameter.unit, x);
    const bool inside = parameter.prior.lower < si && si < parameter.prior.upper;
    curve.x.push_back(x);
    curve.y.push_back(
        inside ? std::exp(log_density(parameter.prior, si).value) * parameter.unit.scale : 0);
    area += curve.y.back() * (edges[i + 1] - edges[i]);
  }
  if (!parameter.prior.proper) {
    for (double& y : curve.y) y /= area;
  }
  return curve;
}

ParameterPlots plot_parameter(const PosteriorStudy& study, std::size_t i, const Fit& fit) {
  const Parameter& parameter = study.parameters[i];
  const auto index = static_cast<Eigen::Index>(i);
  const Range range = range_of(parameter, fit.marginals[i]);
  ParameterPlots plots{
      histogram(parameter, index, fit.draws, range), {}, prior_curve(parameter, range)};
  if (fit.exact) plots.exact = density_curve(parameter, index, fit.exact->nodes, range);
  return plots;
}

std::optional<DensityGrid> joint_density(const Posterior& posterior, const Fit& fit) {
  if (posterior.dimension() != 2 || !fit.exact) return {};
  const Parameter &a = posterior.parameters()[0], &b = posterior.parameters()[1];
  const auto centres = [&](const Parameter& parameter, const QuantityDistribution& marginal) {
    const auto edges =
        spaced(within_bounds(parameter, {from_si(parameter.unit, marginal.quantile(0.003)),
                                         from_si(parameter.unit, marginal.quantile(0.997))}),
               grid_cells);
    std::vector<double> middle;
    for (int i = 0; i < grid_cells; ++i) middle.push_back(0.5 * (edges[i] + edges[i + 1]));
    return middle;
  };
  DensityGrid grid{centres(a, fit.marginals[0]), centres(b, fit.marginals[1]), {}};
  for (const double x : grid.x) {
    for (const double y : grid.y) {
      const double point[] = {to_si(a.unit, x), to_si(b.unit, y)};
      grid.density.push_back(posterior.natural_value(point));
    }
  }
  const double highest = *std::max_element(grid.density.begin(), grid.density.end());
  for (double& each : grid.density) each = std::exp(each - highest);
  return grid;
}

History predict_all(const std::vector<PredictionRequest>& requests, const WeightedDraws& draws) {
  std::vector<Prediction> predictions(requests.size());
  tbb::parallel_for(std::size_t{0}, requests.size(), [&](std::size_t i) {
    predictions[i] = predict(draws, requests[i].mean, requests[i].sd, requests[i].family,
                             requests[i].item, item_points);
  });
  History history;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const Unit& unit = requests[i].unit;
    const Prediction& p = predictions[i];
    history.at.push_back(requests[i].at);
    history.mean.push_back(from_si(unit, p.mean));
    history.ci05.push_back(from_si(unit, p.ci05));
    history.ci95.push_back(from_si(unit, p.ci95));
    history.pi05.push_back(from_si(unit, p.pi05));
    history.pi95.push_back(from_si(unit, p.pi95));
  }
  return history;
}

Curve life_curve(const LifeRequest& request, const Fit& fit) {
  const LifeDistribution lives = request.distribution(best(fit));
  // Components that rarely reach the limit have no finite upper quantiles.
  double end = request.now;
  for (const double p : {0.995, 0.95, 0.75, 0.5, 0.25, 0.1}) {
    const double life = lives.quantile(p);
    if (std::isfinite(life)) {
      end = std::max(end, life);
      break;
    }
  }
  const double low = std::min(request.now, lives.quantile(0.001));
  Curve curve;
  for (const double x : spaced({std::max(0.0, low - 0.1 * (end - low)), end}, life_points)) {
    curve.x.push_back(x);
    curve.y.push_back(lives.cdf(x));
  }
  return curve;
}

// Data sets to plot, from 1: all, or the first, the last and evenly spaced ones between.
std::vector<std::size_t> drawn_data_sets(std::size_t all) {
  const std::size_t count = std::min(all, most_data_sets);
  std::vector<std::size_t> drawn;
  for (std::size_t i = 0; i < count; ++i) {
    drawn.push_back(1 + (count > 1 ? i * (all - 1) / (count - 1) : 0));
  }
  return drawn;
}

}  // namespace

// Evenly through the posterior, in slices of its first parameter and within each along the second.
WeightedDraws thinned(const WeightedDraws& draws, Eigen::Index count) {
  const Eigen::Index slices = count / 20;
  std::vector<Eigen::Index> order;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    if (draws.cell_weight(i) > 0) order.push_back(i);
  }
  const auto sort_along = [&](Eigen::Index parameter, auto begin, auto end) {
    std::sort(begin, end, [&](auto a, auto b) {
      return draws.values(a, parameter) < draws.values(b, parameter);
    });
  };
  sort_along(0, order.begin(), order.end());
  if (draws.values.cols() > 1) {
    double mass = 0;
    auto begin = order.begin();
    for (auto end = begin; end != order.end();) {
      mass += draws.cell_weight(*end++);
      if (mass * static_cast<double>(slices) < 1 && end != order.end()) continue;
      sort_along(1, begin, end);
      begin = end;
      mass = 0;
    }
  }

  WeightedDraws few{Points::Zero(count, draws.values.cols()),
                    Eigen::VectorXd::Constant(count, 1.0 / static_cast<double>(count)),
                    {},
                    {}};
  auto at = order.begin();
  double mass = draws.cell_weight(*at);
  for (Eigen::Index i = 0; i < count; ++i) {
    while (mass * static_cast<double>(count) < static_cast<double>(i) + 0.5 &&
           at + 1 != order.end()) {
      mass += draws.cell_weight(*++at);
    }
    few.values.row(i) = draws.values.row(*at);
  }
  return few;
}

WeightedDraws gathered(const WeightedDraws& draws, double share) {
  std::vector<Eigen::Index> rows;
  std::vector<double> weights;
  Systematic sample(share);
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    const double weight = draws.weights[i];
    if (weight < share && !sample.takes(weight)) continue;
    rows.push_back(i);
    weights.push_back(std::max(weight, share));
  }
  WeightedDraws few{draws.values(rows, Eigen::all),
                    Eigen::Map<const Eigen::VectorXd>(weights.data(), std::ssize(weights)),
                    {},
                    {}};
  few.weights /= few.weights.sum();
  return few;
}

Plots plot_study(const PosteriorStudy& study, const Posterior& posterior, const Fit& fit) {
  Plots plots;
  if (study.stage_predictions) {
    const PredictionRequest first = study.stage_predictions(1).front();
    plots.unit = first.unit.text;
    plots.at_name = first.at_name;
  }
  plots.parameters.resize(study.parameters.size());
  tbb::parallel_for(std::size_t{0}, plots.parameters.size(),
                    [&](std::size_t i) { plots.parameters[i] = plot_parameter(study, i, fit); });
  plots.joint = joint_density(posterior, fit);

  plots.study_text = study.file.text;
  plots.files = {{valid_utf8(study.file.path.filename().string()), sha1_of(study.file.text)},
                 {study.data_file, study.data_sha1}};

  // The draws of an improper posterior never converge, so they predict nothing.
  if (!std::all_of(fit.tails.begin(), fit.tails.end(),
                   [](const Tail& tail) { return tail.integrable(); })) {
    return plots;
  }
  if (!study.history.empty()) plots.history = predict_all(study.history, thinned(best(fit), 1000));

  if (study.stage_predictions) {
    std::vector<PredictionRequest> observed;
    for (const std::size_t rows : drawn_data_sets(study.data_rows)) {
      observed.push_back(study.stage_predictions(rows).front());
      plots.measured.push_back(from_si(observed.back().unit, *observed.back().measured));
      plots.history_at.push_back(study.history_at.empty() ? observed.back().at
                                                          : study.history_at[rows - 1]);
    }
    plots.replicated = predict_all(observed, thinned(best(fit)));
    plots.history_note = study.history_note;
  }
  if (study.figures) plots.figures = study.figures(fit);
  if (study.life) {
    plots.life = life_curve(*study.life, fit);
    plots.limit = from_si(study.history.front().unit, study.life->limit.si());
  }
  return plots;
}

std::vector<Curve> stage_densities(const Parameter& parameter, Eigen::Index index,
                                   const std::vector<WeightedDraws>& stages) {
  std::vector<QuantityDistribution> all;
  for (const WeightedDraws& draws : stages)
    all.emplace_back(draws, [&](const double* x) { return from_si(parameter.unit, x[index]); });
  Range range{INFINITY, -INFINITY};
  for (std::size_t i = all.size() / 2; i < all.size(); ++i) {
    range.low = std::min(range.low, all[i].quantile(0.05));
    range.high = std::max(range.high, all[i].quantile(0.95));
  }
  const double margin = 0.15 * (range.high - range.low);
  range = within_bounds(parameter, {range.low - margin, range.high + margin});
  std::vector<Curve> curves;
  for (const QuantityDistribution& each : all) {
    // If the plot shows little of a wide posterior, few points carry its weight.
    const double seen = each.cdf(range.high) - each.cdf(range.low);
    const int intervals = std::clamp(static_cast<int>(seen * curve_points), 6, curve_points);
    Curve curve = density_curve(each, spaced(range, intervals));
    curve.x.insert(curve.x.begin(), range.low);
    curve.y.insert(curve.y.begin(), curve.y.front());
    curve.x.push_back(range.high);
    curve.y.push_back(curve.y.back());
    curves.push_back(std::move(curve));
  }
  return curves;
}

}  // namespace wearwell
