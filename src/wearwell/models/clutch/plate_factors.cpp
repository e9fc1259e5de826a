#include "wearwell/models/clutch/plate_factors.h"

#include <algorithm>
#include <cmath>
#include <functional>

namespace wearwell::clutch {
namespace {

/// Root of the expected square of a further plate's factor: the scatter of factors, with its
/// uncertainty, and the error of the mean of the plates. The factors' sum is 0, which costs one
/// degree of freedom (as in restricted maximum likelihood).
double new_plate_sd(const RunInFit& fit, const std::function<double(int)>& sd_at, int steps) {
  const auto plates = static_cast<double>(fit.plates.size());
  const double kept = 1 - 1 / plates;
  std::vector<double> log_density;
  for (int i = 0; i < steps; ++i) {
    double sum = 0;
    for (const PlateFactor& p : fit.plates) {
      const double variance = kept * sd_at(i) * sd_at(i) + p.standard_error * p.standard_error;
      sum -= 0.5 * (std::log(variance) + p.log_factor * p.log_factor / variance);
    }
    log_density.push_back(kept * sum);
  }
  const double most = *std::max_element(log_density.begin(), log_density.end());
  double mass = 0, square = 0;
  for (int i = 0; i < steps; ++i) {
    const double weight = std::exp(log_density[static_cast<std::size_t>(i)] - most);
    mass += weight;
    square += weight * sd_at(i) * sd_at(i);
  }
  return std::sqrt(square / mass * (1 + 1 / plates));
}

}  // namespace

void shrink_factors(RunInFit& fit) {
  for (PlateFactor& p : fit.plates) p.shrunk_sd = p.standard_error;
  if (fit.plates.size() < 3) return;  // the posterior of plate_sd would be improper
  double largest = 0;
  for (const PlateFactor& p : fit.plates)
    largest = std::max({largest, std::abs(p.log_factor), p.standard_error});
  constexpr int steps = 400;
  std::vector<double> log_density;
  const auto sd_at = [&](int i) { return 5 * largest * (i + 0.5) / steps; };
  for (int i = 0; i < steps; ++i) {
    double sum = 0;
    for (const PlateFactor& p : fit.plates) {
      const double variance = sd_at(i) * sd_at(i) + p.standard_error * p.standard_error;
      sum -= 0.5 * (std::log(variance) + p.log_factor * p.log_factor / variance);
    }
    log_density.push_back(sum);
  }
  const double most = *std::max_element(log_density.begin(), log_density.end());
  double mass = 0;
  std::vector<double> mean(fit.plates.size(), 0), square(fit.plates.size(), 0);
  for (int i = 0; i < steps; ++i) {
    const double weight = std::exp(log_density[static_cast<std::size_t>(i)] - most);
    const double variance = sd_at(i) * sd_at(i);
    mass += weight;
    for (std::size_t j = 0; j < fit.plates.size(); ++j) {
      const double error = fit.plates[j].standard_error * fit.plates[j].standard_error;
      const double kept = variance / (variance + error);
      const double expected = kept * fit.plates[j].log_factor;
      mean[j] += weight * expected;
      square[j] += weight * (kept * error + expected * expected);
    }
  }
  fit.plate_sd = new_plate_sd(fit, sd_at, steps);
  for (std::size_t j = 0; j < fit.plates.size(); ++j) {
    fit.plates[j].shrunk = mean[j] / mass;
    fit.plates[j].shrunk_sd =
        std::sqrt(square[j] / mass - fit.plates[j].shrunk * fit.plates[j].shrunk);
  }
}

}  // namespace wearwell::clutch
