#include "wearwell/models/fatigue/history_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/input/parquet_writer.h"
#include "wearwell/models/fatigue/history_state.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"

namespace wearwell::fatigue {
namespace {

using present::Table;
namespace colour = plot::colour;

std::string unit_of(const HistoryReport& report) {
  return report.unit.empty() ? "1" : report.unit;
}

std::string with_unit(const HistoryReport& report, double value) {
  return plain_given(value) + (report.unit.empty() ? "" : " " + report.unit);
}

double width_of(const HistoryReport& report) {
  return report.counted.classes.shown_width(report.most_ranges);
}

double cycles_in(const CycleClasses& classes) {
  double sum = 0;
  for (const CycleClasses::Cell& cell : classes.cells()) sum += cell.count;
  return sum;
}

double largest_range(const CycleClasses& classes) {
  double largest = 0;
  for (const CycleClass& each : classes.classes()) largest = std::max(largest, each.range);
  return largest;
}

struct ShownClass {
  double range, mean;  // index of its start
  double count;
};

// Classes divide the displayed ones exactly.
std::vector<ShownClass> shown_classes(const HistoryReport& report) {
  const CycleClasses& classes = report.counted.classes;
  const double width = width_of(report);
  const double parts = width / classes.width();
  std::map<std::pair<long long, long long>, double> counts;
  const auto whole = [&](std::int32_t index) {
    return static_cast<long long>(std::floor(static_cast<double>(index) / parts));
  };
  for (const CycleClasses::Cell& cell : classes.cells())
    counts[{whole(cell.range), whole(cell.mean)}] += cell.count;
  std::vector<ShownClass> shown;
  for (const auto& [at, count] : counts)
    shown.push_back(
        {static_cast<double>(at.first) * width, static_cast<double>(at.second) * width, count});
  return shown;
}

html::Figure matrix_figure(const HistoryReport& report) {
  const double width = width_of(report);
  std::vector<double> x, x2, y, y2, count, dark;
  double most = 0;
  const std::vector<ShownClass> classes = shown_classes(report);
  for (const ShownClass& each : classes) most = std::max(most, each.count);
  for (const ShownClass& each : classes) {
    x.push_back(each.mean);
    x2.push_back(each.mean + width);
    y.push_back(each.range);
    y2.push_back(each.range + width);
    count.push_back(each.count);
    dark.push_back(0.15 + 0.85 * std::log1p(each.count) / std::log1p(most));
  }
  const std::string unit = html::unit(unit_of(report));
  const auto title = [&](const char* name) {
    return unit.empty() ? std::string(name) : fmt::format("{} [{}]", name, unit);
  };
  return {
      "matrix", "Cycles by range and mean",
      fmt::format("Classes are {} wide; darker means more cycles, on a logarithmic scale.",
                  with_unit(report, width)),
      plot::plot(
          "Range-mean matrix of the counted cycles",
          {title("Mean"), false, *std::min_element(x.begin(), x.end()),
           *std::max_element(x2.begin(), x2.end())},
          {title("Range"), false, 0.0, *std::max_element(y2.begin(), y2.end())},
          {plot::cells(
              {{"x", x}, {"x2", x2}, {"y", y}, {"y2", y2}, {"density", dark}, {"cycles", count}},
              {colour::posterior})},
          340)};
}

html::Figure spectrum_figure(const HistoryReport& report) {
  std::vector<CycleClass> classes = report.counted.classes.classes();
  std::vector<double> x, y;
  double above = 0;
  // From the largest down; a few hundred points are enough for a plot.
  const double step = classes.back().range / 400;
  double drawn = INFINITY;
  for (auto each = classes.rbegin(); each != classes.rend(); ++each) {
    above += each->count;
    if (drawn - each->range < step && std::next(each) != classes.rend()) continue;
    drawn = each->range;
    x.push_back(above);
    y.push_back(each->range);
  }
  const std::string unit = html::unit(unit_of(report));
  return {"spectrum", "Spectrum", "Number of cycles with at least this range.",
          plot::plot("Range against the number of cycles that reach it",
                     {"Cycles", true, 0.5 * x.front(), x.back()},
                     {unit.empty() ? "Range" : fmt::format("Range [{}]", unit), false, 0.0,
                      1.05 * y.front()},
                     {plot::line({{"x", x}, {"y", y}}, {colour::posterior}),
                      plot::points({{"x", x}, {"y", y}}, {colour::posterior, "", 1, 0, false, 14})},
                     300)};
}

html::Figure levels_figure(const HistoryReport& report) {
  std::vector<double> x, y;
  for (const auto& level : report.counted.levels.levels(width_of(report))) {
    x.push_back(static_cast<double>(level.up + level.down));
    y.push_back(level.value);
  }
  const std::string unit = html::unit(unit_of(report));
  return {"levels", "Level crossings", "Number of crossings of each level, up or down.",
          plot::plot("Levels against the number of their crossings", {"Crossings", true},
                     {unit.empty() ? "Level" : fmt::format("Level [{}]", unit)},
                     {plot::line({{"x", x}, {"y", y}}, {colour::chains[2]}),
                      plot::points({{"x", x}, {"y", y}}, {colour::chains[2], "", 1, 0, false, 14})},
                     300)};
}

}  // namespace

Table cycles_table(const HistoryReport& report) {
  const std::string unit = unit_of(report);
  Table table{"cycles", "Counted cycles", {{"range", unit}, {"mean", unit}, {"cycles"}}};
  for (const CycleClass& each : report.counted.classes.classes())
    table.rows.push_back({each.range, each.mean, each.count});
  return table;
}

Table matrix_table(const HistoryReport& report) {
  const std::string unit = unit_of(report);
  const double width = width_of(report);
  Table table{"matrix",
              "Cycles by classes of range and mean",
              {{"range from", unit},
               {"range to", unit},
               {"mean from", unit},
               {"mean to", unit},
               {"cycles"}}};
  for (const ShownClass& each : shown_classes(report))
    table.rows.push_back(
        {each.range, each.range + width, each.mean, each.mean + width, each.count});
  return table;
}

Table spectrum_table(const HistoryReport& report) {
  const std::string unit = unit_of(report);
  const double width = width_of(report);
  std::map<double, double> counts;
  for (const ShownClass& each : shown_classes(report)) counts[each.range] += each.count;
  Table table{
      "spectrum",
      "Cycles by range",
      {{"range from", unit}, {"range to", unit}, {"cycles"}, {"cycles of at least this range"}}};
  double above = 0;
  for (auto each = counts.rbegin(); each != counts.rend(); ++each) {
    above += each->second;
    table.rows.push_back({each->first, each->first + width, each->second, above});
  }
  return table;
}

Table levels_table(const HistoryReport& report) {
  Table table{"levels", "Level crossings", {{"level", unit_of(report)}, {"up"}, {"down"}}};
  for (const auto& level : report.counted.levels.levels(width_of(report)))
    table.rows.push_back(
        {level.value, static_cast<double>(level.up), static_cast<double>(level.down)});
  return table;
}

std::string counted_text(const HistoryReport& report) {
  const bool half = report.rule.residual == Residual::half;
  return fmt::format("{} rainflow counting (ASTM E1049); {}",
                     report.rule.counting == Counting::three_point ? "Three-point" : "Four-point",
                     half ? "unclosed ranges count as half cycles"
                          : "the history is repeated, so that every range closes a cycle");
}

std::string history_text(const HistoryReport& report) {
  const LoadHistory::Counted& counted = report.counted;
  const double cycles = cycles_in(counted.classes);
  std::string text =
      wrapped(fmt::format("{}, {}: {} samples, {} peaks and valleys from {} to {}", report.source,
                          report.column, counted.samples, counted.reversals,
                          plain_given(counted.lowest), with_unit(report, counted.highest)),
              0, 2);
  text += wrapped(counted_text(report) + ".", 0, 2);
  text += wrapped(
      fmt::format("{} cycles, {} of them closed; the largest range is {}{}", plain_given(cycles),
                  plain_given(counted.closed), with_unit(report, largest_range(counted.classes)),
                  report.unit.empty() ? "; the column has no unit." : "."),
      0, 2);
  if (!report.unread_times.empty())
    text +=
        wrapped(fmt::format("Gaps were not checked: use --time '{}'.", report.unread_times), 0, 2);
  return text + "\n" + present::text(spectrum_table(report));
}

std::vector<present::Section> history_sections(const HistoryReport& report) {
  present::Section count{"count", "Count"};
  const LoadHistory::Counted& counted = report.counted;
  count.add(present::Prose{counted_text(report) + ".", true});
  count.add(present::Tiles{
      {{"Cycles", plain_given(cycles_in(counted.classes)), "",
        fmt::format("{} of them closed before the end", plain_given(counted.closed))},
       {"Largest range", html::number(largest_range(counted.classes)), html::unit(report.unit), ""},
       {"Samples", html::given(static_cast<double>(counted.samples)), "",
        fmt::format("{} peaks and valleys",
                    html::given(static_cast<double>(counted.reversals)))}}});
  count.add(
      present::Figures{{spectrum_figure(report), matrix_figure(report), levels_figure(report)}});
  count.add(spectrum_table(report));
  present::Section tables{"tables", "Tables"};
  tables.add(present::Details{"Level crossings", {{levels_table(report)}}});
  tables.add(present::Details{"Range-mean matrix", {{matrix_table(report)}}});
  tables.add(present::Details{"Every class of cycles", {{cycles_table(report)}}});
  return {count, tables};
}

nlohmann::ordered_json history_json(const HistoryReport& report) {
  using Json = nlohmann::ordered_json;
  const LoadHistory::Counted& counted = report.counted;
  Json json = {{"file", report.source},
               {"column", report.column},
               {"unit", report.unit},
               {"method", counting_name(report.rule.counting)},
               {"residual", residual_name(report.rule.residual)},
               {"samples", counted.samples},
               {"reversals", counted.reversals},
               {"lowest", counted.lowest},
               {"highest", counted.highest},
               {"cycles", cycles_in(counted.classes)},
               {"closed", counted.closed},
               {"largest_range", largest_range(counted.classes)},
               {"class_width", width_of(report)},
               {"residual_points", counted.residual}};
  const auto rows = [](const Table& table, std::initializer_list<const char*> names) {
    Json all = Json::array();
    for (const auto& row : table.rows) {
      Json each;
      std::size_t c = 0;
      for (const char* name : names) each[name] = std::get<double>(row[c++]);
      all.push_back(std::move(each));
    }
    return all;
  };
  json["spectrum"] = rows(spectrum_table(report), {"from", "to", "cycles", "at_least"});
  json["matrix"] =
      rows(matrix_table(report), {"range_from", "range_to", "mean_from", "mean_to", "cycles"});
  json["levels"] = rows(levels_table(report), {"level", "up", "down"});
  return json;
}

std::string parquet(const Table& table) {
  std::vector<NumberColumn> columns;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    columns.push_back({present::heading(table.columns[c]), {}});
    for (const auto& row : table.rows) columns.back().values.push_back(std::get<double>(row[c]));
  }
  return parquet_of(columns);
}

}  // namespace wearwell::fatigue
