#include "wearwell/selection/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/erf.hpp>
#include <cmath>
#include <numbers>
#include <numeric>

#include "wearwell/present/plot.h"

namespace wearwell {
namespace {

using plot::Axis;
using plot::Columns;
using plot::Json;
namespace colour = plot::colour;

std::vector<double> list(const Eigen::VectorXd& values) {
  return {values.begin(), values.end()};
}

/// Cells of the cloud between `low` and 1, `step` bins high; darker means more models.
Json cloud_cells(const Cloud& cloud, bool predictive, double low, int step) {
  struct Cell {
    double size, from, to, count;
  };
  std::vector<Cell> cells;
  double most = 1;
  for (std::size_t size = 0; size < cloud.sizes.size(); ++size) {
    const auto& bins = predictive ? cloud.sizes[size].r2p : cloud.sizes[size].r2;
    for (int bin = 0; bin + step <= static_cast<int>(bins.size()); bin += step) {
      const double count = std::accumulate(bins.begin() + bin, bins.begin() + bin + step, 0.0);
      const double from = static_cast<double>(bin) / Cloud::bins;
      if (count == 0 || from < low) continue;
      cells.push_back(
          {static_cast<double>(size), from, static_cast<double>(bin + step) / Cloud::bins, count});
      most = std::max(most, count);
    }
  }
  std::vector<double> x, x2, y, y2, density, models;
  for (const Cell& cell : cells) {
    x.push_back(cell.size - 0.4);
    x2.push_back(cell.size + 0.4);
    y.push_back(cell.from);
    y2.push_back(cell.to);
    density.push_back(0.15 + 0.85 * std::log1p(cell.count) / std::log1p(most));
    models.push_back(cell.count);
  }
  return plot::cells(
      {{"x", x}, {"x2", x2}, {"y", y}, {"y2", y2}, {"density", density}, {"models", models}},
      {colour::posterior});
}

/// The best model of each size.
Columns best_of_sizes(const SearchResult& search, bool predictive) {
  std::vector<double> x, y;
  for (std::size_t size = 1; size < search.by_size.size(); ++size) {
    if (!search.by_size[size].model) continue;
    const SubsetModel& model = *search.by_size[size].model;
    const double value = predictive ? model.r2p : model.r2;
    if (!std::isfinite(value)) continue;
    x.push_back(static_cast<double>(size));
    y.push_back(value);
  }
  return {{"x", x}, {"y", y}};
}

html::Figure size_figure(const SelectionResult& result, bool predictive, bool zoom) {
  const SearchResult& search = result.selection.search;
  const bool all = !search.cloud.sizes.empty();
  const SubsetModel& best = search.models.front();
  const double best_value = predictive ? best.r2p : best.r2;
  const char* symbol = predictive ? "R2p" : "R2";
  Axis terms{"terms of the model"}, height{symbol};
  terms.low = 0.5;
  terms.high = static_cast<double>(result.design.terms.size()) + 0.5;
  double low = 0;
  if (zoom) {
    low = std::max(0.0, std::floor(best_value * 20 - 2) / 20);
    height.low = low;
    height.high = std::min(1.0, best_value + 0.02);
  } else if (all) {
    height.low = 0;
    height.high = 1;
  }
  std::vector<Json> marks;
  if (all) marks.push_back(cloud_cells(search.cloud, predictive, low, zoom ? 2 : 10));
  marks.push_back(
      plot::line(best_of_sizes(search, predictive), {colour::prior, "best of each size", 1, 1.5}));
  marks.push_back(
      plot::points(best_of_sizes(search, predictive), {colour::prior, "", 1, 2, false, 25}));
  marks.push_back(
      plot::points({{"x", {static_cast<double>(best.terms.size())}}, {"y", {best_value}}},
                   {colour::measured, "the best model", 1, 2, false, 90}));
  const std::string what = predictive ? "R2p, by leave-one-out," : "R2";
  html::Figure figure;
  figure.id = fmt::format("{}-{}", predictive ? "r2p" : "r2", zoom ? "near" : "by-size");
  figure.title =
      fmt::format("{} against the number of terms{}", symbol, zoom ? ", near the best" : "");
  figure.caption =
      all ? fmt::format("{} of {}{} models: darker means more models (logarithmic).{}", what,
                        search.cloud.complete ? "all " : "", html::given(search.cloud.models),
                        zoom ? "" : " Below zero counts as zero.")
          : fmt::format("{} of the best model of each size; best by the criterion.", what);
  figure.specification = plot::plot(figure.title, terms, height, std::move(marks), 300, true);
  return figure;
}

html::Figure observed_figure(const SelectionResult& result) {
  const LinearFit& fit = result.selection.fit;
  const double low = std::min(result.observed.minCoeff(), fit.fitted.minCoeff());
  const double high = std::max(result.observed.maxCoeff(), fit.fitted.maxCoeff());
  std::vector<Json> marks = {
      plot::line({{"x", {low, high}}, {"y", {low, high}}}, {colour::prior, "equal", 1, 1.5, true})};
  if (fit.loo_residuals.allFinite()) {
    marks.push_back(plot::points(
        {{"x", list(result.observed - fit.loo_residuals)}, {"y", list(result.observed)}},
        {colour::measured, "predicted without the row", 0.6, 2, false, 25}));
  }
  marks.push_back(plot::points({{"x", list(fit.fitted)}, {"y", list(result.observed)}},
                               {colour::posterior, "fitted", 0.9, 2, false, 30}));
  return {"observed", "Observed against predicted",
          "Points on the dashed line are predicted exactly. A row whose two points are far apart "
          "has a large influence on the fit.",
          plot::plot("Observed against predicted", {"predicted " + result.response},
                     {"observed " + result.response}, std::move(marks), 300, true)};
}

html::Figure residual_figure(const std::string& id, const std::string& title,
                             const std::string& caption, const std::string& axis,
                             const Eigen::VectorXd& x, const Eigen::VectorXd& residuals) {
  return {id, title, caption,
          plot::plot(title, {axis}, {"residual"},
                     {plot::horizontal_line(0, {colour::prior, "", 1, 1.5}),
                      plot::points({{"x", list(x)}, {"y", list(residuals)}},
                                   {colour::posterior, "", 0.8, 2, false, 30})})};
}

/// Residuals, each divided by its own standard deviation sigma sqrt((1 - h) / w).
Eigen::VectorXd standardized(const SelectionResult& result) {
  const LinearFit& fit = result.selection.fit;
  Eigen::ArrayXd scale = (1 - fit.leverages.array()).max(leverage_tolerance).sqrt() * fit.sigma;
  if (result.weights.size() != 0) scale /= result.weights.array().sqrt();
  return fit.residuals.array() / scale;
}

html::Figure quantile_figure(const SelectionResult& result) {
  Eigen::VectorXd sorted = standardized(result);
  std::sort(sorted.begin(), sorted.end());
  const auto n = static_cast<double>(sorted.size());
  std::vector<double> normal;
  for (Eigen::Index i = 0; i < sorted.size(); ++i) {
    const double p = (static_cast<double>(i) + 0.5) / n;
    normal.push_back(std::numbers::sqrt2 * boost::math::erf_inv(2 * p - 1));
  }
  return {"quantiles", "Normal probability plot of residuals",
          "Standardized residuals, sorted, against normal quantiles: near the dashed line the "
          "errors are normal; points off its ends are outliers.",
          plot::plot(
              "Residuals against normal quantiles", {"normal quantile"}, {"standardized residual"},
              {plot::line(
                   {{"x", {normal.front(), normal.back()}}, {"y", {normal.front(), normal.back()}}},
                   {colour::prior, "", 1, 1.5, true}),
               plot::points({{"x", normal}, {"y", list(sorted)}},
                            {colour::posterior, "", 0.8, 2, false, 30})})};
}

html::Figure leverage_figure(const SelectionResult& result) {
  const LinearFit& fit = result.selection.fit;
  const double usual = 2 * static_cast<double>(fit.coefficients.size()) /
                       static_cast<double>(result.observed.size());
  std::vector<double> row(static_cast<std::size_t>(result.observed.size()));
  std::iota(row.begin(), row.end(), 1);
  return {
      "leverage", "Leverage",
      "Distance of each row from the others in the terms of the model: at 1 the fit passes through "
      "the row for any observed value. Check rows above the dashed line, twice the mean.",
      plot::plot("Leverage of each row against its standardized residual", {"leverage"},
                 {"standardized residual"},
                 {plot::horizontal_line(0, {colour::prior, "", 1, 1.5}),
                  plot::vertical_line(usual, {colour::limit, "twice the mean", 1, 1.5, true}),
                  plot::points(
                      {{"x", list(fit.leverages)}, {"y", list(standardized(result))}, {"row", row}},
                      {colour::posterior, "", 0.8, 2, false, 30})})};
}

}  // namespace

std::vector<html::Figure> size_figures(const SelectionResult& result) {
  return {size_figure(result, false, false), size_figure(result, true, false),
          size_figure(result, false, true), size_figure(result, true, true)};
}

std::vector<html::Figure> selection_fit_figures(const SelectionResult& result) {
  const LinearFit& fit = result.selection.fit;
  std::vector<html::Figure> figures = {
      observed_figure(result),
      residual_figure("residuals", "Residuals against predicted",
                      "The residuals should show no trend and no funnel: then the terms suffice "
                      "and the error is constant.",
                      "predicted " + result.response, fit.fitted, fit.residuals),
      quantile_figure(result), leverage_figure(result)};
  for (std::size_t i = 0; i < result.inputs.size(); ++i) {
    figures.push_back(residual_figure(
        fmt::format("residuals-{}", i + 1), fmt::format("Residuals against {}", result.inputs[i]),
        "Curvature indicates that another term of this input is needed.", result.inputs[i],
        result.input_values.col(static_cast<Eigen::Index>(i)), fit.residuals));
  }
  return figures;
}

std::vector<html::Figure> support_figures(const SelectionResult& result) {
  const Selection& selection = result.selection;
  std::vector<double> inclusion, weight, place, zero;
  Axis terms{"term"};
  for (std::size_t t = 0; t < result.design.terms.size(); ++t) {
    terms.names.push_back(result.design.terms[t].name);
    place.push_back(static_cast<double>(t + 1));
    inclusion.push_back(selection.support[t].inclusion);
    weight.push_back(selection.support[t].weight);
    zero.push_back(0);
  }
  Axis share{"share of the models"};
  share.low = -0.02;
  share.high = 1.02;
  return {{"support", "Certainty of each term",
           "The share of the models found with each term, and the sum of their stacking weights. A "
           "term near one is needed; for a term near a half, the data do not decide.",
           plot::plot("Share of the models found that contain each term", share, terms,
                      {plot::points({{"x", weight}, {"y", place}},
                                    {colour::measured, "weight", 0.9, 2, false, 60}),
                       plot::points({{"x", inclusion}, {"y", place}},
                                    {colour::posterior, "share", 0.9, 2, false, 40})},
                      std::max(200, 16 * static_cast<int>(place.size())))}};
}

}  // namespace wearwell
