#include "wearwell/models/fatigue/level_crossings.h"

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {
namespace {

constexpr int first_exponent = -8;  // finer than the first excursion
constexpr double most_index = 1e15;

long long halved(long long level) {
  return level >= 0 ? (level + 1) / 2 : level / 2;  // the first even one from there, halved
}

}  // namespace

long long LevelCrossings::above(double value) const {
  return static_cast<long long>(std::floor(value / state_.width)) + 1;
}

void LevelCrossings::add(double from, double to) {
  const double low = std::min(from, to), high = std::max(from, to);
  if (state_.width == 0) {
    const double unit = state_.wanted > 0 ? state_.wanted : 1;
    state_.width = std::ldexp(unit, std::ilogb((high - low) / unit) + first_exponent);
    if (state_.wanted > 0) state_.width = std::min(state_.width, state_.wanted);
    while (std::max(std::abs(low), std::abs(high)) > most_index * state_.width) state_.width *= 2;
    state_.first = above(low);
  }
  long long first = above(low), end = above(high);
  const auto fits = [&] {
    const long long last = std::max(state_.first + std::ssize(state_.up), end + 1);
    return last - std::min(state_.first, first) <= static_cast<long long>(most_levels) &&
           std::max(std::abs(low), std::abs(high)) < most_index * state_.width;
  };
  while (!fits()) {
    widen();
    first = above(low);
    end = above(high);
  }
  make_room(first);
  make_room(end);
  std::vector<long long>& counts = to > from ? state_.up : state_.down;
  ++counts[static_cast<std::size_t>(first - state_.first)];
  --counts[static_cast<std::size_t>(end - state_.first)];
}

void LevelCrossings::make_room(long long level) {
  if (level < state_.first) {
    const auto more = static_cast<std::size_t>(state_.first - level);
    state_.up.insert(state_.up.begin(), more, 0);
    state_.down.insert(state_.down.begin(), more, 0);
    state_.first = level;
  }
  const auto size = static_cast<std::size_t>(level - state_.first) + 1;
  if (state_.up.size() < size) {
    state_.up.resize(size, 0);
    state_.down.resize(size, 0);
  }
}

void LevelCrossings::widen() {
  const State before = std::move(state_);
  state_ = {before.wanted, 2 * before.width, halved(before.first), {}, {}};
  if (before.up.empty()) return;
  make_room(halved(before.first + std::ssize(before.up) - 1));
  for (std::size_t i = 0; i < before.up.size(); ++i) {
    const auto to =
        static_cast<std::size_t>(halved(before.first + static_cast<long long>(i)) - state_.first);
    state_.up[to] += before.up[i];
    state_.down[to] += before.down[i];
  }
}

std::vector<LevelCrossings::Level> LevelCrossings::levels(double width) const {
  LevelCrossings wide(state_);
  while (wide.state_.width > 0 && wide.state_.width < 0.75 * width) wide.widen();
  std::vector<Level> levels;
  long long up = 0, down = 0;
  for (std::size_t i = 0; i < wide.state_.up.size(); ++i) {
    up += wide.state_.up[i];
    down += wide.state_.down[i];
    if (up == 0 && down == 0) continue;
    const long long level = wide.state_.first + static_cast<long long>(i);
    levels.push_back({static_cast<double>(level) * wide.state_.width, up, down});
  }
  return levels;
}

}  // namespace wearwell::fatigue
