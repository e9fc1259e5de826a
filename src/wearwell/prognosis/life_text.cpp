#include "wearwell/prognosis/life_text.h"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <utility>

#include "wearwell/base/printable.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::prognosis {
namespace {

using nlohmann::ordered_json;

// 0.93 instead of 0.9299999999999999.
double survival(double share) {
  constexpr double digits = 1e12;
  return std::round((1 - share) * digits) / digits;
}

}  // namespace

ordered_json life_json(const UnitLife& life, const LifeBounds& bounds, const LifeReadings& moved,
                       bool trusted) {
  ordered_json json = {{"of", life.of},
                       {"name", life.name},
                       {"at", life.at},
                       {"unit", life.unit},
                       {"trusted", trusted}};
  if (life.from) json["from"] = *life.from;
  if (life.passed) json["passed"] = *life.passed;
  if (life.never) json["never"] = *life.never;
  for (const auto& [key, p] : {std::pair{"q05", 0.05},
                               {"q50", 0.5},
                               {"q95", 0.95},
                               {"b1", 0.01},
                               {"b10", 0.1},
                               {"b50", 0.5}})
    json[key] = life.quantile(p);
  if (life.numerical_error) json["numerical_error"] = *life.numerical_error;
  if (bounds.asked) json.update(bounds_json(life, bounds));
  json["risk"] = life.risk;
  json["inspect_within"] = life.inspect_within;
  if (life.horizon) json["horizon"] = {{"within", *life.horizon}, {"reached", *life.reached}};
  json["survival"] = ordered_json::array();
  for (std::size_t i = 0; i < life.share.size(); ++i)
    json["survival"].push_back({{"life", life.life[i]}, {"survival", survival(life.share[i])}});
  if (moved.how.empty()) return json;
  json["readings"] = {{"counted", moved.counted},
                      {"repeated", moved.repeated},
                      {"how", moved.how},
                      {"contradictions", ordered_json::array()}};
  for (const Contradiction& each : moved.contradictions)
    json["readings"]["contradictions"].push_back({{"place", each.place}, {"why", each.why}});
  return json;
}

present::Table survival_table(const UnitLife& life) {
  present::Table table{
      "survival", "Survival", {{life.name, life.unit, present::life()}, {"survival", "1"}}};
  for (std::size_t i = 0; i < life.share.size(); ++i)
    table.rows.push_back({life.life[i], survival(life.share[i])});
  return table;
}

std::string life_text(const UnitLife& life, const LifeBounds& bounds, const LifeReadings& moved,
                      bool trusted) {
  std::string out;
  const auto add = [&]<class... Values>(fmt::format_string<Values...> form, Values&&... values) {
    out += fmt::format(form, std::forward<Values>(values)...);
  };
  const std::string unit = printable(unit_description(life.unit, Script::terminal));
  const int digits = digits_within(life.numerical_error.value_or(0));
  const auto shown = [&](double value) {
    return std::isfinite(value) ? plain_number(value, digits) : std::string("never");
  };
  if (!trusted)
    add("Not trusted: a check of the fit failed; wearwell report or the summary names it.\n");
  add("{} of {} {}\n", life.name == "life" ? "Life" : "Remaining useful life", life.of, life.at);
  if (life.from) {
    const double place = std::strtod(fmt::format("{:.6g}", *life.from).c_str(), nullptr);
    add("  counted from {} {}\n", plain_given(place), unit);
  }
  if (!moved.how.empty())
    add("  with {} new reading{} ({} known already); {}\n", moved.counted,
        moved.counted == 1 ? "" : "s", moved.repeated, moved.how);
  if (life.passed)
    add("  probability of an earlier end: {}; given no earlier end:\n",
        probability_text(*life.passed));
  if (life.never) add("  probability that it never ends: {}\n", probability_text(*life.never));
  for (const Contradiction& each : moved.contradictions)
    add("  check {}: {}\n", each.place, each.why);
  const auto with_unit = [&](double value) {
    return std::isfinite(value) ? shown(value) + " " + unit : shown(value);
  };
  add("  median {}, {} to {} (90 %)\n", with_unit(life.quantile(0.5)), shown(life.quantile(0.05)),
      with_unit(life.quantile(0.95)));
  if (bounds.asked) add("  {}\n", bound_text(life, bounds.levels, with_unit));
  add("  B1 {}   B10 {}   B50 {}\n", shown(life.quantile(0.01)), shown(life.quantile(0.1)),
      shown(life.quantile(0.5)));
  if (life.numerical_error.value_or(0) > least_numerical_error)
    add("  numerical error of these lives: {} %\n", plain_number(100 * *life.numerical_error, 2));
  if (life.horizon)
    add("  probability of reaching the end within {} {}: {}\n", plain_given(*life.horizon), unit,
        probability_text(*life.reached));
  if (std::isfinite(life.inspect_within))
    add("  inspect again within {}: {} risk of reaching the end before\n",
        with_unit(life.inspect_within), probability_text(life.risk));
  else
    add("  no inspection is due: the risk of ever reaching the end is below {}\n",
        probability_text(life.risk));
  return out;
}

}  // namespace wearwell::prognosis
