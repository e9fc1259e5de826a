#include "wearwell/infer/copied_rows.h"

#include <algorithm>
#include <boost/math/distributions/poisson.hpp>
#include <cmath>
#include <numeric>

#include "wearwell/base/rng.h"
#include "wearwell/base/stop_scope.h"

namespace wearwell {
namespace {

constexpr double most_of_all = 0.8;
constexpr double rounding = 1e-9;  // relative rounding of a conversion to SI and back
constexpr std::size_t fewest_values = 3;

bool is_multiple(double value, double step) {
  const double times = value / step;
  return std::abs(times - std::round(times)) < std::max(rounding * std::abs(times), 1e-6);
}

double remainder_step(double a, double b) {
  const double zero = 1e-7 * std::max(a, b);
  while (b > zero) {
    double rest = std::fmod(a, b);
    if (b - rest < zero) rest = 0;
    a = b;
    b = rest;
  }
  return a;
}

bool most(const std::vector<double>& values, const auto& holds) {
  check_stop();
  const auto count = std::count_if(values.begin(), values.end(), holds);
  return static_cast<double>(count) >= most_of_all * static_cast<double>(values.size());
}

// The largest step of which most values are multiples, from common divisors of three values.
double common_step(const std::vector<double>& values) {
  constexpr int tries = 60;
  constexpr std::uint64_t seed = 20261124;
  Rng rng(seed, 1);
  const auto any = [&] {
    return std::abs(
        values[static_cast<std::size_t>(rng.uniform() * static_cast<double>(values.size()))]);
  };
  double largest = 0;
  for (int i = 0; i < tries; ++i) {
    const double step = remainder_step(remainder_step(any(), any()), any());
    if (step > largest && most(values, [&](double v) { return is_multiple(v, step); }))
      largest = step;
  }
  return largest;
}

// The unit of the last of the given significant digits of a value.
double last_digit(double value, int digits) {
  return std::pow(10, std::floor(std::log10(std::abs(value)) + rounding) - digits + 1);
}

int significant_digits(const std::vector<double>& values) {
  constexpr int in_a_double = 15;
  for (int digits = 1; digits < in_a_double; ++digits) {
    if (most(values, [&](double v) { return is_multiple(v, last_digit(v, digits)); }))
      return digits;
  }
  return in_a_double;
}

// Observations sorted by conditions, then by value.
struct Alike {
  const FitData& data;

  int compare(std::size_t a, std::size_t b) const {
    const auto order = [](const auto& x, const auto& y) { return x < y ? -1 : y < x ? 1 : 0; };
    for (const Driver& driver : data.drivers) {
      if (const int c = order(driver.value[a], driver.value[b])) return c;
    }
    for (const Label& label : data.labels) {
      if (const int c = order(label.level[a], label.level[b])) return c;
    }
    if (!data.unit.empty() && data.unit[a] != data.unit[b])
      return order(data.unit[a], data.unit[b]);
    return data.column.empty() ? 0 : order(data.column[a], data.column[b]);
  }
};

}  // namespace

std::optional<CopiedRows> copied_rows(const FitData& data, const std::vector<double>& log_density) {
  const std::vector<double>& value = data.measured.value;
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < value.size(); ++i) {
    if (std::isfinite(value[i]) && value[i] != 0 && (data.counts.empty() || data.counts[i] == 1))
      order.push_back(i);
  }
  const Alike alike{data};
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    check_stop();
    const int c = alike.compare(a, b);
    return c != 0 ? c < 0 : value[a] < value[b];
  });
  CopiedRows found;
  found.of = order.size();
  std::vector<double> repeated;
  const auto same = [&](std::size_t i) {
    return alike.compare(order[i - 1], order[i]) == 0 && value[order[i - 1]] == value[order[i]];
  };
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (!same(i)) continue;
    ++found.rows;
    if (i < 2 || !same(i - 1)) repeated.push_back(value[order[i]]);
  }
  std::sort(repeated.begin(), repeated.end());
  repeated.erase(std::unique(repeated.begin(), repeated.end()), repeated.end());
  if (repeated.size() < fewest_values) return std::nullopt;
  const double step = common_step(repeated);
  const int digits = significant_digits(repeated);
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && alike.compare(order[begin], order[end]) == 0) ++end;
    const double others = static_cast<double>(end - begin) - 1;
    for (std::size_t i = begin; i < end && others > 0; ++i) {
      const std::size_t at = order[i];
      const double width = std::max(step, last_digit(value[at], digits)) * data.measured.unit[at];
      found.expected += 0.5 * others * std::min(1.0, std::exp(log_density[at]) * width);
    }
    begin = end;
  }
  constexpr double doubt = 2;  // uncertainty factor of the density
  const double expected = std::max(doubt * found.expected, 1e-300);
  const boost::math::poisson distribution(expected);
  found.p =
      boost::math::cdf(boost::math::complement(distribution, static_cast<double>(found.rows) - 1));
  return found;
}

}  // namespace wearwell
