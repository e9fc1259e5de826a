#include "wearwell/models/recurrence/projection_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/math/quantile.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell::recurrence {
namespace {

using Json = nlohmann::ordered_json;
using Member = double ProjectedIntensity::*;

constexpr std::size_t draws_of_band = 4000;

// Values of a posterior in ascending order.
struct Sorted {
  std::vector<double> values;
  double quantile(double p) const { return wearwell::quantile(values, p); }
};

Sorted ascending(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return {std::move(values)};
}

// 1/intensity in the unit of ages.
std::vector<double> mtbf_of(const ProjectionDraws& draws, Member member, const Unit& unit) {
  std::vector<double> values;
  values.reserve(draws.intensity.size());
  for (const ProjectedIntensity& each : draws.intensity)
    values.push_back(from_si(unit, 1 / (each.*member)));
  return values;
}

// A line of the projection, in its unit.
struct ProjectionLine {
  std::string key, name, unit;
  Sorted known;
  std::optional<double> crow = {};
};

std::vector<ProjectionLine> lines_of(const Asked& asked, const ProjectionDraws& draws,
                                     const std::optional<CrowProjection>& crow) {
  const Unit& unit = asked.data.unit;
  std::vector<ProjectionLine> lines;
  const auto add = [&](const char* key, const char* name, Member member) {
    ProjectionLine line{key, name, unit.text, ascending(mtbf_of(draws, member, unit))};
    if (crow) line.crow = from_si(unit, 1 / (crow->intensity.*member));
    lines.push_back(std::move(line));
  };
  add("demonstrated", "MTBF demonstrated by the test", &ProjectedIntensity::demonstrated);
  add("projected", "MTBF projected after the fixes", &ProjectedIntensity::projected);
  add("growth_potential", "growth potential MTBF", &ProjectedIntensity::potential);
  add("time_per_new_mode", "time per new failure mode", &ProjectedIntensity::new_modes);
  ProjectionLine beta{"beta", "beta of first occurrences", "1", ascending(draws.beta)};
  if (crow) beta.crow = crow->beta;
  lines.push_back(std::move(beta));
  std::vector<double> found = draws.found;
  for (double& each : found) each *= 100;
  lines.push_back({"found_percent", "intensity of delayed-fix modes seen so far", "%",
                   ascending(std::move(found))});
  return lines;
}

const char* fix_word(FixClass fix) {
  switch (fix) {
    case FixClass::none:
      return "none (A)";
    case FixClass::during:
      return "during the test (BC)";
    case FixClass::delayed:
      return "after the test (BD)";
  }
  return "";
}

const char* fix_key(FixClass fix) {
  switch (fix) {
    case FixClass::none:
      return "none";
    case FixClass::during:
      return "during";
    case FixClass::delayed:
      return "delayed";
  }
  return "";
}

std::string counts_text(const GrowthTest& test) {
  return fmt::format(
      "{} failures of modes that are not fixed, {} of modes fixed during the test, {} of the {} "
      "modes with delayed fixes",
      test.failures(FixClass::none), test.failures(FixClass::during),
      test.failures(FixClass::delayed), test.of(FixClass::delayed).size());
}

present::Table projection_table(const Asked& asked, const GrowthTest& test,
                                const std::vector<ProjectionLine>& lines, bool with_crow) {
  present::Table table{
      "projection",
      fmt::format("Projection of delayed fixes at age {}, of one unit: {}",
                  age_text(asked.data, test.end), counts_text(test)),
      {{"Quantity"}, {"Unit"}, {"Median"}, {asked.interval_name(), "1", {}, true}}};
  if (with_crow) table.columns.push_back({"Crow's estimate"});
  for (const ProjectionLine& each : lines) {
    std::vector<present::Cell> row = {each.name, each.unit, each.known.quantile(0.5),
                                      present::Range{each.known.quantile(asked.outside()),
                                                     each.known.quantile(1 - asked.outside())}};
    if (with_crow) row.push_back(each.crow ? present::Cell{*each.crow} : present::Cell{});
    table.rows.push_back(std::move(row));
  }
  return table;
}

// Failures of one unit per unit of age, as observed.
double observed_rate(const Asked& asked, const GrowthTest& test, const FailureMode& mode) {
  return static_cast<double>(mode.ages.size()) / from_si(asked.data.unit, test.time());
}

present::Table mode_table(const Asked& asked, const GrowthTest& test) {
  const std::string per = fmt::format("failures per {}", asked.data.unit.text);
  present::Table table{"fixed-modes",
                       "Failure modes in the order of their first occurrence; failures of one unit "
                       "per age, as observed and with the effectiveness of a delayed fix",
                       {{"Mode"},
                        {"Fix"},
                        {"Failures", "1", present::given},
                        {"First at age", asked.data.unit.text, present::given},
                        {"Effectiveness", "1", present::digits(3)},
                        {per + ", observed"},
                        {per + ", after the fix"}}};
  for (const FailureMode& mode : test.modes) {
    const double rate = observed_rate(asked, test, mode);
    std::vector<present::Cell> row = {mode.name,
                                      fix_word(mode.fix),
                                      present::count(mode.ages.size()),
                                      from_si(asked.data.unit, mode.ages.front()),
                                      {},
                                      rate,
                                      {}};
    if (mode.fix == FixClass::delayed) {
      row[4] = mode.mean_effectiveness();
      row[6] = (1 - mode.mean_effectiveness()) * rate;
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::string projection_text(const Asked& asked, const GrowthTest& test,
                            const std::vector<ProjectionLine>& lines, bool with_crow) {
  std::vector<std::vector<std::string>> cells = {{"", "50 %", asked.interval_name()}};
  if (with_crow) cells[0].push_back("Crow");
  for (const ProjectionLine& each : lines) {
    std::vector<std::string> row = {"  " + printable_heading(each.name, each.unit),
                                    plain_number(each.known.quantile(0.5), 3),
                                    plain_range(each.known.quantile(asked.outside()),
                                                each.known.quantile(1 - asked.outside()), 3)};
    if (with_crow) row.push_back(each.crow ? plain_number(*each.crow) : "-");
    cells.push_back(std::move(row));
  }
  return fmt::format("\nProjection of delayed fixes at age {}\n", age_text(asked.data, test.end)) +
         text_table(cells) + wrapped(counts_text(test) + ".", 2, 4);
}

Json projection_json(const Asked& asked, const GrowthTest& test,
                     const std::vector<ProjectionLine>& lines,
                     const std::optional<CrowProjection>& crow) {
  Json json = {{"age", from_si(asked.data.unit, test.end)},
               {"mean_effectiveness", test.mean_effectiveness()},
               {"failures",
                {{"none", test.failures(FixClass::none)},
                 {"during", test.failures(FixClass::during)},
                 {"delayed", test.failures(FixClass::delayed)}}}};
  for (const ProjectionLine& each : lines) {
    Json& line = json[each.key];
    line = {{"unit", each.unit},
            {"q05", each.known.quantile(0.05)},
            {"q50", each.known.quantile(0.5)},
            {"q95", each.known.quantile(0.95)}};
    if (asked.levels && has_lower(asked.levels->sides))
      line["lower"] = each.known.quantile(asked.outside());
    if (asked.levels && has_upper(asked.levels->sides))
      line["upper"] = each.known.quantile(1 - asked.outside());
    if (crow && each.crow) line["crow"] = *each.crow;
  }
  json["modes"] = Json::array();
  for (const FailureMode& mode : test.modes) {
    json["modes"].push_back({{"mode", mode.name},
                             {"fix", fix_key(mode.fix)},
                             {"failures", mode.ages.size()},
                             {"first", from_si(asked.data.unit, mode.ages.front())}});
    if (mode.fix != FixClass::delayed) continue;
    json["modes"].back()["effectiveness"] = mode.mean_effectiveness();
    json["modes"].back()["stated"] = mode.stated;
  }
  return json;
}

html::Figure first_occurrences_figure(const Asked& asked, const GrowthTest& test,
                                      const ProjectionDraws& draws) {
  constexpr int points = 60;
  namespace colour = plot::colour;
  const Unit& unit = asked.data.unit;
  std::vector<double> age, low, middle, high, at = {0}, seen = {0};
  const std::size_t few = std::min(draws_of_band, draws.beta.size());
  for (int i = 0; i <= points; ++i) {
    const double share = static_cast<double>(i) / points;
    std::vector<double> modes;
    for (std::size_t s = 0; s < few; ++s)
      modes.push_back(share > 0 ? draws.modes[s] * std::pow(share, draws.beta[s]) : 0);
    const Sorted known = ascending(std::move(modes));
    age.push_back(from_si(unit, share * test.end));
    low.push_back(known.quantile(asked.outside()));
    middle.push_back(known.quantile(0.5));
    high.push_back(known.quantile(1 - asked.outside()));
  }
  for (const FailureMode* mode : test.of(FixClass::delayed)) {
    at.insert(at.end(), 2, from_si(unit, mode->ages.front()));
    seen.insert(seen.end(), {seen.back(), seen.back() + 1});
  }
  at.push_back(age.back());
  seen.push_back(seen.back());
  const std::string shown = html::unit(unit.text);
  return {"first-occurrences",
          "Failure modes with a delayed fix that have occurred until each age",
          fmt::format("Steps are the first occurrences in the test. The line is their power law, "
                      "posterior median with its {} band; its slope at the end is the rate of new "
                      "modes.",
                      asked.interval_name()),
          plot::plot("Cumulative number of failure modes with a delayed fix against age, seen and "
                     "fitted",
                     {"Age [" + shown + "]", false, 0, age.back()}, {"Failure modes", false, 0, {}},
                     {plot::area({{"x", age}, {"y", high}, {"y2", low}},
                                 {colour::posterior, asked.interval_name() + ", fitted", 0.28}),
                      plot::line({{"x", at}, {"y", seen}, {"failure modes", seen}},
                                 {colour::measured, "test", 1, 2}),
                      plot::line({{"x", age}, {"y", middle}, {"failure modes", middle}},
                                 {colour::posterior, "fitted", 1, 2})},
                     320, true),
          {},
          true};
}

std::vector<std::string> projection_notes(const Asked& asked, const GrowthTest& test,
                                          bool with_crow) {
  constexpr double surely = 0.95;
  std::vector<std::string> notes;
  if (asked.classical && !with_crow)
    notes.push_back(
        "Crow's estimate needs two modes with a delayed fix that occurred before the end of the "
        "test.");
  if (const double rising = probability_of_rising_discovery(test); rising > surely)
    notes.push_back(fmt::format(
        "New modes became more frequent towards the end of the test (probability {:.3g} %), which "
        "modes with a constant intensity do not: the projection is too optimistic if they wear out "
        "or if the test became harder.",
        100 * rising));
  return notes;
}

QuantityQuantiles quantiles_of_projection(const Sorted& known,
                                          const std::optional<LifeLevels>& levels) {
  QuantityQuantiles q{known.quantile(0.05), known.quantile(0.5), known.quantile(0.95), 0, 0, 0};
  if (levels) add_bounds(known, *levels, q);
  return q;
}

}  // namespace

void add_projection(const Asked& asked, const GrowthTest& test, PresetAddition& added) {
  const ProjectionDraws draws = projection_draws(test);
  const auto crow = asked.classical ? crow_projection(test) : std::nullopt;
  const std::vector<ProjectionLine> lines = lines_of(asked, draws, crow);
  std::vector<present::Block>& blocks = added.blocks["predictions"];
  blocks.push_back({projection_table(asked, test, lines, crow.has_value())});
  blocks.push_back({mode_table(asked, test)});
  blocks.push_back({present::Figures{{first_occurrences_figure(asked, test, draws)}}});
  added.text += projection_text(asked, test, lines, crow.has_value());
  for (const std::string& each : projection_notes(asked, test, crow.has_value())) {
    blocks.push_back({present::Prose{each}});
    added.text += wrapped(each, 2, 4);
  }
  added.body["repairable"]["projection"] = projection_json(asked, test, lines, crow);
}

void ask_projection(const Asked& asked, const GrowthTest& test, const std::string& unit,
                    PosteriorStudy& study) {
  const auto request = [&](const std::string& at) {
    QuantityRequest each{};
    each.name = "mean time between failures";
    each.of = unit;
    each.at = at;
    each.unit = asked.data.unit;
    each.safe_end = 0.05;
    if (asked.levels) ask_bounds(*asked.levels, each);
    return each;
  };
  QuantityRequest projected = request("after the delayed fixes");
  projected.headline = true;
  study.quantity_groups.push_back(
      {{projected, request("with all failure modes found (growth potential)")},
       [test, levels = asked.levels](const WeightedDraws&) {
         const ProjectionDraws draws = projection_draws(test);
         std::vector<QuantityQuantiles> all;
         const Unit si{"1", 1, 0};
         for (const Member member :
              {&ProjectedIntensity::projected, &ProjectedIntensity::potential})
           all.push_back(quantiles_of_projection(ascending(mtbf_of(draws, member, si)), levels));
         return all;
       }});
}

}  // namespace wearwell::recurrence
