#include "wearwell/prognosis/change_cause.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "wearwell/present/number.h"

namespace wearwell::prognosis {
namespace {

using Since = std::span<const ReadingSince>;

constexpr double most_cost = 25;  // of one deviation, in squares of its spread
constexpr double near = 4;        // spreads: within them a reading agrees
constexpr double parameter = 6;   // the cost of an estimated number
constexpr double choice = 5.3;    // of one of fourteen factors, 2 ln 14

// Units that are taken for each other.
struct UnitPair {
  double factor;
  const char *larger, *smaller;
};
constexpr std::array unit_pairs = {UnitPair{1e6, "m", "um"},  UnitPair{25400, "inches", "um"},
                                   UnitPair{1e4, "cm", "um"}, UnitPair{1000, "mm", "um"},
                                   UnitPair{100, "m", "cm"},  UnitPair{25.4, "inches", "mm"},
                                   UnitPair{10, "cm", "mm"}};
constexpr std::array<double, unit_factor_count> factors = [] {
  static_assert(unit_factor_count == 2 * unit_pairs.size());
  std::array<double, unit_factor_count> all{};
  for (std::size_t i = 0; i < unit_pairs.size(); ++i) {
    all[i] = unit_pairs[i].factor;
    all[all.size() - 1 - i] = 1 / unit_pairs[i].factor;
  }
  return all;
}();

double cost(double deviation, double spread) {
  const double z = deviation / spread;
  return std::min(z * z, most_cost) + 2 * std::log(spread);
}

double unchanged(Since part) {
  double sum = 0;
  for (const ReadingSince& each : part) sum += cost(each.measured - each.expected, each.spread);
  return sum;
}

/// Whether three quarters of the readings agree with what a cause expects.
template <class Expected>
bool most_agree(Since part, const Expected& expected) {
  const auto agree = std::count_if(part.begin(), part.end(), [&](const ReadingSince& each) {
    return std::abs(each.measured - expected(each)) <= near * each.spread;
  });
  return 4 * static_cast<std::size_t>(agree) >= 3 * part.size();
}

/// The best cause so far.
struct Best {
  ChangeCause cause;
  double cost = std::numeric_limits<double>::infinity();

  void offer(const ChangeCause& other, double its_cost) {
    if (its_cost < cost) *this = {other, its_cost};
  }
};

// A unit may be noisier than the forecast of its population, before and after: then its scatter is estimated, too.
void try_factors(Since part, std::size_t first, double before, Best& best) {
  constexpr double most_scatter = 5;  // spreads
  const bool off = std::any_of(part.begin(), part.end(), [](const ReadingSince& each) {
    return std::abs(each.measured - each.expected) > near * each.spread;
  });
  if (!off) return;
  for (const double factor : factors) {
    double square = 0, largest = 0, logarithms = 0;
    for (const ReadingSince& each : part) {
      const double deviation = factor * (each.measured - each.added) - (each.expected - each.added);
      square += std::pow(deviation / each.spread, 2);
      largest = std::max(largest, std::abs(deviation / each.spread));
      logarithms += 2 * std::log(each.spread / factor);
    }
    const auto count = static_cast<double>(part.size());
    const ChangeCause cause{ChangeKind::factor, first, factor, factor < 1};
    if (largest <= near) best.offer(cause, before + choice + square + logarithms);
    const double scatter = std::sqrt(square / count);
    if (part.size() < 3 || !(scatter > 1) || scatter > most_scatter || largest > near * scatter)
      continue;
    best.offer(cause,
               before + choice + parameter + logarithms + count * (1 + 2 * std::log(scatter)));
  }
}

void try_step(Since part, std::size_t first, double before, Best& best) {
  double weight = 0, sum = 0;
  for (const ReadingSince& each : part) {
    const double w = 1 / (each.spread * each.spread);
    weight += w;
    sum += w * (each.measured - each.expected);
  }
  const double step = sum / weight;
  double all = before + parameter;
  for (const ReadingSince& each : part)
    all += cost(each.measured - each.expected - step, each.spread);
  if (!most_agree(part, [&](const ReadingSince& each) { return each.expected + step; })) return;
  best.offer({ChangeKind::step, first, step, step > 0}, all);
}

void try_rate(Since part, std::size_t first, double from, double before, Best& best) {
  double square = 0, product = 0;
  for (const ReadingSince& each : part) {
    const double w = 1 / (each.spread * each.spread), x = each.at - from;
    square += w * x * x;
    product += w * x * (each.measured - each.expected);
  }
  if (!(square > 0)) return;
  const double rate = product / square;
  double all = before + parameter;
  for (const ReadingSince& each : part)
    all += cost(each.measured - each.expected - rate * (each.at - from), each.spread);
  if (!most_agree(
          part, [&](const ReadingSince& each) { return each.expected + rate * (each.at - from); }))
    return;
  const double way = part.back().at - part.front().at;
  const double old = way > 0 ? (part.back().expected - part.front().expected) / way : 0;
  best.offer({ChangeKind::rate, first, old > 0 ? (old + rate) / old : 0, rate > 0}, all);
}

void try_scatter(Since part, std::size_t first, double before, Best& best) {
  const auto count = static_cast<double>(part.size());
  double square = 0, logarithms = 0;
  for (const ReadingSince& each : part) {
    square += std::pow((each.measured - each.expected) / each.spread, 2) / count;
    logarithms += 2 * std::log(each.spread);
  }
  const bool both = std::any_of(part.begin(), part.end(),
                                [](const ReadingSince& each) {
                                  return each.measured > each.expected + each.spread;
                                }) &&
                    std::any_of(part.begin(), part.end(), [](const ReadingSince& each) {
                      return each.measured < each.expected - each.spread;
                    });
  if (!both || !(square > 1)) return;
  best.offer({ChangeKind::scatter, first, std::sqrt(square), false},
             before + parameter + logarithms + count * (1 + std::log(square)));
}

/// The only reading that is far off, where others follow; their number if there is none.
std::size_t single_outlier(Since since) {
  std::size_t found = since.size();
  for (std::size_t i = 0; i < since.size(); ++i) {
    if (std::abs(since[i].measured - since[i].expected) <= near * since[i].spread) continue;
    if (found < since.size()) return since.size();
    found = i;
  }
  return found + 1 < since.size() ? found : since.size();
}

bool are_above(Since part) {
  double sum = 0;
  for (const ReadingSince& each : part)
    sum += std::clamp((each.measured - each.expected) / each.spread, -near, near);
  return sum > 0;
}

}  // namespace

std::span<const double, unit_factor_count> unit_factors() {
  return factors;
}

std::string unit_change(double factor) {
  for (const auto& [size, larger, smaller] : unit_pairs) {
    if (factor == size) return fmt::format("such as {} in place of {}", larger, smaller);
    if (factor == 1 / size) return fmt::format("such as {} in place of {}", smaller, larger);
  }
  throw std::logic_error("unit_change: not one of unit_factors()");
}

std::string wrong_unit(double factor) {
  return fmt::format("the unit is not that of the study ({})", unit_change(factor));
}

std::string factor_text(double factor) {
  return factor < 1 ? fmt::format("1/{:.7g}", 1 / factor) : fmt::format("{:.7g}", factor);
}

ChangeCause cause_of(Since since, double before, const std::optional<AsNew>& as_new) {
  Best best;
  best.offer({ChangeKind::unclear, 0, 0, false}, unchanged(since));
  for (std::size_t first = 0; first < since.size(); ++first) {
    const Since part = since.subspan(first);
    const double earlier = unchanged(since.first(first));
    try_factors(part, first, earlier, best);
    // One reading does not distinguish these.
    if (part.size() < 2) continue;
    try_step(part, first, earlier, best);
    try_rate(part, first, first > 0 ? since[first - 1].at : before, earlier, best);
    try_scatter(part, first, earlier, best);
  }
  if (as_new && as_new->readings.size() + as_new->first == since.size()) {
    double sum = unchanged(since.first(as_new->first));
    for (const ReadingSince& each : as_new->readings)
      sum += cost(each.measured - each.expected, each.spread);
    best.offer({ChangeKind::replaced, as_new->first, 0, false}, sum);
  }
  ChangeCause cause = best.cause;
  const Since part = since.subspan(cause.first);
  if (const std::size_t at = single_outlier(since);
      cause.kind == ChangeKind::unclear && at < since.size())
    return {ChangeKind::single, at, 0, since[at].measured > since[at].expected};
  if (cause.kind == ChangeKind::unclear) {  // the last reading alone, or all
    for (cause.first = since.size() - 1; cause.first > 0; --cause.first) {
      const ReadingSince& each = since[cause.first - 1];
      if (std::abs(each.measured - each.expected) <= each.spread) break;
    }
  }
  cause.above = are_above(since.subspan(cause.first));
  return cause;
}

std::string reading_text(double si, const Unit& unit) {
  const double value = std::stod(fmt::format("{:.6g}", from_si(unit, si)));
  return given_text(value, Script::terminal) + (unit.text == "1" ? "" : " " + unit.text);
}

std::string description(const ChangeCause& cause, Since since, std::uint64_t dropped,
                        const ChangeWords& words) {
  const Since part = since.subspan(cause.first);
  const std::uint64_t count = part.size() + (cause.first == 0 ? dropped : 0);
  const bool one = count == 1;
  const std::string last = one ? "the last reading" : fmt::format("the last {} readings", count);
  const char* const lie = one ? "lies" : "lie";
  const char* const side = cause.above ? "above" : "below";
  const auto number = [](double x) { return shown_number(x, 3, Script::terminal); };
  const std::string unit = words.measured.text == "1" ? "" : " " + words.measured.text;
  switch (cause.kind) {
    case ChangeKind::factor:
      return fmt::format("{} {} the forecast after multiplication by {}: the unit has changed ({})",
                         last, one ? "fits" : "fit", factor_text(cause.size),
                         unit_change(cause.size));
    case ChangeKind::replaced:
      return fmt::format(
          "{} {} below the forecast and {} a new {}: the part was replaced, or the "
          "sensor reset to zero",
          last, lie, one ? "fits" : "fit", words.noun);
    case ChangeKind::step:
      return fmt::format(
          "{} {} {} {} the forecast, all by about the same amount: a step, of the "
          "{} or of its sensor",
          last, lie, number(std::abs(cause.size) / words.measured.scale) + unit, side, words.noun);
    case ChangeKind::rate:
      return fmt::format("{} {} {} the forecast; the rate has changed{}, or the sensor has", last,
                         lie, side,
                         cause.size > 0 ? fmt::format(" ({} times the earlier one)",
                                                      shown_number(cause.size, 2, Script::terminal))
                                        : "");
    case ChangeKind::scatter:
      return fmt::format(
          "{} scatter {} times as much as the forecast allows: the sensor has "
          "changed, or the load",
          last, shown_number(cause.size, 2, Script::terminal));
    case ChangeKind::single:
      return fmt::format(
          "a reading of {} lies {} the forecast of {}, and those after it agree with the earlier "
          "ones: "
          "a wrong reading, which can be corrected or withdrawn",
          reading_text(part.front().measured - part.front().added, words.measured), side,
          number(from_si(words.measured, part.front().expected - part.front().added)) + unit);
    case ChangeKind::unclear:
      break;
  }
  if (!one)
    return fmt::format("{} {} {} the forecast; the rate has changed, or the sensor has", last, lie,
                       side);
  const ReadingSince& only = part.back();
  return fmt::format(
      "the last reading, {}, lies {} the forecast of {}: a wrong reading, a step, "
      "or a change of the rate",
      reading_text(only.measured - only.added, words.measured), side,
      number(from_si(words.measured, only.expected - only.added)) + unit);
}

}  // namespace wearwell::prognosis
