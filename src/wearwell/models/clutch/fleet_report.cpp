#include "wearwell/models/clutch/fleet_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "wearwell/base/printable.h"
#include "wearwell/input/parquet_writer.h"
#include "wearwell/math/quantile.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/energy_balance.h"
#include "wearwell/models/clutch/fleet_day_report.h"
#include "wearwell/present/plot.h"
#include "wearwell/study/trust_blocks.h"

// Longer than others: the tables of one report in their order.
namespace wearwell::clutch {
namespace {

using present::digits;
using present::fixed;
using present::given;
using present::Prose;
using present::Range;
using present::Section;
using present::Table;

constexpr double quantiles[] = {0.05, 0.25, 0.5, 0.75, 0.95};
constexpr std::size_t worst_shown = 100;

struct Duty {
  const char* name;
  const char* unit;
  double scale;  ///< one unit in SI
};
constexpr Duty duties[FleetCounts::duties] = {{"slip speed", "rpm", rpm},
                                              {"torque", "N m", 1},
                                              {"temperature", "degC", 1},
                                              {"closing time", "s", 1},
                                              {"energy of a cycle", "kJ", 1e3}};

std::vector<double> sorted(const std::vector<float>& values, double scale) {
  std::vector<double> out;
  for (const float x : values) out.push_back(static_cast<double>(x) / scale);
  std::sort(out.begin(), out.end());
  return out;
}

Table level_table(const FleetCounts& counts) {
  Table table{"levels",
              "Units that have reached a level, now and after more cycles of their own duty",
              {{"Further cycles", "1", given},
               {"Worn", "%", given},
               {"Units", "1", fixed(1)},
               {"95 %", "1", fixed(1), true},
               {"Share of fleet", "%", digits(3)}}};
  for (std::size_t h = 0; h < counts.horizons().size(); ++h) {
    for (std::size_t l = 0; l < counts.levels().size(); ++l) {
      const UnitCount n = counts.reached(l, h);
      table.rows.push_back({counts.horizons()[h], 100 * counts.levels()[l], n.expected,
                            Range{n.low, n.high},
                            100 * n.expected / static_cast<double>(counts.units())});
    }
  }
  return table;
}

Table worst_table(const FleetFindings& found) {
  Table table{"worst",
              found.units.size() == 1 ? std::string("The unit")
                                      : fmt::format("The {} units that may be worn out first",
                                                    std::min(worst_shown, found.units.size())),
              {{"Unit"},
               {"Cycles", "1", fixed(0)},
               {"Volume", "mm^3", digits(5)},
               {"by scatter, ±", "mm^3", digits(3)},
               {"total, ±", "mm^3", digits(3)},
               {"Worn out already", "%", digits(3)},
               {"Cycles left", "1", present::life(5)},
               {"95 % by scatter", "1", present::life(5), true},
               {"95 % total", "1", present::life(5), true},
               {"Cycles outside the range", "1", fixed(0)}}};
  for (std::size_t i = 0; i < std::min(worst_shown, found.units.size()); ++i) {
    const UnitRow& u = found.units[i];
    table.rows.push_back({u.unit, u.cycles, u.volume / mm3, 2 * u.sd / mm3, 2 * u.full_sd / mm3,
                          100 * u.reached, u.left, Range{u.scatter.low, u.scatter.high},
                          Range{u.full.low, u.full.high}, u.outside_any});
  }
  return table;
}

Table spread_table(const FleetCounts& counts) {
  Table table{"spread", "Unit-to-unit variation: quantiles over the fleet", {{"Of each unit"}}};
  for (const double p : quantiles)
    table.columns.push_back({fmt::format("{:g} %", 100 * p), "1", digits(4)});
  const auto add = [&](const std::string& name, const std::vector<float>& values, double scale) {
    const std::vector<double> ordered = sorted(values, scale);
    table.rows.push_back({name});
    for (const double p : quantiles) table.rows.back().push_back(quantile(ordered, p));
  };
  add("worn [%]", counts.worn(), 0.01);
  for (std::size_t i = 0; i < FleetCounts::duties; ++i)
    add(fmt::format("mean {} [{}]", duties[i].name, duties[i].unit), counts.duty()[i],
        duties[i].scale);
  return table;
}

Table outside_table(const WearModel& model, const FleetCounts& counts) {
  Table table{"outside",
              "Cycles outside the calibrated range of the model",
              {{"Input"},
               {"From", "1", digits(4)},
               {"To", "1", digits(4)},
               {"Cycles outside", "1", fixed(0)},
               {"Share", "%", digits(3)}}};
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    const double scale = duties[i].scale;
    table.rows.push_back({fmt::format("{} [{}]", duties[i].name, duties[i].unit),
                          model.lowest.*inputs[i].value / scale,
                          model.highest.*inputs[i].value / scale, counts.outside()[i],
                          100 * counts.outside()[i] / counts.cycles()});
  }
  table.rows.push_back({"any of them", std::monostate{}, std::monostate{}, counts.outside_any(),
                        100 * counts.outside_any() / counts.cycles()});
  return table;
}

/// Shares of the fleet beyond each level, with their interval, one curve per horizon.
html::Figure level_figure(const FleetCounts& counts) {
  std::vector<plot::Json> marks;
  for (std::size_t h = 0; h < counts.horizons().size(); ++h) {
    std::vector<double> x, y, low, high;
    for (std::size_t l = 0; l < counts.levels().size(); ++l) {
      const UnitCount n = counts.reached(l, h);
      const double all = static_cast<double>(counts.units()) / 100;
      x.push_back(100 * counts.levels()[l]);
      y.push_back(n.expected / all);
      low.push_back(n.low / all);
      high.push_back(n.high / all);
    }
    const plot::Look look{
        plot::colour::chains[h % std::size(plot::colour::chains)],
        counts.horizons()[h] > 0 ? html::given(counts.horizons()[h]) + " cycles on" : "now"};
    plot::Look band = look;
    band.label = "";
    band.opacity = 0.2;
    marks.push_back(plot::area({{"x", x}, {"y", high}, {"y2", low}}, band));
    marks.push_back(plot::line({{"x", x}, {"y", y}}, look));
  }
  return {"levels", "Share of the fleet that has reached a level",
          "Bands are 95 % intervals: the uncertainty of the model is common to all units, so that "
          "more units do not narrow them.",
          plot::plot("Share of the fleet beyond each wear level", {.title = "worn (%)"},
                     {.title = "units (%)", .low = 0}, std::move(marks))};
}

nlohmann::ordered_json body_of(const WearModel& model, const FleetCounts& counts,
                               const FleetFindings& found) {
  nlohmann::ordered_json levels = nlohmann::ordered_json::array(),
                         worst = nlohmann::ordered_json::array();
  for (std::size_t h = 0; h < counts.horizons().size(); ++h) {
    for (std::size_t l = 0; l < counts.levels().size(); ++l) {
      const UnitCount n = counts.reached(l, h);
      levels.push_back({{"cycles_on", counts.horizons()[h]},
                        {"level", counts.levels()[l]},
                        {"units", n.expected},
                        {"low", n.low},
                        {"high", n.high}});
    }
  }
  for (std::size_t i = 0; i < std::min(worst_shown, found.units.size()); ++i) {
    const UnitRow& u = found.units[i];
    worst.push_back({{"unit", u.unit},
                     {"cycles", u.cycles},
                     {"volume", u.volume / mm3},
                     {"sd_scatter", u.sd / mm3},
                     {"sd_full", u.full_sd / mm3},
                     {"worn", u.volume / model.worn_out},
                     {"worn_out_already", u.reached},
                     {"cycles_left", u.left},
                     {"interval_scatter", {u.scatter.low, u.scatter.high}},
                     {"interval_full", {u.full.low, u.full.high}},
                     {"outside_any", u.outside_any},
                     {"negative", u.negative}});
    if (!found.days.known) continue;
    add_days(worst.back(), u);
  }
  nlohmann::ordered_json body = {{"fleet",
                                  {{"units", counts.units()},
                                   {"cycles", counts.cycles()},
                                   {"energy", counts.energy()},
                                   {"outside_any", counts.outside_any()},
                                   {"negative", counts.negative()},
                                   {"engine", found.engine},
                                   {"rows", found.rows},
                                   {"model", found.model_id},
                                   {"worn_out", model.worn_out / mm3},
                                   {"replicates", found.replicates ? model.replicates.size() : 0}}},
                                 {"levels", std::move(levels)},
                                 {"worst", std::move(worst)}};
  if (!found.layout.empty()) body["fleet"]["layout"] = found.layout;
  if (found.left_out.asked)
    body["left_out"] = left_out_json(found.left_out, missing_wear(found.left_out, found.units));
  if (!found.days.known) return body;
  add_days(body, counts, found.days);
  return body;
}

std::string units_file(const WearModel& model, const FleetFindings& found) {
  WordColumn names{"unit", {}};
  std::vector<NumberColumn> columns = {{"cycles", {}},           {"energy [J]", {}},
                                       {"volume [mm^3]", {}},    {"sd_scatter [mm^3]", {}},
                                       {"sd_full [mm^3]", {}},   {"worn", {}},
                                       {"worn_out_already", {}}, {"cycles_left", {}},
                                       {"left_scatter_low", {}}, {"left_scatter_high", {}},
                                       {"left_full_low", {}},    {"left_full_high", {}},
                                       {"outside_any", {}},      {"negative", {}}};
  if (found.days.known)
    for (const char* name :
         {"cycles_per_day", "days_left", "days_left_full_low", "days_left_full_high"})
      columns.push_back({name, {}});
  for (const UnitRow& u : found.units) {
    names.values.push_back(u.unit);
    const double row[] = {u.cycles,
                          u.energy,
                          u.volume / mm3,
                          u.sd / mm3,
                          u.full_sd / mm3,
                          u.volume / model.worn_out,
                          u.reached,
                          u.left,
                          u.scatter.low,
                          u.scatter.high,
                          u.full.low,
                          u.full.high,
                          u.outside_any,
                          u.negative,
                          u.per_day,
                          days_of(u, u.left),
                          days_of(u, u.full.low),
                          days_of(u, u.full.high)};
    static_assert(std::size(row) == 18);
    for (std::size_t c = 0; c < columns.size(); ++c) columns[c].values.push_back(row[c]);
  }
  return parquet_of({names}, columns);
}

std::vector<Check> checks_of(const FleetCounts& counts, const FleetFindings& found) {
  std::vector<Check> checks;
  const double share = counts.outside_any() / counts.cycles();
  constexpr double much = 0.05;
  checks.push_back({"extrapolation", share > much ? Verdict::warn : Verdict::pass,
                    fmt::format("{:.3g} % of the cycles, in {} of {} units, lie outside the "
                                "calibrated range of the model",
                                100 * share, counts.units_outside(), counts.units()),
                    ""});
  checks.push_back(
      {"negative", counts.negative() > much * counts.cycles() ? Verdict::warn : Verdict::pass,
       fmt::format("the model's wear rate is below 0 in {:.0f} cycles, which count as no wear",
                   counts.negative()),
       ""});
  if (const EnergyOutliers& far = found.outliers.all; far.count > 0)
    checks.push_back(
        {"energy-of-cycles", Verdict::fail,
         fmt::format("{} of {:.0f} cycles read now {} more than {:g} times the energy of a "
                     "closing, 1/2 x torque x slip speed x closing time; the largest is cycle {} "
                     "of unit {}, {:.4g} J, {:.3g} times that",
                     far.count, found.rows, far.count == 1 ? "has" : "have", EnergyOutliers::most,
                     far.worst_cycle, printable(found.outliers.unit), far.worst_energy,
                     far.worst_ratio),
         energy_advice});
  const FleetCounts::Implausible& energy = counts.implausible();
  checks.push_back(
      {"energy", energy.units > 0 ? Verdict::fail : Verdict::pass,
       energy.units == 0
           ? "the energy of every unit's cycles fits their torque, slip speed and closing time"
           : fmt::format("the energy of {} of {} units does not fit their torque, slip speed and "
                         "closing time: that of unit {} is {:.3g} times 1/2 x torque x slip speed "
                         "x closing time. These units have {:.3g} % of the fleet's wear",
                         energy.units, counts.units(), printable(energy.worst), energy.ratio,
                         100 * energy.volume / counts.volume()),
       energy.units == 0 ? "" : energy_advice});
  checks.push_back({"interval", found.replicates ? Verdict::pass : Verdict::warn,
                    found.replicates
                        ? "the full interval includes map, run-in, plates and scatter"
                        : "without replicates the full interval includes plates and scatter only",
                    ""});
  if (found.left_out.asked)
    checks.push_back(
        left_out_check(found.left_out, missing_wear(found.left_out, found.units), found.rows));
  return checks;
}

/// The rows left out: in a sentence above the counts that lack them.
void add_left_out(const FleetFindings& found, const FleetCounts& counts, Section& levels,
                  Section& fleet) {
  if (found.left_out.rows == 0) return;
  const std::vector<MissingWear> wear = missing_wear(found.left_out, found.units);
  levels.add(Prose{left_out_sentence(found.left_out, wear, found.rows, counts.volume()), false});
  for (Table& each : left_out_tables(found.left_out, wear, found.rows)) fleet.add(std::move(each));
}

}  // namespace

void worst_first(std::vector<UnitRow>& units) {
  std::sort(units.begin(), units.end(), [](const UnitRow& a, const UnitRow& b) {
    if (a.full.low != b.full.low) return a.full.low < b.full.low;
    if (a.reached != b.reached) return a.reached > b.reached;
    if (a.left != b.left) return a.left < b.left;
    return a.unit < b.unit;
  });
}

Result fleet_result(const WearModel& model, const FleetCounts& counts, const FleetFindings& found) {
  Result result;
  Header& header = result.header;
  header.version = found.version;
  header.title = fmt::format("A fleet of {} units: {}", counts.units(), model.title);
  header.model = "clutch-fleet";
  header.equation = "volume = sum of g(Ec) w E over the cycles of each unit, in fixed point";
  header.data = {found.files, static_cast<std::size_t>(found.rows), found.model_id};
  header.checks = checks_of(counts, found);
  header.trusted = std::none_of(header.checks.begin(), header.checks.end(),
                                [](const Check& each) { return each.verdict == Verdict::fail; });
  result.body = body_of(model, counts, found);
  result.files.emplace_back("units.parquet", units_file(model, found));

  Section levels{"levels", "Levels"};
  const std::size_t last = counts.levels().size() - 1;
  const UnitCount now = counts.reached(last, 0);
  levels.add(Prose{
      fmt::format("{1:.1f} of {0} units ({2:.1f} to {3:.1f}) have reached {4:g} % of the worn-out "
                  "volume.",
                  html::given(static_cast<double>(counts.units())), now.expected, now.low, now.high,
                  100 * counts.levels()[last]),
      true});
  Section fleet{"fleet", "Fleet"};
  add_left_out(found, counts, levels, fleet);
  levels.add(level_table(counts));
  if (found.days.known) levels.add(day_table(counts, found.days));
  levels.add(when_table(found));
  levels.add(present::Figures{{level_figure(counts)}});
  Section worst{"worst", "Worst units"};
  worst.add(worst_table(found));
  if (found.days.known)
    worst.add(worst_day_table(found, std::min(worst_shown, found.units.size())));
  fleet.add(spread_table(counts));
  fleet.add(outside_table(model, counts));
  Section how{"how", "How"};
  present::Facts facts{{{"engine", found.engine},
                        {"cycles read", fmt::format("{:.0f}", found.rows)},
                        {"model", found.model_id}}};
  if (!found.layout.empty()) facts.facts.push_back({"layout of the files", found.layout});
  how.add(std::move(facts));
  how.add(present::Details{"The statements", {{present::Verbatim{found.statements}}}});
  result.sections = {std::move(levels), std::move(worst), std::move(fleet),
                     checks_section(header.checks), std::move(how)};
  return result;
}

}  // namespace wearwell::clutch
