#include "wearwell/models/bearing/bearing_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/bearing/bearing_data.h"
#include "wearwell/models/bearing/bearing_figures.h"
#include "wearwell/models/bearing/bearing_predictions.h"
#include "wearwell/models/bearing/wear_fit.h"
#include "wearwell/models/bearing/wear_scores.h"

namespace wearwell {
namespace {

std::vector<Parameter> read_parameters(const TomlReader& root, const BearingData& data,
                                       const bearing::WearModel& model) {
  const auto priors = root.table("prior");
  bearing::WearGuess guess{};
  try {
    guess = bearing::guess(data.inspections);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", data.source, error.what()));
  }
  if (model.has_scatter && data.bearings < 2) {
    priors->fail("k_scatter", fmt::format("all rows of {} are of one bearing; the scatter between "
                                          "bearings needs at least 2",
                                          data.source));
  }
  // Defaults: k as for any wear (models/joint), sigma no larger than the measured depths, and
  // bearings within a factor of 10.
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    return read_prior(root, priors, spec);
  };
  std::vector<Parameter> parameters;
  parameters.push_back(read({"k", "m^3/(N m)", 0, INFINITY, guess.k},
                            {"lognormal", Lognormal{1e-14, 4.2}, "mm^3/(N m)"}));
  if (model.depth_error) {
    if (priors && priors->has("sigma")) {
      priors->fail("sigma", "is given, but likelihood.depth_error fixes it; keep one");
    }
  } else {
    if (data.inspections.depth.size() < 2) {
      throw InputError(fmt::format(
          "{} has 1 inspection; a wear rate and the scatter of depths need at least 2 (or a known "
          "likelihood.depth_error)",
          data.source));
    }
    double largest = 0;
    for (const double d : data.inspections.depth) largest = std::max(largest, std::abs(d));
    // If bearings vary, residuals are only partly measurement error.
    const double sigma = std::max((model.has_scatter ? 0.5 : 1) * guess.sigma, 1e-3 * largest);
    parameters.push_back(
        read({"sigma", "m", 0, INFINITY, sigma},
             {"half-normal", HalfNormal{rounded_up(largest)}, data.depth_unit.text}));
  }
  if (model.has_scatter) {
    parameters.push_back(read({"k_scatter", "1", 0, INFINITY, std::max(guess.scatter, 0.05)},
                              {"half-normal", HalfNormal{1}, "1"}));
  }
  return parameters;
}

std::string description(const bearing::WearModel& model, const BearingData& data) {
  const std::string sd =
      model.depth_error
          ? fmt::format("{:.4g} {} (known)", from_si(data.depth_unit, *model.depth_error),
                        data.depth_unit.text)
          : "sigma";
  const std::string rate =
      model.has_scatter
          ? fmt::format(", k of each of {} bearings = k exp(k_scatter z), z ~ N(0, 1)",
                        data.bearings)
          : "";
  return fmt::format(
      "depth = radius x delta(p_a k n, clearance/radius){}; depth measured with {} error of "
      "standard deviation {}",
      rate, model.family == ObservationFamily::normal ? "normal" : "lognormal", sd);
}

// Wear grows within each bearing, or if all share k, within each geometry.
FitData fit_data(const bearing::WearModel& model, const BearingData& data) {
  const bearing::Inspections& inspections = data.inspections;
  std::vector<double> loading;
  std::vector<std::size_t> group;
  for (std::size_t i = 0; i < inspections.duty.size(); ++i) {
    const bearing::Duty& duty = inspections.duty[i];
    loading.push_back(duty.pressure * duty.revolutions);
    std::size_t first = 0;
    const auto alike = [&](std::size_t j) {
      const bearing::Duty& other = inspections.duty[j];
      return (!model.has_scatter || inspections.bearing[j] == inspections.bearing[i]) &&
             other.contact == duty.contact && other.radius == duty.radius &&
             other.clearance == duty.clearance;
    };
    while (!alike(first)) ++first;
    group.push_back(first);
  }
  const Rise rise{"wear depth increases with pressure times revolutions", loading,
                  inspections.depth, group, true};
  FitData result{bearing::wear_scores(model, inspections),
                 {},
                 {{"pressure times revolutions", loading}},
                 rise,
                 "row",
                 !model.has_scatter,
                 !model.has_scatter};
  for (const double depth : inspections.depth) {
    result.measured.value.push_back(from_si(data.depth_unit, depth));
    result.measured.unit.push_back(data.depth_unit.scale);
  }
  result.remedies.scatter =
      model.family == ObservationFamily::normal
          ? "The scatter grows with the wear depth: try family = \"lognormal\"."
          : "Scatter proportional to the wear depth does not fit: try family = \"normal\".";
  result.labels = {{"bearing", inspections.bearing}};
  return result;
}

// By bearing if they vary, else by inspection.
DensityUnit density_of(const bearing::WearModel& model, const BearingData& data) {
  const std::vector<double>& depth = data.inspections.depth;
  DensityUnit unit = density_unit(data.depth_unit, depth.size());
  if (!model.has_scatter) return unit;
  const double each = std::log(data.depth_unit.scale);
  unit.terms.clear();
  for (const std::size_t bearing : data.inspections.bearing) {
    unit.terms.resize(std::max(unit.terms.size(), bearing + 1));
    unit.terms[bearing] += each;
  }
  return unit;
}

}  // namespace

bearing::WearModel bearing::read_wear_model(const TomlReader& root) {
  WearModel model;
  if (const auto likelihood = root.table("likelihood")) {
    const auto family = likelihood->choice("family", {"normal", "lognormal"});
    if (family == "lognormal") model.family = ObservationFamily::lognormal;
    if (const auto error = positive_quantity(*likelihood, "depth_error", "m")) {
      model.depth_error = error->si();
    }
  }
  const auto priors = root.table("prior");
  model.has_scatter = priors && priors->has("k_scatter");
  return model;
}

void read_bearing_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const bearing::WearModel model = bearing::read_wear_model(root);
  const BearingData data = read_bearing_data(root, source, model.family);
  study.parameters = read_parameters(root, data, model);
  study.equation = description(model, data);
  study.data_rows = data.inspections.depth.size();
  study.quantity = "wear depth";
  study.observed = data.inspections.depth;
  study.density = density_of(model, data);
  study.data_columns = data.columns;
  study.data_layout = data.layout;
  if (model.has_scatter) study.observation = "bearing";
  study.meanings = {"specific wear rate"};
  if (!model.depth_error) study.meanings.emplace_back("scatter of one measured depth");
  if (model.has_scatter) study.meanings.emplace_back("scatter of ln k between bearings");
  study.likelihood = [=, inspections = data.inspections](std::size_t rows) {
    return bearing::wear_likelihood(model, inspections, rows);
  };
  study.fit_data = fit_data(model, data);
  const double k = study.parameters.front().start;
  study.stage_predictions = [=](std::size_t rows) {
    std::vector<PredictionRequest> requests;
    for (std::size_t i = rows - 1; i < std::min(rows + 1, data.inspections.depth.size()); ++i) {
      requests.push_back(
          depth_request(model, data, data.inspections.duty[i], k, data.inspections.depth[i]));
    }
    return requests;
  };
  // A report draws the predicted bearing, or else the last one inspected.
  PredictedBearing drawn{data.inspections.duty.back(), {}};
  if (const auto predict = root.table("predict")) {
    drawn = read_bearing_predictions(*predict, model, data, k, study);
  }
  add_bearing_history(model, data, drawn, k, study);
  study.figures = [=](const Fit& fit) { return bearing_figures(data, drawn, fit); };
}

}  // namespace wearwell
