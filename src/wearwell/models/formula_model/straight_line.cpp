#include "wearwell/models/formula_model/straight_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/base/stop_scope.h"
#include "wearwell/input/columns.h"
#include "wearwell/study/column_values.h"

namespace wearwell::formula_model {
namespace {

using Points = std::vector<std::pair<double, double>>;

// Intercept and slope; a slope through 0 if all positions are equal.
std::pair<double, double> fitted(const Points& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [a, b] : points) {
    n += 1;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const double spread = n * xx - x * x;
  if (!(spread > 1e-12 * n * xx)) return {0, xx > 0 ? xy / xx : 0};
  const double slope = (n * xy - x * y) / spread;
  return {(y - slope * x) / n, slope};
}

double median(std::vector<double> values) {
  if (values.empty()) return 0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

StraightLine straight_line(const Table& table, const Column& axis, const Column& measured,
                           const Column* unit) {
  const std::vector<double> x = numbers_of(table, axis), y = numbers_of(table, measured);
  std::map<std::string, Points> units;
  double largest_x = 0, largest_y = 0;
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(y[i])) continue;
    units[unit ? cell_word(*unit, i) : ""].emplace_back(x[i], y[i]);
    largest_x = std::max(largest_x, std::abs(x[i]));
    largest_y = std::max(largest_y, std::abs(y[i]));
  }
  std::vector<double> starts, slopes, through;
  double sum = 0, rows = 0;
  for (const auto& [name, points] : units) {
    const auto [start, slope] = fitted(points);
    starts.push_back(start);
    slopes.push_back(slope);
    for (const auto& [a, b] : points) {
      sum += std::pow(b - start - slope * a, 2);
      rows += 1;
      if (a != 0) through.push_back(b / a);
    }
  }
  StraightLine line;
  const double start = median(starts), slope = median(slopes);
  const double scatter =
      std::sqrt(sum / std::max(rows - 2.0 * static_cast<double>(units.size()), 1.0));
  // Wear that slows down also has a positive intercept; only a large one counts as another start.
  line.begins_at_zero = std::abs(start) < std::max(0.3 * largest_y, 4 * scatter);
  const double rate = line.begins_at_zero ? median(through) : slope;
  line.falls = rate < 0;
  if (rate != 0) {
    line.rate = std::abs(rate);
  } else if (largest_x > 0 && largest_y > 0) {
    line.rate = largest_y / largest_x;
  }
  return line;
}

void require_rows_of_family(const Table& table, const Column& axis, const Column& measured,
                            std::string_view family) {
  if (family == "normal") return;
  const std::vector<double> x = numbers_of(table, axis), y = numbers_of(table, measured);
  // Where all readings are below 0 the path falls, which is refused as such.
  const bool rises = family != "wiener-process" &&
                     std::any_of(y.begin(), y.end(), [](double each) { return each > 0; });
  for (std::size_t i = 0; i < table.rows; ++i) {
    check_stop();
    if (x[i] == 0 && y[i] == 0) {
      throw InputError(
          fmt::format("{}: 0; a path of the family \"{}\" begins at 0, so a reading "
                      "there says nothing: leave out the row",
                      place(table, axis.name, i), family));
    }
    if (x[i] <= 0) {
      throw InputError(
          fmt::format("{}: {:.15g} must be positive: a path of the family \"{}\" begins "
                      "at 0, where {} is 0; family = \"normal\" takes such a row",
                      place(table, axis.name, i), x[i], family, axis.name));
    }
    if (rises && y[i] <= 0) {
      throw InputError(
          fmt::format("{}: {:.15g} must be positive for the family \"{}\"; family = "
                      "\"normal\" takes readings of 0 and less",
                      place(table, measured.name, i), y[i], family));
    }
  }
}

}  // namespace wearwell::formula_model
