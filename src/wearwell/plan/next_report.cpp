#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/plan/next_plan.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::plan {
namespace {

constexpr std::size_t most_in_terminal = 15;

std::string unit_after(const Unit& unit) {
  return unit.text == "1" ? "" : " " + unit.text;
}

// "factor 2.27", or "31 MPa".
std::string width_text(const NextPlan& plan, double width) {
  return plan.logarithmic ? fmt::format("factor {}", plain_number(std::exp(width), 3))
                          : fmt::format("{}{}", plain_number(width, 3), unit_after(plan.goal.unit));
}

std::string present_text(const NextPlan& plan) {
  const auto [factor, unit] = plain_unit(plan.goal.unit.text);
  const std::string done = plan.tests_done > 0
                               ? fmt::format(" (with {} test{} since the fit)", plan.tests_done,
                                             plan.tests_done == 1 ? "" : "s")
                               : "";
  return fmt::format(
      "{}{}: {}, 90 % interval {}{} ({})", plan.goal.name, done,
      plain_number(factor * plan.in_unit(plan.now.median)),
      plain_range(factor * plan.in_unit(plan.now.low), factor * plan.in_unit(plan.now.high)),
      unit == "1" ? "" : " " + unit, width_text(plan, plan.now.width()));
}

std::string specimens_text(const Candidate& candidate) {
  const int count = candidate.specimens;
  if (!candidate.unit.empty()) return "one reading";
  return count == 1 ? "one specimen" : fmt::format("{} specimens", count);
}

std::string with_error(double percent, double error) {
  if (error < 0.05) return fmt::format("{:.3g} %", percent);
  return fmt::format("{:.3g} +- {:.1g} %", percent, error);
}

std::string best_text(const NextPlan& plan) {
  if (!plan.worth_it) return plan.why_not;
  const Judged& best = plan.judged.front();
  std::string text =
      fmt::format("Test next: {}, {}. Its expected narrowing of the interval is {}, to {}.",
                  best.candidate.name, specimens_text(best.candidate),
                  with_error(100 * best.narrowing, 100 * best.narrowing_error),
                  width_text(plan, plan.expected_width(best.narrowing)));
  if (plan.loss)
    text += fmt::format(" It is expected to save {} of the cost.",
                        with_error(100 * plan.loss->share(best.gain.saved),
                                   100 * plan.loss->share(best.gain.saved_error)));
  if (!best.candidate.outside.empty())
    text += fmt::format(" It is an extrapolation: {}.", fmt::join(best.candidate.outside, "; "));
  return text;
}

std::string batch_text(const NextPlan& plan) {
  const ChosenBatch& batch = *plan.batch;
  if (batch.chosen.empty()) return "No batch: no candidate is within the budget, or none helps.";
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < batch.chosen.size();) {
    std::size_t end = i;
    while (end < batch.chosen.size() && batch.chosen[end] == batch.chosen[i]) ++end;
    const Candidate& each = plan.judged[batch.chosen[i]].candidate;
    const std::size_t specimens = (end - i) * static_cast<std::size_t>(each.specimens);
    parts.push_back(fmt::format("{} x {}", specimens, each.name));
    i = end;
  }
  std::string text =
      fmt::format("Together: {}. Expected narrowing {}, to {}", fmt::join(parts, "; "),
                  with_error(100 * batch.narrowing, 100 * batch.narrowing_error),
                  width_text(plan, plan.expected_width(batch.narrowing)));
  if (batch.cost)
    text += fmt::format(", for {}{}", plain_number(*batch.cost),
                        plan.currency.empty() ? "" : " " + plan.currency);
  text += ".";
  if (batch.shortlist < plan.judged.size())
    text += fmt::format(
        " Considered were the {} candidates of {} with the highest gain, or gain "
        "per cost.",
        batch.shortlist, plan.judged.size());
  return text;
}

std::string target_text(const NextPlan& plan) {
  const Target& target = *plan.target;
  if (target.reached)
    return fmt::format("Reached: the interval ({}) is within '{}'; no further test is needed.",
                       width_text(plan, plan.now.width()), target.text);
  if (!target.tests)
    return fmt::format(
        "'{}' is not reached: it takes more than {} further specimens of the best "
        "candidate.",
        target.text, target.most);
  return fmt::format(
      "'{}' is not reached: about {} further specimen{} of the best candidate bring "
      "the expected width there.",
      target.text, *target.tests, *target.tests == 1 ? "" : "s");
}

// A column of the table of candidates.
struct CandidateColumn {
  present::Column column;
  std::function<present::Cell(const Judged&)> cell;
};

CandidateColumn per_cost(const NextPlan& plan) {
  if (plan.loss) {
    const double factor = plan.loss->fleet_use > 0 ? plan.loss->fleet_use : 100 / plan.loss->now;
    return {{"saving per cost", "1", present::digits(3)},
            [factor](const Judged& each) { return factor * each.gain.saved / *each.cost; }};
  }
  return {{"narrowing per cost", "1", present::digits(3)},
          [](const Judged& each) { return 100 * each.narrowing / *each.cost; }};
}

CandidateColumn narrowing_column() {
  return {{"narrowing", "%", present::digits(3)},
          [](const Judged& each) { return 100 * each.narrowing; }};
}

// What the interval of the goal is expected to be.
void add_interval(const NextPlan& plan, std::vector<CandidateColumn>& all) {
  const auto has_error = [](const Judged& each) { return each.narrowing_error > 5e-5; };
  if (std::any_of(plan.judged.begin(), plan.judged.end(), has_error))
    all.push_back({{"error", "%", present::digits(1)}, [has_error](const Judged& each) {
                     return has_error(each) ? present::Cell(100 * each.narrowing_error)
                                            : present::Cell();
                   }});
  all.push_back({{plan.logarithmic ? "expected factor" : "expected width",
                  plan.logarithmic ? "1" : plan.goal.unit.text, present::digits(3)},
                 [&plan](const Judged& each) {
                   const double width = plan.expected_width(each.narrowing);
                   return plan.logarithmic ? std::exp(width) : width;
                 }});
}

// What the ranking goes by stands first.
std::vector<CandidateColumn> candidate_columns(const NextPlan& plan) {
  const bool costs = plan.judged.front().cost.has_value();
  const std::string currency = plan.currency.empty() ? "1" : plan.currency;
  std::vector<CandidateColumn> all = {
      {{"candidate"}, [](const Judged& each) { return each.candidate.name; }},
      {{"specimens", "1", present::given},
       [](const Judged& each) { return static_cast<double>(each.candidate.specimens); }}};
  if (plan.loss)
    all.push_back({{"cost saved", "%", present::digits(3)},
                   [&](const Judged& each) { return 100 * plan.loss->share(each.gain.saved); }});
  if (plan.loss && plan.loss->fleet_use > 0)
    all.push_back({{"saving", currency, present::digits(4)},
                   [&](const Judged& each) { return plan.loss->saved(each.gain.saved); }});
  if (!plan.loss) {
    all.push_back(narrowing_column());
    add_interval(plan, all);
  }
  if (costs) {
    all.push_back(
        {{"cost", currency, present::digits(4)}, [](const Judged& each) { return *each.cost; }});
    all.push_back(per_cost(plan));
  }
  if (plan.loss)
    all.push_back(narrowing_column());
  else
    all.push_back({{"variance left", "%", present::digits(3)},
                   [](const Judged& each) { return 100 * each.variance_share; }});
  all.push_back({{"information", "nat", present::digits(3)},
                 [](const Judged& each) { return each.gain.information; }});
  if (!plan.use_unit.empty())
    all.push_back({{"expected test", plan.use_unit, present::digits(3)},
                   [](const Judged& each) { return each.gain.use; }});
  const auto stops = [](const Judged& each) { return each.candidate.stop.has_value(); };
  if (std::any_of(plan.judged.begin(), plan.judged.end(), stops))
    all.push_back({{"run-outs", "%", present::digits(3)}, [stops](const Judged& each) {
                     return stops(each) ? present::Cell(100 * each.gain.runout) : present::Cell();
                   }});
  all.push_back({{"note"}, [](const Judged& each) {
                   return each.candidate.outside.empty() ? std::string()
                                                         : std::string("extrapolation");
                 }});
  return all;
}

present::Table candidates_table(const NextPlan& plan) {
  present::Table table{"candidates", "Candidates, best first", {}};
  const std::vector<CandidateColumn> columns = candidate_columns(plan);
  for (const CandidateColumn& each : columns) table.columns.push_back(each.column);
  for (const Judged& judged : plan.judged) {
    table.rows.emplace_back();
    for (const CandidateColumn& each : columns) table.rows.back().push_back(each.cell(judged));
  }
  return table;
}

std::string next_table_text(const present::Table& table) {
  std::vector<std::vector<std::string>> rows(1);
  std::vector<std::size_t> shown;
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const bool any = std::any_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
      const auto* const words = std::get_if<std::string>(&row[c]);
      return !std::holds_alternative<std::monostate>(row[c]) && !(words && words->empty());
    });
    if (any) shown.push_back(c);
  }
  for (const std::size_t c : shown) rows[0].push_back(present::heading(table.columns[c]));
  for (const auto& row : table.rows) {
    if (rows.size() > most_in_terminal) break;
    rows.emplace_back();
    for (const std::size_t c : shown) {
      const double* const number = std::get_if<double>(&row[c]);
      const auto* const words = std::get_if<std::string>(&row[c]);
      rows.back().push_back(
          number  ? present::description(*number, table.columns[c].format, Script::terminal)
          : words ? *words
                  : "");
    }
  }
  std::string text = "\n" + table.caption + "\n" + text_table(rows);
  if (table.rows.size() > most_in_terminal)
    text += fmt::format("... and {} more\n", table.rows.size() - most_in_terminal);
  return text;
}

std::string next_text(const NextPlan& plan) {
  std::string text = wrapped(printable(plan.title), 0, 2) +
                     wrapped(printable(present_text(plan)), 2, 4) + "\n" +
                     wrapped(printable(best_text(plan)), 0, 2);
  if (plan.loss) text += wrapped(printable(loss_text(*plan.loss)), 0, 2);
  if (plan.batch) text += wrapped(printable(batch_text(plan)), 0, 2);
  if (plan.target) text += wrapped(printable(target_text(plan)), 0, 2);
  text += next_table_text(candidates_table(plan));
  for (const std::string& note : plan.notes) text += wrapped("Note: " + printable(note), 2, 4);
  if (!plan.checks.empty()) text += "\nChecks\n";
  text += checks_text(plan.checks);
  return text;
}

std::string how_computed(const NextPlan& plan, const NextQuestion& question) {
  if (!plan.how.empty()) return plan.how;
  const bool several = std::any_of(plan.judged.begin(), plan.judged.end(),
                                   [](const Judged& each) { return each.candidate.specimens > 1; });
  std::string text = fmt::format(
      "Narrowing is 1 minus the ratio of standard deviations of the goal{}: the root of the "
      "expected "
      "posterior variance over the present one. The expected width is the present one times that "
      "ratio. Each candidate's outcomes are integrated over {} nodes of the posterior",
      plan.logarithmic ? "'s logarithm" : "", plan.points.goal.size());
  if (several || plan.batch)
    text += fmt::format(
        "; more than one specimen by {} simulated results, whose standard error is "
        "stated",
        question.samples);
  return text + ".";
}

std::vector<present::Section> next_sections(const NextPlan& plan, const NextQuestion& question) {
  present::Section answer{"answer", "Which test next"};
  answer.add(present::Prose{best_text(plan), true});
  answer.add(present::Prose{present_text(plan) + "."});
  if (plan.loss) answer.add(present::Prose{loss_text(*plan.loss)});
  if (plan.batch) answer.add(present::Prose{batch_text(plan)});
  if (plan.target) answer.add(present::Prose{target_text(plan)});
  for (const Check& check : plan.checks)
    answer.add(present::Callout{verdict_kind(check.verdict), check.name,
                                html::capital(check.detail) + ". " + check.advice});
  if (auto figures = next_figures(plan); !figures.empty())
    answer.add(present::Figures{std::move(figures)});
  present::Section candidates{"candidates", "Candidates"};
  candidates.add(candidates_table(plan));
  candidates.add(present::Prose{how_computed(plan, question)});
  for (const std::string& note : plan.notes)
    candidates.add(present::Prose{html::capital(note) + "."});
  return {answer, candidates};
}

}  // namespace

Answer answer_of(const NextPlan& plan, const NextQuestion& question) {
  return {plan.title, next_text(plan), next_sections(plan, question), next_json(plan, question),
          plan.trusted};
}

}  // namespace wearwell::plan
