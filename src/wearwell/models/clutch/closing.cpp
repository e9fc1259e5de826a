#include "wearwell/models/clutch/closing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

/// The median time step between samples of one plate.
double median_step(const std::vector<Sample>& samples) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].plate == samples[i - 1].plate)
      steps.push_back(samples[i].time - samples[i - 1].time);
  }
  if (steps.empty()) return 0;
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

void check_time(const std::vector<Sample>& samples) {
  for (std::size_t i = 1; i < samples.size(); ++i) {
    if (samples[i].plate == samples[i - 1].plate && !(samples[i].time > samples[i - 1].time))
      throw InputError(fmt::format("row {}: time {} s follows {} s; it must ascend", i + 1,
                                   samples[i].time, samples[i - 1].time));
  }
}

/// First and last sample, both part of the closing.
Closing measure(const std::vector<Sample>& samples, std::size_t first, std::size_t last,
                double longest_step, const ClosingRule& rule) {
  Closing closing;
  OperatingPoint& at = closing.cycle.at;
  closing.cycle.plate = samples[first].plate;
  closing.start = samples[first].time;
  at.slip_speed = samples[first].slip_speed;
  at.closing_time = samples[last].time - samples[first].time;
  double torque = 0, temperature = 0;
  for (std::size_t i = first; i <= last; ++i) {
    if (samples[i].torque < -rule.torque_on) closing.flag = "torque of the wrong sign";
    if (i == first) continue;
    const double step = samples[i].time - samples[i - 1].time;
    if (step > longest_step && closing.flag.empty()) closing.flag = "gap";
    closing.cycle.energy += samples[i].torque * samples[i].slip_speed * step;
    torque += samples[i].torque * step;
    temperature += samples[i].temperature * step;
  }
  if (at.closing_time > 0) {
    at.torque = torque / at.closing_time;
    at.temperature = temperature / at.closing_time;
  }
  return closing;
}

}  // namespace

std::vector<Closing> find_closings(const std::vector<Sample>& samples, const ClosingRule& rule) {
  if (!(rule.torque_on >= 0 && rule.slip_off >= 0 && rule.longest_gap > 0))
    throw InputError("the torque and the slip speed of a closing must not be negative");
  check_time(samples);
  const double longest_step = rule.longest_gap * median_step(samples);
  std::map<int, long long> count;
  std::vector<Closing> closings;
  for (std::size_t i = 0; i < samples.size();) {
    const bool on = std::abs(samples[i].torque) > rule.torque_on;
    if (!on || samples[i].slip_speed <= rule.slip_off) {
      ++i;
      continue;
    }
    const std::size_t first = i;
    const int plate = samples[i].plate;
    const auto goes_on = [&](std::size_t at) {
      return at < samples.size() && samples[at].plate == plate &&
             samples[at].slip_speed > rule.slip_off &&
             std::abs(samples[at].torque) > rule.torque_on;
    };
    while (goes_on(i)) ++i;
    const bool closed =
        i < samples.size() && samples[i].plate == plate && samples[i].slip_speed <= rule.slip_off;
    Closing closing = measure(samples, first, closed ? i : i - 1, longest_step, rule);
    if (!closed && closing.flag.empty()) closing.flag = "never closes";
    closing.cycle.number = ++count[plate];
    closings.push_back(std::move(closing));
  }
  return closings;
}

}  // namespace wearwell::clutch
