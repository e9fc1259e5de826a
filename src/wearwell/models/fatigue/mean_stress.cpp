#include "wearwell/models/fatigue/mean_stress.h"

#include <algorithm>
#include <boost/math/tools/roots.hpp>

namespace wearwell::fatigue {

const std::vector<std::string>& mean_stress_names() {
  static const std::vector<std::string> names = {"none",   "goodman", "gerber", "soderberg",
                                                 "morrow", "swt",     "walker"};
  return names;
}

std::optional<MeanStress> mean_stress_named(const std::string& name) {
  const auto& names = mean_stress_names();
  const auto at = std::find(names.begin(), names.end(), name);
  if (at == names.end()) return {};
  return static_cast<MeanStress>(at - names.begin());
}

std::string strength_name(MeanStress correction) {
  switch (correction) {
    case MeanStress::goodman:
    case MeanStress::gerber:
      return "S_ut";
    case MeanStress::soderberg:
      return "S_y";
    case MeanStress::morrow:
      return "sigma_f";
    case MeanStress::none:
    case MeanStress::swt:
    case MeanStress::walker:
      break;
  }
  return {};
}

namespace {

// (mean + a)^(1 - gamma) a^gamma = reversed, for a.
double walker_at_mean(double reversed, double mean, double gamma) {
  if (gamma == 1) return reversed;
  if (gamma == 0) return std::max(0.0, reversed - mean);
  // Solved for the smaller of a and mean + a, which both grow with a: it lies between 0 and `reversed`.
  const double between = std::abs(mean), power = mean > 0 ? gamma : 1 - gamma;
  const auto excess = [&](double t) {
    return power * std::log(t) + (1 - power) * std::log(t + between) - std::log(reversed);
  };
  double low = reversed, high = reversed;
  constexpr int most_halvings = 2200;  // from the largest double to the smallest
  for (int i = 0; i < most_halvings && excess(low) > 0 && low > 0; ++i) low *= 0.5;
  const double other_end = mean > 0 ? 0 : -mean;
  if (low == 0 || low == high) return other_end + low;  // at an end, but for rounding
  if (!(excess(low) <= 0 && excess(high) >= 0)) return std::nan("");  // something is no number
  std::uintmax_t iterations = 200;
  const auto [left, right] = boost::math::tools::toms748_solve(
      excess, low, high, boost::math::tools::eps_tolerance<double>(45), iterations);
  return other_end + 0.5 * (left + right);
}

}  // namespace

double alternating_stress(MeanStress correction, double reversed, const StressLine& line,
                          double strength, double gamma) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double mean = line.mean;
  // Mean over alternating stress, where that is what stays.
  const double slope = line.ratio ? (1 + *line.ratio) / (1 - *line.ratio) : 0;
  switch (correction) {
    case MeanStress::none:
      break;
    case MeanStress::goodman:
    case MeanStress::soderberg:
    case MeanStress::morrow:
      if (line.ratio) {
        const double share = 1 + slope * reversed / strength;
        return share > 0 ? reversed / share : infinity;
      }
      return reversed * std::max(0.0, 1 - mean / strength);
    case MeanStress::gerber:
      if (line.ratio) {
        if (slope <= 0) break;
        const double bend = slope * reversed / strength;
        return 2 * reversed / (1 + std::sqrt(1 + 4 * bend * bend));
      }
      if (mean <= 0) break;
      return reversed * std::max(0.0, 1 - mean * mean / (strength * strength));
    case MeanStress::swt:
      if (line.ratio) return reversed / std::sqrt(1 + slope);
      return mean > 0 ? 2 * reversed * reversed / (mean + std::hypot(mean, 2 * reversed))
                      : 0.5 * (std::hypot(mean, 2 * reversed) - mean);
    case MeanStress::walker:
      if (line.ratio) return reversed / std::pow(1 + slope, 1 - gamma);
      return mean == 0 ? reversed : walker_at_mean(reversed, mean, gamma);
  }
  return reversed;
}

}  // namespace wearwell::fatigue
