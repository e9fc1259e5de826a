#include "wearwell/models/bearing/depth_function.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "wearwell/models/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

constexpr double nodes_per_unit = 64;
// If bearings vary, a posterior extends far below its median.
constexpr double reach_below = 40, logarithms_per_unit = 24;
constexpr double lowest = -600;  // depths below 1e-170 radii, where solving would underflow

// Just below the wear numbers that no delta reaches (see depth_for).
double largest_log_wear_number(Contact contact) {
  constexpr double short_of = 0.9999;
  switch (contact) {
    case Contact::stationary:
      return std::log(short_of * 0.25);
    case Contact::journal:
      return std::log(short_of * 0.75);
    case Contact::bushing:
      break;
  }
  return std::log(std::numeric_limits<double>::max()) / 2;
}

// The range where the table meets its error bound: near its limit the stationary contact's depth
// grows without bound.
double end_of_table(Contact contact, double limit) {
  return contact == Contact::stationary ? std::log(0.1) : limit;
}

}  // namespace

DepthCurve::DepthCurve(Contact contact, double sigma, double from, double to)
    : contact_(contact),
      sigma_(sigma),
      limit_(largest_log_wear_number(contact)),
      table_(from, std::min(to, end_of_table(contact, limit_)), nodes_per_unit,
             [this](double x) { return solve(x); }),
      logarithms_(std::max(from - reach_below, 0.9 * lowest),
                  std::min(from + 2 / logarithms_per_unit, end_of_table(contact, limit_)),
                  logarithms_per_unit, [this](double x) {
                    const Point point = solve(x);
                    return Point{std::log(point.value), point.slope / point.value};
                  }) {}

DepthCurve::Point DepthCurve::operator()(double x) const {
  if (table_.covers(x)) return table_(x);
  if (!logarithms_.covers(x)) return solve(x);
  const Point logarithm = logarithms_(x);
  const double delta = std::exp(logarithm.value);
  return {delta, delta * logarithm.slope};
}

DepthCurve::Point DepthCurve::solve(double x) const {
  if (!(x > lowest)) return {0, 0};
  const double w = std::exp(x);
  const double delta = depth_for(contact_, sigma_, w);
  if (!(delta > 0)) return {0, 0};  // w has underflowed
  return {delta, w / wear_number_and_derivatives(contact_, sigma_, delta).d_delta};
}

std::vector<DepthFunction> depth_functions(const std::vector<Duty>& duties, double k) {
  constexpr double below = 10, above = 6;
  struct Range {
    double from = std::numeric_limits<double>::infinity(), to = -from;
    std::shared_ptr<const DepthCurve> curve;
  };
  const auto kind = [](const Duty& d) { return std::pair(d.contact, d.clearance / d.radius); };
  std::map<std::pair<Contact, double>, Range> ranges;
  for (const Duty& duty : duties) {
    const double log_wear = std::log(k * duty.pressure * duty.revolutions);
    Range& range = ranges[kind(duty)];
    range.from = std::min(range.from, log_wear);
    range.to = std::max(range.to, log_wear);
  }
  for (auto& [key, range] : ranges) {
    range.curve =
        std::make_shared<DepthCurve>(key.first, key.second, range.from - below, range.to + above);
  }
  std::vector<DepthFunction> curves;
  for (const Duty& duty : duties) {
    curves.push_back(
        {ranges[kind(duty)].curve, duty.radius, std::log(duty.pressure * duty.revolutions)});
  }
  return curves;
}

}  // namespace wearwell::bearing
