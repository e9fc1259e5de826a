#include "wearwell/prognosis/backtest_report.h"

#include <fmt/format.h>

#include <vector>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/table.h"
#include "wearwell/present/text_table.h"

namespace wearwell::prognosis {

std::string backtest_text(const Backtest& test, const Tracker& tracker) {
  std::string text = wrapped(fmt::format(
      "{} readings of {} {}s: {} repeated and counted once, {} refused, {} that contradict earlier "
      "ones",
      test.readings, test.units, tracker.noun(), test.repeated, test.refused, test.contradicting));
  if (test.refused > 0) text += wrapped("first refused: " + printable(test.first_refused), 2, 4);
  if (test.without_life > 0)
    text += fmt::format("{} {}s have no observed end yet and do not count\n", test.without_life,
                        tracker.noun());
  std::vector<std::vector<std::string>> rows = {{"readings so far", tracker.noun() + "s",
                                                 "forecasts", "covered", "coverage [%]",
                                                 "by chance [%]", "width", "error"}};
  for (const HeldAt& each : test.ages)
    rows.push_back({"  " + each.age, fmt::format("{}", each.units),
                    fmt::format("{}", each.forecasts), fmt::format("{}", each.held),
                    fmt::format("{:.1f}", 100. * static_cast<double>(each.held) /
                                              static_cast<double>(each.forecasts)),
                    fmt::format("{:.1f} to {:.1f}", 100 * each.low, 100 * each.high),
                    plain_number(each.width, 2), plain_number(each.error, 2)});
  return text + "\nForecasts of remaining useful life against the observed end\n" +
         text_table(rows) +
         wrapped(
             "Covered: by the 90 % interval. Forecasts of one unit are correlated, so the range by "
             "chance counts units, not "
             "forecasts. Width and error are medians, relative to the true remaining useful life.",
             2, 2);
}

nlohmann::ordered_json backtest_json(const Backtest& test) {
  nlohmann::ordered_json json = {
      {"readings", test.readings},           {"units", test.units},
      {"repeated", test.repeated},           {"refused", test.refused},
      {"contradicting", test.contradicting}, {"without_life", test.without_life}};
  auto ages = nlohmann::ordered_json::array();
  for (const HeldAt& each : test.ages)
    ages.push_back({{"readings", each.age},
                    {"units", each.units},
                    {"forecasts", each.forecasts},
                    {"held", each.held},
                    {"low", each.low},
                    {"high", each.high},
                    {"width", each.width},
                    {"error", each.error}});
  json["ages"] = std::move(ages);
  return json;
}

std::string backtest_csv(const Backtest& test, const Tracker& tracker) {
  const Unit& unit = tracker.axis().unit;
  present::Table table{"forecasts",
                       "Forecasts",
                       {{tracker.noun()},
                        {"readings"},
                        {tracker.axis().name, unit.text},
                        {"life", unit.text},
                        {"q05", unit.text},
                        {"q50", unit.text},
                        {"q95", unit.text},
                        {"place"}}};
  for (const Hindcast& each : test.hindcasts)
    table.rows.push_back({each.unit, present::count(each.readings), from_si(unit, each.at),
                          from_si(unit, each.life), from_si(unit, each.q05),
                          from_si(unit, each.q50), from_si(unit, each.q95), each.place});
  return present::csv(table);
}

}  // namespace wearwell::prognosis
