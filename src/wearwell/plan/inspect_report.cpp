#include "wearwell/plan/inspect_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/prognosis/plural.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::plan {
namespace {

std::string inspect_percent(double share) {
  if (share > 0 && share < 0.0001) return "< 0.01 %";
  return fmt::format("{:.3g} %", 100 * share);
}

std::string use_text(const InspectReport& report, double si) {
  return plain_quantity(si / report.lives->unit.scale, report.lives->unit.text);
}

std::string money_text(const InspectReport& report, double amount) {
  return plain_number(amount) + (report.currency.empty() ? "" : " " + report.currency);
}

std::string unit_name(const InspectReport& report, const UnitInspections& unit) {
  return unit.name.empty() ? "a new " + report.lives->noun : report.lives->noun + " " + unit.name;
}

std::string times_word(std::size_t count) {
  return count == 1 ? "once" : fmt::format("{} times", count);
}

std::string asked_text(const InspectReport& report) {
  std::string text;
  if (report.risk)
    text = fmt::format("risk between inspections at most {}", inspect_percent(*report.risk));
  if (report.total)
    text += fmt::format("{}failures that no inspection foresees at most {}",
                        text.empty() ? "" : "; ", inspect_percent(*report.total));
  if (report.aim == InspectAim::cheapest)
    text += fmt::format("{}least expected cost", text.empty() ? "" : "; ");
  text += fmt::format("; until {} from now", use_text(report, report.until));
  if (!report.until_given) text += " (half have reached the threshold)";
  if (report.step > 0) text += fmt::format("; at multiples of {}", use_text(report, report.step));
  return text;
}

std::string unit_answer(const InspectReport& report) {
  const UnitInspections& unit = report.units[0];
  const std::string until = use_text(report, unit.bounds.until);
  if (unit.times.empty())
    return fmt::format("Inspect {} not before {} from now: {}.", unit_name(report, unit), until,
                       report.aim == InspectAim::cheapest ? "no inspection before is worth its cost"
                                                          : "the risk until then is small enough");
  const std::string first =
      unit.times[0] == 0 ? "now" : fmt::format("{} from now", use_text(report, unit.times[0]));
  std::string text = fmt::format("Inspect {} {} until {}, first {}.", unit_name(report, unit),
                                 times_word(unit.times.size()), until, first);
  if (report.aim == InspectAim::fewest) text += " No plan with fewer inspections keeps this risk.";
  if (report.aim == InspectAim::total_risk)
    text += fmt::format(
        " Failures that no inspection foresees: {}.",
        inspect_percent(unforeseen(unit.life, unit.times, unit.bounds.until, *report.warning)));
  if (!unit.cost) return text;
  text += fmt::format(" Expected cost {}", money_text(report, unit.cost->total));
  for (const OtherPlan& each : unit.others)
    text += fmt::format(", {} {}", each.name, money_text(report, each.cost.total));
  return text + ".";
}

std::string fleet_answer(const InspectReport& report) {
  std::size_t inspections = 0, past = 0;
  for (const UnitInspections& each : report.units) {
    inspections += each.times.size();
    past += each.past;
  }
  const std::string& noun = report.lives->noun;
  const std::string nouns = prognosis::plural(noun);
  std::string text =
      report.visits.empty()
          ? fmt::format("No inspection is needed until {} from now.",
                        use_text(report, report.until))
          : fmt::format(
                "{} visit{} with {} inspections of {} {} until {} from now; the first {}.",
                report.visits.size(), report.visits.size() == 1 ? "" : "s", inspections,
                report.units.size() - past, nouns, use_text(report, report.until),
                report.visits[0] == 0 ? "now" : "after " + use_text(report, report.visits[0]));
  if (report.aim == InspectAim::fewest)
    text += fmt::format(
        " No plan with fewer visits keeps the risk of every {}; {} planned one by one would "
        "need {} visits.",
        noun, nouns, report.alone_visits);
  if (report.joint)
    text += fmt::format(
        " Expected cost {}, visits included; no plan at the examined times costs less than {}.",
        money_text(report, report.joint->total), money_text(report, report.joint->least_possible));
  if (past > 0)
    text += fmt::format(" {} {} more likely than not past the threshold: replace or inspect now.",
                        past, past == 1 ? noun + " is" : nouns + " are");
  return text;
}

std::vector<std::string> assumptions(const InspectReport& report) {
  std::vector<std::string> all;
  const std::string& noun = report.lives->noun;
  if (report.aim == InspectAim::cheapest && report.prices.downtime)
    all.push_back(fmt::format(
        "Failures are hidden: an inspection shows only whether the {} has failed. After a failure "
        "is found nothing more is inspected; at the end of the plan the state is known.",
        noun));
  else if (report.aim == InspectAim::cheapest)
    all.push_back(fmt::format(
        "An inspection shows without error a failure that comes {} after it; the {} is then "
        "replaced at the last inspection before. Gauges do worse, so this is a lower bound on the "
        "cost. Use that an early replacement loses is valued at the long-run cost of replacement "
        "by "
        "age, {}/{}.",
        report.warning ? "within " + use_text(report, *report.warning) : "at any time", noun,
        money_text(report, report.prices.use * report.lives->unit.scale), report.lives->unit.text));
  else if (report.aim == InspectAim::total_risk)
    all.push_back(
        fmt::format("An inspection shows a failure that comes within {} after it, and no other.",
                    use_text(report, *report.warning)));
  else
    all.push_back(fmt::format(
        "An inspection shows whether the {} has reached its threshold. The risk of an interval is "
        "given that the inspection before finds it running.",
        noun));
  all.push_back(fmt::format(
      "These times follow from what is known now, averaged over the uncertainty of the {} and its "
      "population. A reading narrows the forecast: plan again after each.",
      noun));
  if (report.fleet)
    all.push_back(fmt::format(
        "Visits are at the same further use of every {0}. {1} Survival of one {0} does not change "
        "the plan of another.",
        noun, report.counted));
  if (std::any_of(report.units.begin(), report.units.end(),
                  [](const auto& each) { return each.shorter; }))
    all.push_back(fmt::format("{} plan ends earlier, where 95 % have reached the threshold.",
                              report.fleet ? "A " + noun + "'s" : "The"));
  return all;
}

double outcome(const std::vector<double>& sorted, double p) {
  const auto at = static_cast<std::size_t>(p * static_cast<double>(sorted.size()));
  return sorted[std::min(at, sorted.size() - 1)];
}

std::string next_text(const InspectReport& report) {
  const NextIntervals& next = *report.next;
  std::vector<double> interval = next.interval;
  std::sort(interval.begin(), interval.end());
  const auto use = [&](double si) {
    return std::isfinite(si) ? use_text(report, si) : std::string("never");
  };
  const auto now = std::count_if(interval.begin(), interval.end(), [](double x) { return x <= 0; });
  std::string text = fmt::format(
      "A reading of {} at the first inspection moves the second one: {} after it by present "
      "knowledge, then {} to {} (90 % of possible readings, median {}).",
      next.column, use(next.planned), use(outcome(interval, 0.05)), use(outcome(interval, 0.95)),
      use(outcome(interval, 0.5)));
  if (now > 0)
    text += fmt::format(
        " With probability {} it leaves no interval at all.",
        inspect_percent(static_cast<double>(now) / static_cast<double>(interval.size())));
  return text;
}

std::string short_table(const present::Table& table) {
  constexpr std::size_t most = 25;
  if (table.rows.size() <= most) return "\n" + present::text(table);
  present::Table few = table;
  few.rows.resize(most);
  return "\n" + present::text(few) +
         fmt::format("  ... and {} more rows: -o writes all to tables/{}.csv\n",
                     table.rows.size() - most, table.id);
}

std::vector<present::Table> tables_of(const InspectReport& report) {
  if (report.fleet) {
    std::vector<present::Table> tables = {inspected_units_table(report)};
    if (!report.visits.empty()) tables.insert(tables.begin(), visits_table(report));
    return tables;
  }
  std::vector<present::Table> tables = {inspections_table(report, report.units[0])};
  if (report.units[0].cost) tables.push_back(costs_table(report, report.units[0]));
  return tables;
}

std::string inspect_text(const InspectReport& report) {
  std::string text =
      wrapped(printable(report.lives->title), 0, 2) + wrapped(asked_text(report), 2, 4) + "\n" +
      wrapped(printable(report.fleet ? fleet_answer(report) : unit_answer(report)), 0, 2);
  for (const present::Table& each : tables_of(report)) text += short_table(each);
  if (report.next) text += "\n" + wrapped(printable(next_text(report)), 0, 2);
  if (!report.no_next.empty())
    text += "\n" + wrapped("How the next reading moves the plan is not computed: " +
                               printable(report.no_next) + ".",
                           0, 2);
  text += "\n";
  for (const std::string& each : assumptions(report)) text += wrapped(printable(each), 0, 2);
  const std::vector<Check> checks = inspect_checks(report);
  if (!checks.empty()) text += "\nChecks\n";
  text += checks_text(checks);
  return text;
}

std::vector<present::Section> inspect_sections(const InspectReport& report) {
  present::Section plan{"plan", "Inspections"};
  plan.add(present::Prose{report.fleet ? fleet_answer(report) : unit_answer(report), true});
  plan.add(present::Prose{html::capital(asked_text(report)) + "."});
  for (const Check& check : inspect_checks(report))
    plan.add(present::Callout{verdict_kind(check.verdict), check.name,
                              check.detail + ". " + check.advice});
  if (report.fleet) {
    plan.add(present::Figures{{visits_figure(report)}});
  } else {
    const UnitInspections& unit = report.units[0];
    plan.add(present::Figures{{interval_risk_figure(report, unit), reached_figure(report, unit)}});
  }
  for (present::Table& each : tables_of(report)) plan.add(std::move(each));
  std::vector<present::Section> sections = {plan};
  if (report.next) {
    present::Section next{"next", "Next reading"};
    next.add(present::Prose{next_text(report)});
    next.add(present::Figures{{next_figure(report)}});
    sections.push_back(next);
  }
  present::Section basis{"assumptions", "Assumptions"};
  for (const std::string& each : assumptions(report)) basis.add(present::Prose{each});
  sections.push_back(basis);
  return sections;
}

}  // namespace

std::vector<Check> inspect_checks(const InspectReport& report) {
  std::vector<Check> checks;
  if (!report.lives->trusted)
    checks.push_back({"study", Verdict::fail, "the study itself is not trusted",
                      "Look at its checks first: wearwell report."});
  constexpr std::size_t few = 5;
  std::size_t poor = 0, all = 0;
  for (const UnitInspections& each : report.units) {
    double before = 0;
    for (const double time : each.times) {
      ++all;
      poor += time > 0 && each.life.points(before, time) < few;
      before = time;
    }
  }
  if (poor > 0)
    checks.push_back({"points", Verdict::warn,
                      fmt::format("fewer than {} points of the distribution lie in {} of {} "
                                  "intervals; their risk is interpolated",
                                  few, poor, all),
                      "Use more points, or weighted ones in the tail."});
  return checks;
}

Answer inspect_answer(const InspectReport& report) {
  Answer answer;
  answer.title = report.fleet ? report.lives->title
                              : report.lives->title + ", " + unit_name(report, report.units[0]);
  answer.text = inspect_text(report);
  answer.sections = inspect_sections(report);
  answer.json = inspect_json(report);
  answer.trusted = report.lives->trusted;
  return answer;
}

}  // namespace wearwell::plan
