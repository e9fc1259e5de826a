#include "wearwell/models/bearing/bearing_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "wearwell/models/bearing/depth_function.h"
#include "wearwell/models/bearing/wear_number.h"
#include "wearwell/present/plot.h"

namespace wearwell {
namespace {

using bearing::Contact;
using bearing::Duty;
using Numbers = std::vector<double>;
namespace colour = plot::colour;

constexpr int curve_points = 60;
constexpr std::size_t most_curves = 4;

double loading(const Duty& duty) {
  return duty.pressure * duty.revolutions;
}

double depth_at(const Duty& duty, double k) {
  const bearing::DepthFunction curve = bearing::depth_functions({duty}, k).front();
  return curve.depth(std::min(std::log(k), curve.limit()));
}

// A selection of sigmas from the smallest to the largest, one curve for each.
Numbers chosen(const std::set<double>& sigmas) {
  const Numbers all(sigmas.begin(), sigmas.end());
  if (all.size() <= most_curves) return all;
  Numbers few;
  for (std::size_t i = 0; i < most_curves; ++i) {
    few.push_back(all[i * (all.size() - 1) / (most_curves - 1)]);
  }
  return few;
}

// p_a k n against delta for the contact of `drawn`: a curve for each clearance of the data, and the
// inspections as points with the interval of the wear number.
html::Figure chart_figure(const BearingData& data, const PredictedBearing& drawn,
                          const QuantityDistribution& k) {
  Numbers delta, low, middle, high;
  std::set<double> sigmas;
  double deepest = 0;
  for (std::size_t i = 0; i < data.inspections.depth.size(); ++i) {
    const Duty& duty = data.inspections.duty[i];
    if (duty.contact != drawn.duty.contact) continue;
    sigmas.insert(duty.clearance / duty.radius);
    delta.push_back(data.inspections.depth[i] / duty.radius);
    deepest = std::max(deepest, delta.back());
    low.push_back(k.quantile(0.05) * loading(duty));
    middle.push_back(k.quantile(0.5) * loading(duty));
    high.push_back(k.quantile(0.95) * loading(duty));
  }
  if (delta.empty()) {
    sigmas.insert(drawn.duty.clearance / drawn.duty.radius);
    deepest = depth_at(drawn.duty, k.quantile(0.5)) / drawn.duty.radius;
  }
  std::vector<plot::Json> marks;
  const Numbers curves = chosen(sigmas);
  for (std::size_t c = 0; c < curves.size(); ++c) {
    Numbers x, y;
    for (int i = 0; i <= curve_points; ++i) {
      x.push_back(1.1 * deepest * i / curve_points);
      y.push_back(bearing::wear_number(drawn.duty.contact, curves[c], x.back()));
    }
    marks.push_back(
        plot::line({{"x", x}, {"y", y}, {"delta", x}, {"wear number", y}},
                   {colour::chains[c], fmt::format("sigma = {}", html::number(curves[c], 3))}));
  }
  if (!delta.empty()) {
    marks.push_back(
        plot::ranges({{"x", delta}, {"y", low}, {"y2", high}}, {colour::measured, "", 0.5, 3}));
    marks.push_back(
        plot::points({{"x", delta}, {"y", middle}, {"delta", delta}, {"wear number", middle}},
                     {colour::measured, "inspections", 1, 0, false, 50}));
  }
  return {
      "chart", "Wear number against depth",
      fmt::format("Contact: {}. Each inspection is at its measured delta = depth/radius and at the "
                  "wear number p_a k n of the fitted k, with its 90 % interval (k of the median "
                  "bearing, if bearings vary).",
                  bearing::contact_name(drawn.duty.contact)),
      plot::plot("Wear number p_a k n against delta, with the inspections",
                 {"delta = depth/radius", false, 0.0}, {"p_a k n", false, 0.0}, marks, 320, true)};
}

// 1, 2 or 5 times a power of ten, at most x.
double round_down(double x) {
  const double power = std::pow(10.0, std::floor(std::log10(x)));
  for (const double digit : {5.0, 2.0}) {
    if (digit * power <= x) return digit * power;
  }
  return power;
}

// The lower half of the bore around its center, radii in bore radii, with exaggerated deviations
// from the bore.
struct Profile {
  Numbers x, y;
  void add(double angle, double deviation, double factor) {
    const double radius = 1 + factor * deviation;
    x.push_back(radius * std::sin(angle));
    y.push_back(-radius * std::cos(angle));
  }
};

html::Figure scar_figure(const Unit& unit, const Duty& duty, double depth) {
  const double bore = duty.radius + duty.clearance;
  const double worn_radius = duty.contact == Contact::journal ? duty.radius - depth : duty.radius;
  const double worn_bore = duty.contact == Contact::bushing ? bore + depth : bore;
  // The journal rests on the lower half.
  const double down =
      (duty.contact == Contact::stationary ? duty.clearance + depth : worn_bore - worn_radius);
  const double largest = std::max(down, 2 * duty.clearance + depth) / bore;
  const double factor = std::max(1.0, round_down(0.25 / largest));
  Profile unworn, worn, journal;
  constexpr int steps = 120;
  for (int i = 0; i <= steps; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / steps - 0.5);
    const double across = down * std::sin(angle);
    const double surface =
        down * std::cos(angle) + std::sqrt(worn_radius * worn_radius - across * across);
    const double wall = duty.contact == Contact::stationary ? std::max(bore, surface) : worn_bore;
    unworn.add(angle, 0, factor);
    worn.add(angle, wall / bore - 1, factor);
    journal.add(angle, surface / bore - 1, factor);
  }
  const std::vector<plot::Json> marks = {
      plot::line({{"x", unworn.x}, {"y", unworn.y}},
                 {colour::prior, "bore when new", 1, 1.5, true}),
      plot::line({{"x", worn.x}, {"y", worn.y}}, {colour::measured, "bore now", 1, 3}),
      plot::line({{"x", journal.x}, {"y", journal.y}}, {colour::posterior, "journal", 1, 1.5})};
  html::Figure figure{
      "scar", "The worn bearing",
      fmt::format("To scale, except that deviations from the new bore are exaggerated {} times. "
                  "After {} revolutions at the median k: {} deep, contact {}.",
                  html::given(factor), html::number(duty.revolutions),
                  html::quantity(from_si(unit, depth), unit.text, 3),
                  bearing::contact_name(duty.contact)),
      plot::plot("Cross-section of the worn bearing, lower half",
                 {"Across, in bore radii", false, -1.3, 1.3},
                 {"Along the load, in bore radii", false, -1.35, 0.05}, marks, 190)};
  figure.specification["width"] = 340;  // one scale for both axes
  return figure;
}

}  // namespace

void add_bearing_history(const bearing::WearModel& model, const BearingData& data,
                         const PredictedBearing& drawn, double k, PosteriorStudy& study) {
  constexpr int points = 24;
  Duty duty = drawn.duty;
  for (std::size_t i = 0; i < data.inspections.depth.size(); ++i) {
    study.history_at.push_back(loading(data.inspections.duty[i]) / duty.pressure);
  }
  const double end =
      1.05 * std::max(drawn.duty.revolutions,
                      *std::max_element(study.history_at.begin(), study.history_at.end()));
  for (int i = 0; i <= points; ++i) {
    duty.revolutions = end * std::max<double>(i, 1e-3) / points;
    study.history.push_back(depth_request(model, data, duty, k, {}));
  }
  study.history_note = fmt::format(
      "For {} contact, radius {}, clearance {}, pressure {}; each inspection is placed at the "
      "revolutions that give its load at this pressure, for any clearance.",
      bearing::contact_name(duty.contact),
      html::quantity(from_si(data.depth_unit, duty.radius), data.depth_unit.text),
      html::quantity(from_si(data.depth_unit, duty.clearance), data.depth_unit.text),
      html::quantity(from_si(data.pressure_unit, duty.pressure), data.pressure_unit.text));
}

std::map<std::string, std::vector<html::Figure>> bearing_figures(const BearingData& data,
                                                                 const PredictedBearing& drawn,
                                                                 const Fit& fit) {
  const QuantityDistribution k(fit.exact ? fit.exact->nodes : fit.pooled,
                               [](const double* x) { return x[0]; });
  return {{"predictions",
           {scar_figure(data.depth_unit, drawn.duty, depth_at(drawn.duty, k.quantile(0.5)))}},
          {"fit", {chart_figure(data, drawn, k)}}};
}

}  // namespace wearwell
