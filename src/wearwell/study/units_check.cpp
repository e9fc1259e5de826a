#include "wearwell/study/units_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

namespace wearwell {
namespace {

// Plausible largest values of a column for any machine or test, SI. Worn volumes from (10 nm)^3;
// lengths from an atom; stresses up to a tenth of Young's modulus of diamond.
struct Sizes {
  std::string_view si;
  double least, most;
};
constexpr std::array<Sizes, 9> sizes = {{{"m^3", 1e-24, 1},
                                         {"m", 1e-10, 10},
                                         {"Pa", 1e3, 1e11},
                                         {"N", 1e-9, 1e9},
                                         {"s", 1e-6, 1e10},
                                         {"rev/s", 1e-9, 1e5},
                                         {"rad/s", 1e-9, 1e6},
                                         {"cycle", 0, 1e14},
                                         {"rev", 0, 1e14}}};
constexpr double coldest = 173, hottest = 2273;  // K, of a machine part
// Two units in one column usually differ by a factor of 1000; conditions of one study vary less.
constexpr double widest = 300;

std::string description(const DataColumn& column, double si) {
  const std::string unit = column.unit.text == "1" ? column.si : column.unit.text;
  return fmt::format("{:.4g} {}", from_si(column.unit, si), unit);
}

bool is_count(const DataColumn& column) {
  return column.si == "cycle" || column.si == "rev";
}

// A test that broke at once is recorded as a half or a quarter of a cycle.
bool below_one(double count) {
  return count > 0 && count < 1 && count != 0.5 && count != 0.25;
}

void look_at(const DataColumn& column, Findings& findings) {
  const auto add = [&](const std::string& what) {
    findings.add(Verdict::warn, fmt::format("{}: {}", column.name, what),
                 "Check the units and these cells. docs/reference/units.md lists the rules.");
  };
  std::vector<double> positive;
  double largest = 0;
  for (const double value : column.values) {
    if (value > 0) positive.push_back(value);
    largest = std::max(largest, std::abs(value));
  }
  if (positive.empty()) return;
  const auto [low, high] = std::minmax_element(positive.begin(), positive.end());
  if (column.si == "K") {
    if (*low < coldest || *high > hottest)
      add(fmt::format("{} to {} is not a plausible temperature of a machine",
                      description(column, *low), description(column, *high)));
    return;
  }
  const auto parts = std::count_if(positive.begin(), positive.end(), below_one);
  if (is_count(column) && parts > 0)
    add(fmt::format("{} of {} counts are below 1, the smallest is {:.4g}", parts,
                    column.values.size(), *low));
  for (const Sizes& size : sizes) {
    const bool way = column.endless && size.si == "m";
    if (way || size.si != column.si || (largest >= size.least && largest <= size.most)) continue;
    add(fmt::format("the largest value is {}, which is not plausible for any machine",
                    description(column, largest)));
  }
  if (column.condition && *high >= widest * *low)
    add(fmt::format("{} to {} is a factor of {:.3g}, which suggests two units in one column",
                    description(column, *low), description(column, *high), *high / *low));
}

}  // namespace

std::optional<Check> units_check(const std::vector<DataColumn>& columns) {
  Findings findings("units");
  for (const DataColumn& column : columns) look_at(column, findings);
  Check check = findings.result("");
  if (check.verdict == Verdict::pass) return {};
  return check;
}

}  // namespace wearwell
