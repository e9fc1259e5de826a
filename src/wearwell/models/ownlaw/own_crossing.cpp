#include "wearwell/models/ownlaw/own_crossing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace wearwell::ownlaw {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace

Crossing::Crossing(const Path& path, bool rising, double begin, double scale)
    : at_(path),
      effects_(path.law->effects.size()),
      rising_(rising),
      begin_(path.goes_on() ? path.running->begin : begin),
      scale_(scale) {}

// Outward from the scale until the level is passed, then within that by the rule of false position with
// halved ends (Dowell and Jarratt 1971): of a straight path it is there at once.
void Crossing::solve(std::size_t count, const double* z, const double* level, double* place) {
  constexpr int most_outward = 60, most_inward = 120;
  double low[Path::most] = {}, high[Path::most] = {}, at_low[Path::most] = {};
  double at_high[Path::most] = {}, trial[Path::most] = {};
  std::uint8_t state[Path::most] = {};  // 0 looks outward, 1 inward, 2 is done
  int side[Path::most] = {};
  const auto excess = [&](std::size_t i) {
    const double y = at_.output(0, i) - level[i];
    return rising_ ? y : -y;
  };
  at_.stand(count, z);
  std::fill_n(trial, count, begin_);
  at_.evaluate(count, z, trial);
  for (std::size_t i = 0; i < count; ++i) {
    low[i] = begin_;
    at_low[i] = ahead_[i] = excess(i);
    state[i] = at_low[i] >= 0 ? 2 : 0;
    place[i] = begin_;
    trial[i] = begin_ + scale_;
    // A path may be no number at its very beginning: log 0.
    if (std::isnan(at_low[i]) || at_low[i] == -infinity) at_low[i] = -infinity;
  }
  for (int step = 0; step < most_outward + most_inward; ++step) {
    if (std::all_of(state, state + count, [](auto s) { return s == 2; })) return;
    at_.evaluate(count, z, trial);
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
          trial[i] = begin_ + (trial[i] - begin_) * (step < 10 ? 2 : 8);
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

}  // namespace wearwell::ownlaw
