#include "wearwell/models/fatigue/mean_stress.h"

#include <algorithm>

#include "wearwell/math/constants.h"
#include "wearwell/math/root.h"

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

std::string_view strength_name(MeanStress correction) {
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
  // Solved for the smaller of a and mean + a, which both grow with a: it lies between 0 and
  // `reversed`.
  const double between = std::abs(mean), power = mean > 0 ? gamma : 1 - gamma;
  const auto excess = [&](double t) {
    return power * std::log(t) + (1 - power) * std::log(t + between) - std::log(reversed);
  };
  // By its logarithm: it may be smaller by any number of decades.
  const double highest = std::log(reversed), lowest = std::log(std::numeric_limits<double>::min());
  const double root = solve_increasing([&](double log_t) { return excess(std::exp(log_t)); },
                                       highest - 0.5, 0.5, {.absolute = 1e-14}, lowest, highest);
  return (mean > 0 ? 0 : -mean) + (root == lowest ? 0 : std::exp(root));
}

}  // namespace

double alternating_stress(MeanStress correction, double reversed, const StressLine& line,
                          double strength, double gamma) {
  const double mean = line.mean;
  // Mean over alternating stress, if that ratio is constant.
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
