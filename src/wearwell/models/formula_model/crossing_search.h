#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "wearwell/math/constants.h"

namespace wearwell::formula_model {

inline constexpr std::size_t most_crossings = 128;  ///< of one search

/// First position from `begin` on where each of `count` rising (or falling) functions reaches its
/// level, with a first guess of `scale`: infinite if it never does, `begin` if it has already.
/// `evaluate(places)` computes all of them, each at its own position; `output(i)` is its result.
/// `ahead` takes the excess of each over its level at `begin` (negative: not yet reached).
///
/// Expands from the scale until the level is passed, then applies the Illinois variant of false
/// position (Dowell and Jarratt 1971), which is exact for a straight path in one step.
template <class Evaluate, class Output>
void search_crossings(bool rising, double begin, double scale, std::size_t count,
                      const double* level, const Evaluate& evaluate, const Output& output,
                      double* place, double* ahead) {
  constexpr int most_outward = 60, most_inward = 120;
  constexpr std::size_t most = most_crossings;
  double low[most] = {}, high[most] = {}, at_low[most] = {};
  double at_high[most] = {}, trial[most] = {};
  std::uint8_t state[most] = {};  // 0 brackets, 1 refines, 2 is done
  int side[most] = {};
  const auto excess = [&](std::size_t i) {
    const double y = output(i) - level[i];
    return rising ? y : -y;
  };
  std::fill_n(trial, count, begin);
  evaluate(trial);
  for (std::size_t i = 0; i < count; ++i) {
    low[i] = begin;
    at_low[i] = ahead[i] = excess(i);
    state[i] = at_low[i] >= 0 ? 2 : 0;
    place[i] = begin;
    trial[i] = begin + scale;
    // A path may be NaN or infinite at its start: log 0.
    if (std::isnan(at_low[i]) || at_low[i] == -infinity) at_low[i] = -infinity;
  }
  for (int step = 0; step < most_outward + most_inward; ++step) {
    if (std::all_of(state, state + count, [](auto s) { return s == 2; })) return;
    evaluate(trial);
    for (std::size_t i = 0; i < count; ++i) {
      if (state[i] == 2) continue;
      const double y = excess(i);
      if (std::isnan(y)) {
        place[i] = y;
        state[i] = 2;
        continue;
      }
      if (state[i] == 0) {
        if (y >= 0) {
          high[i] = trial[i];
          at_high[i] = y;
          state[i] = 1;
        } else if (step >= most_outward) {
          place[i] = infinity;
          state[i] = 2;
          continue;
        } else {
          low[i] = trial[i];
          at_low[i] = y;
          trial[i] = begin + (trial[i] - begin) * (step < 10 ? 2 : 8);
          continue;
        }
      } else if (y >= 0) {
        high[i] = trial[i];
        at_high[i] = y;
        if (side[i] == 1) at_low[i] *= 0.5;
        side[i] = 1;
      } else {
        low[i] = trial[i];
        at_low[i] = y;
        if (side[i] == -1) at_high[i] *= 0.5;
        side[i] = -1;
      }
      const double size = std::max(std::abs(low[i]), std::abs(high[i]));
      if (y == 0 || high[i] - low[i] <= 1e-11 * size || std::abs(y) <= 1e-13 * std::abs(level[i])) {
        place[i] = trial[i];
        state[i] = 2;
        continue;
      }
      double next = std::isfinite(at_low[i])
                        ? low[i] - at_low[i] * (high[i] - low[i]) / (at_high[i] - at_low[i])
                        : 0.5 * (low[i] + high[i]);
      if (!(next > low[i] && next < high[i]) || step % 8 == 7) next = 0.5 * (low[i] + high[i]);
      if (!(next > low[i] && next < high[i])) {
        place[i] = high[i];
        state[i] = 2;
        continue;
      }
      trial[i] = next;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (state[i] == 1) place[i] = 0.5 * (low[i] + high[i]);
    if (state[i] == 0) place[i] = infinity;
  }
}

}  // namespace wearwell::formula_model
