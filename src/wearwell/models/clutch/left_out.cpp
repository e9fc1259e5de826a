#include "wearwell/models/clutch/left_out.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "wearwell/base/printable.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

using present::digits;
using present::fixed;
using present::given;
using present::Table;

constexpr std::size_t units_shown = 100;

struct ReasonText {
  const char* text;
  const char* key;  ///< in JSON
};
constexpr ReasonText reason_texts[LeftOut::reasons] = {
    {"", ""},
    {"no unit", "unit"},
    {"cycle is not an integer of at least 1", "cycle"},
    {"slip speed is missing or not positive", "slip_speed"},
    {"torque is missing or not positive", "torque"},
    {"temperature is missing or below absolute zero", "temperature"},
    {"closing time is missing or not positive", "closing_time"},
    {"energy is missing or not positive", "energy"}};

double sum_of(const std::vector<MissingWear>& wear, double MissingWear::*member) {
  double sum = 0;
  for (const MissingWear& each : wear) sum += each.*member;
  return sum;
}

/// Infinite for a unit of which nothing else is known.
double deviations(const MissingWear& each) {
  if (each.cycles == 0) return std::numeric_limits<double>::infinity();
  return each.sd > 0 ? each.volume / each.sd : each.volume > 0 ? 1e300 : 0;
}

}  // namespace

void LeftOut::read(fleet::Engine& engine, const ClutchSql& sql) {
  engine.rows(sql.left_out, 0, [&](const fleet::Row& row) {
    const auto reason = static_cast<std::size_t>(row.numbers[0]);
    count.at(reason) += row.numbers[1];
    units.at(reason) += row.numbers[2];
    rows += row.numbers[1];
  });
  engine.rows(sql.left_out_rows, 1, [&](const fleet::Row& row) {
    const auto reason = static_cast<Reason>(row.numbers[0]);
    const auto column = static_cast<std::size_t>(reason) - 1;
    first.push_back(
        {row.texts[0], reason, row.numbers[1],
         reason == unit ? std::numeric_limits<double>::quiet_NaN() : row.numbers.at(column)});
  });
  engine.rows(sql.left_out_units, 1,
              [&](const fleet::Row& row) { by_unit[row.texts[0]] += row.numbers[0]; });
}

void LeftOut::add(const LeftOut& other) {
  rows += other.rows;
  for (std::size_t r = 0; r < count.size(); ++r) {
    count[r] += other.count[r];
    units[r] += other.units[r];
  }
  first.insert(first.end(), other.first.begin(), other.first.end());
  for (const auto& [name, more] : other.by_unit) by_unit[name] += more;
}

namespace {

// Rows without a unit, at the mean wear of the fleet; all of them may be those of the unit whose
// volume is known best.
MissingWear without_unit(const LeftOut& left_out, const std::vector<UnitRow>& units) {
  MissingWear wear{"", left_out.count[LeftOut::unit]};
  double volume = 0;
  wear.sd = std::numeric_limits<double>::infinity();
  for (const UnitRow& each : units) {
    volume += each.volume;
    wear.cycles += each.cycles;
    wear.sd = std::min(wear.sd, each.full_sd);
  }
  if (wear.cycles > 0) wear.volume = wear.rows * volume / wear.cycles;
  return wear;
}

std::string shown_unit(const MissingWear& wear) {
  return wear.unit.empty() ? "none" : printable(wear.unit);
}

}  // namespace

std::vector<MissingWear> missing_wear(const LeftOut& left_out, const std::vector<UnitRow>& units) {
  std::vector<MissingWear> all;
  if (left_out.rows == 0) return all;
  if (left_out.count[LeftOut::unit] > 0) all.push_back(without_unit(left_out, units));
  std::unordered_map<std::string_view, const UnitRow*> known;
  for (const UnitRow& each : units) known[each.unit] = &each;
  for (const auto& [unit, rows] : left_out.by_unit) {
    MissingWear wear{unit, rows};
    if (const auto at = known.find(unit); at != known.end()) {
      wear.cycles = at->second->cycles;
      wear.volume = rows * at->second->volume / wear.cycles;
      wear.sd = at->second->full_sd;
    }
    all.push_back(std::move(wear));
  }
  std::stable_sort(all.begin(), all.end(), [](const MissingWear& a, const MissingWear& b) {
    return deviations(a) > deviations(b);
  });
  return all;
}

std::string left_out_sentence(const LeftOut& left_out, const std::vector<MissingWear>& wear,
                              double rows, double fleet_volume) {
  std::string text = fmt::format(
      "{:.0f} of {:.0f} rows ({:.3g} %) were left out because they have no unit or an impossible "
      "value. At the mean wear of their units (without a unit: of the fleet) they would add {:.3g} "
      "mm^3, {:.3g} % of the wear of the fleet.",
      left_out.rows, rows, 100 * left_out.rows / rows, sum_of(wear, &MissingWear::volume) / mm3,
      100 * sum_of(wear, &MissingWear::volume) / fleet_volume);
  double unknown = 0;
  for (const MissingWear& each : wear) unknown += each.cycles == 0 ? each.rows : 0;
  if (unknown > 0)
    text += fmt::format(" This does not include {:.0f} rows of units with no other row.", unknown);
  return text;
}

Check left_out_check(const LeftOut& left_out, const std::vector<MissingWear>& wear, double rows) {
  const auto large = std::count_if(wear.begin(), wear.end(),
                                   [](const MissingWear& each) { return each.is_large(); });
  const auto unknown = std::count_if(wear.begin(), wear.end(),
                                     [](const MissingWear& each) { return each.cycles == 0; });
  std::string text =
      fmt::format("{:.0f} of {:.0f} rows were left out (--skip-bad)", left_out.rows, rows);
  if (left_out.rows == 0) return {"left-out", Verdict::pass, text, ""};
  if (unknown > 0)
    text += fmt::format("; {} units have no other row and are missing from the fleet (unit {})",
                        unknown, shown_unit(wear.front()));
  if (large > unknown) {
    const MissingWear& worst = wear[static_cast<std::size_t>(unknown)];
    text += fmt::format(
        "; of {} units the missing wear may exceed the standard deviation of the volume: unit {} "
        "has {:.0f} rows left out and {:.0f} cycles",
        large - unknown, shown_unit(worst), worst.rows, worst.cycles);
  }
  if (large == 0 && !wear.empty())
    text += fmt::format(
        "; no unit's missing wear exceeds the standard deviation of its volume (at most {:.2g} of "
        "it, unit {})",
        deviations(wear.front()), shown_unit(wear.front()));
  return {"left-out", large > 0 ? Verdict::fail : Verdict::warn, text,
          large > 0 ? "Correct the rows of the table left-out: the wear of these units is stated "
                      "too small."
                    : ""};
}

std::vector<Table> left_out_tables(const LeftOut& left_out, const std::vector<MissingWear>& wear,
                                   double rows) {
  if (left_out.rows == 0) return {};
  Table reasons{
      "left-out-reasons",
      "Rows left out, by the first reason",
      {{"Reason"}, {"Rows", "1", fixed(0)}, {"Share", "%", digits(3)}, {"Units", "1", fixed(0)}}};
  for (std::size_t r = 1; r < LeftOut::reasons; ++r) {
    if (left_out.count[r] == 0) continue;
    reasons.rows.push_back({reason_texts[r].text, left_out.count[r], 100 * left_out.count[r] / rows,
                            left_out.units[r]});
  }
  Table units{"left-out-units",
              "How much the rows left out might matter: as many cycles at the unit's mean wear",
              {{"Unit"},
               {"Rows left out", "1", fixed(0)},
               {"Cycles", "1", fixed(0)},
               {"Missing", "mm^3", digits(3)},
               {"In standard deviations of its volume", "1", digits(3)}}};
  for (std::size_t i = 0; i < std::min(units_shown, wear.size()); ++i) {
    const MissingWear& each = wear[i];
    units.rows.push_back(
        {each.unit.empty() ? std::string("(without a unit)") : each.unit, each.rows, each.cycles});
    if (each.cycles == 0) {
      units.rows.back().insert(units.rows.back().end(), {std::monostate{}, std::monostate{}});
    } else {
      units.rows.back().insert(units.rows.back().end(), {each.volume / mm3, deviations(each)});
    }
  }
  Table list{"left-out",
             left_out.rows > static_cast<double>(left_out.first.size())
                 ? fmt::format("The first {} rows left out", left_out.first.size())
                 : std::string("Rows left out"),
             {{"Unit"}, {"Cycle", "1", given}, {"Reason"}, {"Value (SI, degC)", "1", given}}};
  for (const LeftOut::Row& each : left_out.first) {
    list.rows.push_back({each.unit});
    const auto add = [&](double x) {
      if (std::isfinite(x)) {
        list.rows.back().push_back(x);
      } else {
        list.rows.back().push_back(std::monostate{});
      }
    };
    add(each.cycle);
    list.rows.back().push_back(std::string(reason_texts[each.reason].text));
    add(each.value);
  }
  std::vector<Table> all = {std::move(reasons)};
  if (!units.rows.empty()) all.push_back(std::move(units));
  all.push_back(std::move(list));
  return all;
}

nlohmann::ordered_json left_out_json(const LeftOut& left_out,
                                     const std::vector<MissingWear>& wear) {
  nlohmann::ordered_json reasons = nlohmann::ordered_json::array(),
                         units = nlohmann::ordered_json::array();
  for (std::size_t r = 1; r < LeftOut::reasons; ++r) {
    if (left_out.count[r] == 0) continue;
    reasons.push_back({{"column", reason_texts[r].key},
                       {"rows", left_out.count[r]},
                       {"units", left_out.units[r]}});
  }
  for (std::size_t i = 0; i < std::min(units_shown, wear.size()); ++i) {
    const MissingWear& each = wear[i];
    units.push_back(
        {{"unit", each.unit.empty() ? nlohmann::ordered_json() : nlohmann::ordered_json(each.unit)},
         {"rows", each.rows},
         {"cycles", each.cycles},
         {"volume", each.volume / mm3},
         {"sd", each.sd / mm3}});
  }
  return {{"rows", left_out.rows},
          {"without_unit", left_out.count[LeftOut::unit]},
          {"volume", sum_of(wear, &MissingWear::volume) / mm3},
          {"reasons", std::move(reasons)},
          {"units", std::move(units)}};
}

}  // namespace wearwell::clutch
