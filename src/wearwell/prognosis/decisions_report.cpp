#include "wearwell/prognosis/decisions_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/prognosis/decisions_tables.h"
#include "wearwell/prognosis/plural.h"
#include "wearwell/prognosis/warranty_text.h"
#include "wearwell/study/trust_blocks.h"

// Longer than others: text, page and JSON have the same numbers.
namespace wearwell::prognosis {
namespace {

using present::Table;

std::string costs_text(const DecisionsReport& report) {
  const Shown shown{report};
  const Question& question = report.question;
  std::string text =
      fmt::format("a failure costs {}, a preventive replacement {}",
                  shown.money(question.costs.failure), shown.money(question.costs.replacement));
  if (question.inspected || question.hidden)
    text += fmt::format(", an inspection {}", shown.money(question.costs.inspection));
  if (question.hidden)
    text += fmt::format(", and an undetected failure {} {}",
                        plain_given(shown.rate(*question.hidden)), shown.rate_unit());
  return text;
}

std::string advice(const UnitDecision& each) {
  return each.best.after == 0 ? "now" : std::isfinite(each.best.after) ? "" : "at failure";
}

std::string answer(const DecisionsReport& report) {
  const Shown shown{report};
  const AgeReplacement& age = *report.decisions.age;
  if (!std::isfinite(age.age))
    return fmt::format(
        "Replace a {} when it fails: its risk does not grow enough with age for preventive "
        "replacement to pay.",
        report.lives.noun);
  if (age.beyond_known)
    return fmt::format("Replacing a {} before {}, the end of the known lives, saves nothing.",
                       report.lives.noun, shown.age(age.age));
  std::string text =
      fmt::format("Replace a {} at {}: {} in the long run", report.lives.noun, shown.age(age.age),
                  plain_quantity(shown.rate(age.rate), shown.rate_unit()));
  if (age.at_failure > 0)
    text += fmt::format(", {} less than replacement at failure only",
                        share_text(1 - age.rate / age.at_failure));
  return text + ".";
}

// Units that are known by their age alone, and as old as the age of least cost.
std::string past_optimum_text(const DecisionsReport& report) {
  std::size_t past = 0, waiting = 0;
  for (const UnitDecision& each : report.decisions.units) {
    past += each.past_optimum;
    waiting += each.past_optimum && each.best.after > 0;
  }
  if (past == 0) return "";
  const std::string named =
      past == 1 ? "1 " + report.lives.noun : fmt::format("{} {}", past, plural(report.lives.noun));
  std::string text =
      fmt::format("{} {} past the age of least cost, {}: ", named, past == 1 ? "is" : "are",
                  Shown{report}.age(report.decisions.age->age));
  if (waiting == 0) return text + "replace now.";
  if (waiting == past) return text + "replacement at failure costs least.";
  return text + fmt::format("for {}, replacement at failure costs least; replace the other{} now.",
                            waiting, past - waiting == 1 ? "" : "s");
}

// Empty if the policy rests on the whole posterior, or on enough of it.
std::string error_text(const DecisionsReport& report) {
  const AgeReplacement& age = *report.decisions.age;
  constexpr double least = 1e-3;
  if (!age.rate_error || (*age.rate_error < least && *age.age_error < least)) return "";
  const auto percent = [](double error) {
    return error < least ? std::string("below 0.1 %")
                         : "up to " + plain_number(100 * error, 2) + " %";
  };
  if (!std::isfinite(age.age) || *age.age_error >= 1)
    return fmt::format(
        "These numbers are sums over {} points of the posterior. Their error in the cost is {}{}.",
        report.lives.populations.size(), percent(*age.rate_error),
        *age.age_error >= 1 ? "; which age costs least is not determined" : "");
  return fmt::format(
      "These numbers are sums over {} points of the posterior. Their error in the age is {}, in "
      "the "
      "cost {}.",
      report.lives.populations.size(), percent(*age.age_error), percent(*age.rate_error));
}

std::string worth_text(const DecisionsReport& report) {
  const Shown shown{report};
  const WorthReport& asked = *report.worth;
  const InspectionWorth& worth = asked.worth;
  const std::string money = report.question.currency.empty() ? "" : " " + report.question.currency;
  return fmt::format(
      "A reading of {} of {} {} {} from now is worth {}{}: {} net of its cost. Its 90 % "
      "interval is {} to {} {}; with probability {} it leads you to replace the {}.",
      asked.column, report.lives.noun, asked.unit, shown.age(asked.after),
      plain_number(worth.worth, 3), money, plain_number(worth.net, 3),
      plain_number(from_si(asked.reading_unit, asked.outcomes[asked.outcomes.size() / 20].reading)),
      plain_number(
          from_si(asked.reading_unit,
                  asked.outcomes[asked.outcomes.size() - 1 - asked.outcomes.size() / 20].reading)),
      asked.reading_unit.text, share_text(worth.replaced), report.lives.noun);
}

std::vector<std::string> cells(const Table& table, const std::vector<present::Cell>& row) {
  std::vector<std::string> words;
  for (std::size_t c = 0; c < row.size(); ++c) {
    const double* number = std::get_if<double>(&row[c]);
    const auto* range = std::get_if<present::Range>(&row[c]);
    const std::string* text = std::get_if<std::string>(&row[c]);
    const auto said = [&](double x) {
      return std::isinf(x) ? std::string("never")
                           : present::description(x, table.columns[c].format, Script::terminal);
    };
    words.push_back(number  ? said(*number)
                    : range ? fmt::format("{} to {}", said(range->low), said(range->high))
                    : text  ? *text
                            : "");
  }
  return words;
}

std::string table_text(const Table& table, std::size_t most = 40) {
  std::vector<std::vector<std::string>> rows(1);
  for (const present::Column& each : table.columns) rows[0].push_back(present::heading(each));
  for (const auto& row : table.rows) {
    if (rows.size() > most) break;
    rows.push_back(cells(table, row));
  }
  std::string text = "\n" + table.caption + "\n" + text_table(rows);
  if (table.rows.size() > most) text += fmt::format("... and {} more\n", table.rows.size() - most);
  return text;
}

std::string how_counted(const DecisionsReport& report) {
  const FleetCounting& counting = report.decisions.counting;
  std::string text =
      "Each unit counts once: parts that fail again within that time are not counted. ";
  if (counting.populations > 0)
    return text + fmt::format(
                      "The population of the {} is uncertain: units are independent given each of "
                      "{} possible populations, and these are averaged by their posterior weights "
                      "(effective number {:.0f}).",
                      plural(report.lives.noun), counting.populations, counting.effective);
  return text + fmt::format(
                    "Units are counted as independent, since {}; uncertainty of their common "
                    "population would widen the intervals.",
                    counting.why_independent);
}

}  // namespace

std::vector<Check> decision_checks(const DecisionsReport& report) {
  std::vector<Check> checks;
  const Costs& costs = report.question.costs;
  if (!report.lives.trusted)
    checks.push_back({"study", Verdict::fail, "the study itself is not trusted",
                      "Look at its checks first: wearwell report."});
  if (report.decisions.age->beyond_known)
    checks.push_back(
        {"horizon", Verdict::warn,
         "some lives extend beyond the computed range: the long-run cost is that of replacement at "
         "its end",
         "Compute lives over a longer range, or read the result as: do not replace earlier."});
  std::size_t early = 0;
  for (const UnitDecision& each : report.decisions.units)
    early += each.best.after > 0 && std::isfinite(each.best.after) && each.best.failing <= 0;
  if (early > 0 || report.decisions.age->failing <= 0)
    checks.push_back(
        {"tail", Verdict::warn,
         fmt::format("no life is as short as the optimal time ({})",
                     early > 0 ? fmt::format("{} of {} units", early, report.decisions.units.size())
                               : "of a new one"),
         "These points do not determine the probability of such early failures; use more points, "
         "or weighted ones in the tail."});
  if (report.decisions.counting.outgrown)
    checks.push_back(
        {"population", Verdict::warn,
         fmt::format("the counts of the fleet assume independent {}: {}", plural(report.lives.noun),
                     report.decisions.counting.why_independent),
         "Intervals and spare parts are too narrow. Fit with these readings in the "
         "data (wearwell update) to update the population."});
  if (report.worth && std::abs(report.worth->worth.error) > 0.02)
    checks.push_back({"inspection", Verdict::warn,
                      fmt::format("the possible outcomes of the reading do not average to the "
                                  "present forecast; the probability of failure deviates by {:.2g}",
                                  report.worth->worth.error),
                      "Treat its value as approximate."});
  if (costs.failure <= costs.replacement)
    checks.push_back({"costs", Verdict::warn,
                      "a failure costs no more than a preventive replacement",
                      "Preventive replacement then saves nothing."});
  return checks;
}

std::string decisions_text(const DecisionsReport& report) {
  std::string text = wrapped(printable(report.lives.title), 0, 2) +
                     wrapped(printable(costs_text(report)), 2, 4) + "\n" +
                     wrapped(printable(answer(report)), 0, 2) + table_text(policies_table(report));
  if (const std::string error = error_text(report); !error.empty())
    text += wrapped(printable(error), 2, 2);
  if (report.decisions.warranty) text += "\n" + wrapped(printable(warranty_text(report)), 0, 2);
  if (!report.decisions.units.empty()) {
    text += table_text(units_table(report));
    if (const std::string past = past_optimum_text(report); !past.empty())
      text += wrapped(printable(past), 2, 2);
  }
  if (!report.decisions.months.empty())
    text += table_text(months_table(report)) + wrapped(printable(how_counted(report)), 2, 2);
  if (report.worth) text += "\n" + wrapped(printable(worth_text(report)), 0, 2);
  const std::vector<Check> checks = decision_checks(report);
  if (!checks.empty()) text += "\nChecks\n";
  text += checks_text(checks);
  return text;
}

std::vector<present::Section> decisions_sections(const DecisionsReport& report) {
  present::Section policy{"policy", "Policy"};
  policy.add(present::Prose{answer(report), true});
  policy.add(present::Prose{html::capital(costs_text(report)) + "."});
  if (report.decisions.warranty) policy.add(present::Prose{warranty_text(report), true});
  for (const Check& check : decision_checks(report))
    policy.add(present::Callout{verdict_kind(check.verdict), check.name,
                                check.detail + ". " + check.advice});
  policy.add(present::Figures{{cost_figure(report)}});
  policy.add(policies_table(report));
  if (const std::string error = error_text(report); !error.empty())
    policy.add(present::Prose{error});
  std::vector<present::Section> sections = {policy};
  if (!report.decisions.units.empty()) {
    present::Section units{"units", html::capital(plural(report.lives.noun))};
    units.add(
        present::Prose{"Replace after: the time of least cost, given the long-run cost of use in "
                       "the fleet. Waiting saves: compared with replacement now."});
    if (const std::string past = past_optimum_text(report); !past.empty())
      units.add(present::Prose{past, true});
    if (report.worth) units.add(present::Prose{worth_text(report)});
    units.add(units_table(report));
    sections.push_back(units);
  }
  if (!report.decisions.months.empty()) {
    present::Section fleet{"fleet", "Fleet"};
    fleet.add(present::Figures{{months_figure(report)}});
    fleet.add(present::Prose{how_counted(report)});
    fleet.add(months_table(report));
    sections.push_back(fleet);
  }
  return sections;
}

nlohmann::ordered_json decisions_json(const DecisionsReport& report) {
  using Json = nlohmann::ordered_json;
  const Shown shown{report};
  const Decisions& decisions = report.decisions;
  const Question& question = report.question;
  const AgeReplacement& age = *decisions.age;
  const auto finite = [](double x) { return std::isfinite(x) ? Json(x) : Json(); };
  Json json = {
      {"title", report.lives.title},
      {"trusted", report.lives.trusted},
      {"unit", shown.unit()},
      {"currency", question.currency.empty() ? Json() : Json(question.currency)},
      {"costs",
       {{"failure", question.costs.failure}, {"replacement", question.costs.replacement}}}};
  if (question.inspected || question.hidden)
    json["costs"]["inspection"] = question.costs.inspection;
  if (question.hidden) json["costs"]["hidden"] = shown.rate(*question.hidden);
  json["age"] = {{"at", finite(shown.at(age.age))},
                 {"cost", shown.rate(age.rate)},
                 {"from", finite(shown.at(age.from))},
                 {"to", finite(shown.at(age.to))},
                 {"failing", age.failing},
                 {"beyond_known", age.beyond_known}};
  if (age.rate_error) {
    json["age"]["age_error"] = *age.age_error;
    json["age"]["cost_error"] = *age.rate_error;
  }
  json["at_failure"] = {{"cost", shown.rate(age.at_failure)}};
  if (decisions.inspection) {
    const InspectionInterval& best = *decisions.inspection;
    json["inspection"] = {{"hidden_failures", question.hidden.has_value()},
                          {"interval", finite(shown.at(best.interval))},
                          {"cost", shown.rate(best.rate)},
                          {"from", finite(shown.at(best.from))},
                          {"to", finite(shown.at(best.to))},
                          {"inspections", best.inspections},
                          {"failing", best.failing}};
  }
  if (decisions.warranty) {
    const Warranty& warranty = *decisions.warranty;
    json["warranty"] = {{"share", warranty.share},
                        {"length", finite(shown.at(warranty.length))},
                        {"sure", finite(shown.at(warranty.sure))}};
    if (warranty.populations > 0) json["warranty"]["populations"] = warranty.populations;
    if (warranty.error) json["warranty"]["error"] = *warranty.error;
  }
  Json units = Json::array();
  for (const UnitDecision& each : decisions.units)
    units.push_back({{"unit", each.unit->name},
                     {"now", finite(shown.at(each.unit->now))},
                     {"q05", finite(shown.at(each.q05))},
                     {"q50", finite(shown.at(each.q50))},
                     {"q95", finite(shown.at(each.q95))},
                     {"passed", each.unit->passed},
                     {"past_optimum", each.past_optimum},
                     {"decision", advice(each).empty() ? "later" : advice(each)},
                     {"replace_after", finite(shown.at(each.best.after))},
                     {"failing", each.best.failing},
                     {"waiting_saves", finite(each.best.now - each.best.cost)}});
  json["units"] = std::move(units);
  Json months = Json::array();
  for (const FleetMonth& each : decisions.months)
    months.push_back({{"month", each.month},
                      {"until", shown.at(each.until)},
                      {"expected", mean(each.reached)},
                      {"q05", each.low},
                      {"q95", each.high},
                      {"parts", each.parts},
                      {"parts_planned", each.parts_planned}});
  if (report.worth) {
    const WorthReport& asked = *report.worth;
    json["inspection_ahead"] = {{"unit", asked.unit},        {"after", shown.at(asked.after)},
                                {"reads", asked.column},     {"worth", asked.worth.worth},
                                {"net", asked.worth.net},    {"replaced", asked.worth.replaced},
                                {"error", asked.worth.error}};
  }
  if (!decisions.months.empty()) {
    const FleetCounting& counting = decisions.counting;
    json["counting"] = {{"independent", counting.populations == 0}};
    if (counting.populations > 0) {
      json["counting"]["populations"] = counting.populations;
      json["counting"]["effective"] = counting.effective;
    } else {
      json["counting"]["why"] = counting.why_independent;
    }
  }
  json["service"] = question.service;
  json["months"] = std::move(months);
  Json checks = Json::array();
  static constexpr const char* words[] = {"pass", "warn", "fail"};
  for (const Check& each : decision_checks(report))
    checks.push_back({{"name", each.name},
                      {"verdict", words[static_cast<int>(each.verdict)]},
                      {"detail", each.detail}});
  json["checks"] = std::move(checks);
  return json;
}

}  // namespace wearwell::prognosis
