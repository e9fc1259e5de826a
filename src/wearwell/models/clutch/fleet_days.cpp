#include "wearwell/models/clutch/fleet_days.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"

namespace wearwell::clutch {

void FleetDays::read(fleet::Engine& engine, const ClutchSql& sql, const SqlSource& source) {
  if (sql.times.empty()) return;
  known = true;
  std::vector<fleet::Row> rows;
  bool dates = true;  // no row has a time of day
  engine.rows(sql.times, 1, [&](const fleet::Row& row) {
    dates = dates && (row.numbers[3] == 0 || row.numbers[2] == 0);
    rows.push_back(row);
  });
  dates = dates || source.is_date;
  for (const fleet::Row& row : rows) {
    const double first = row.numbers[0], last = row.numbers[1], count = row.numbers[2];
    double rate = row.numbers[4];
    if (!source.time.empty()) {
      if (!(count > 0)) continue;
      now = std::isnan(now) ? last : std::max(now, last);
      const double days = (last - first) / day;
      // If there are only dates, or hours of one day: by the days from the first to the last,
      // inclusive.
      const double calendar = std::floor(last / day) - std::floor(first / day) + 1;
      rate = count < 2 ? NAN : dates || days < 1 ? count / calendar : (count - 1) / days;
    }
    if (std::isnan(rate)) continue;
    if (!(rate >= 0) || !std::isfinite(rate))
      throw InputError(fmt::format("{}: unit {} makes {:g} cycles per day", engine.source(),
                                   printable(row.texts.front()), rate));
    per_day[row.texts.front()] = rate;
  }
}

void FleetDays::finish() {
  if (!known) return;
  if (per_day.empty())
    throw InputError(
        "no unit has two cycles with a time, or a number of cycles per day: leave 'time' and "
        "'cycles_per_day' out of --columns for results in cycles");
  double sum = 0;
  std::vector<double> all;  // sorted, independent of the order of the table
  for (const auto& [unit, rate] : per_day) all.push_back(rate);
  std::sort(all.begin(), all.end());
  for (const double rate : all) sum += rate;
  mean = sum / static_cast<double>(all.size());
}

double FleetDays::of(const std::string& unit) {
  const auto at = per_day.find(unit);
  if (at != per_day.end()) return at->second;
  ++borrowed;
  return mean;
}

std::string day_text(double seconds) {
  constexpr double end = 253402300800.0;  // of the year 9999
  if (!(seconds >= 0 && seconds < end)) return "";
  const std::chrono::sys_days at{
      std::chrono::days{static_cast<int>(std::floor(seconds / FleetDays::day))}};
  const std::chrono::year_month_day date{at};
  return fmt::format("{:04}-{:02}-{:02}", static_cast<int>(date.year()),
                     static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()));
}

}  // namespace wearwell::clutch
