#include "wearwell/bearing/depth_law.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/bearing/wear_number.h"

namespace wearwell::bearing {
namespace {

constexpr double nodes_per_unit = 64;

// Just short of the wear numbers that no delta reaches (see depth_for).
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

}  // namespace

DepthCurve::DepthCurve(Contact contact, double sigma, double from, double to)
    : contact_(contact),
      sigma_(sigma),
      limit_(largest_log_wear_number(contact)),
      table_(from, std::min(to, limit_), nodes_per_unit, [this](double x) { return solve(x); }) {}

DepthCurve::Point DepthCurve::operator()(double x) const {
  return table_.covers(x) ? table_(x) : solve(x);
}

DepthCurve::Point DepthCurve::solve(double x) const {
  const double w = std::exp(x);
  const double delta = depth_for(contact_, sigma_, w);
  if (!(delta > 0)) return {0, 0};  // w has underflown
  return {delta, w / wear_number_and_derivatives(contact_, sigma_, delta).d_delta};
}

std::vector<DepthLaw> depth_laws(const std::vector<Duty>& duties, double k) {
  constexpr double reach = 6;
  const auto log_wear = [k](const Duty& d) { return std::log(k * d.pressure * d.revolutions); };
  std::vector<DepthLaw> laws;
  for (std::size_t i = 0; i < duties.size(); ++i) {
    const Duty& duty = duties[i];
    const double sigma = duty.clearance / duty.radius;
    const auto same = [&](const Duty& other) {
      return other.contact == duty.contact && other.clearance / other.radius == sigma;
    };
    const auto first =
        static_cast<std::size_t>(std::find_if(duties.begin(), duties.end(), same) - duties.begin());
    std::shared_ptr<const DepthCurve> curve;
    if (first < i) {
      curve = laws[first].curve;
    } else {
      double from = log_wear(duty), to = from;
      for (const Duty& other : duties) {
        if (!same(other)) continue;
        from = std::min(from, log_wear(other));
        to = std::max(to, log_wear(other));
      }
      curve = std::make_shared<DepthCurve>(duty.contact, sigma, from - reach, to + reach);
    }
    laws.push_back({curve, duty.radius, std::log(duty.pressure * duty.revolutions)});
  }
  return laws;
}

}  // namespace wearwell::bearing
