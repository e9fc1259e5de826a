#include "wearwell/plan/size_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::plan {
namespace {

std::string size_percent(double share) {
  return fmt::format("{:.3g} %", 100 * share);
}

std::string width_text(const SizeReport& report, double width) {
  return report.ratio ? fmt::format("a factor of {}", plain_number(width, 3))
                      : plain_quantity(width, report.goal.unit.text, 3);
}

std::string asked(const SizeReport& report) {
  return fmt::format("{} interval of {} at most {} wide, with an assurance of {}",
                     size_percent(report.level), report.goal.name, width_text(report, report.width),
                     size_percent(report.assurance));
}

std::string size_result(const SizeReport& report) {
  const AssuranceSearch& search = report.search;
  if (!search.reached) {
    const AssurancePoint& last = search.points.back();
    return fmt::format(
        "Not reached with {} specimens: the interval is then narrow enough in {} of {} simulated "
        "campaigns.",
        last.size, last.narrow, last.runs);
  }
  const SmallestSize& smallest = search.smallest;
  std::string text =
      fmt::format("Test {} specimen{}", smallest.size, smallest.size == 1 ? "" : "s");
  const Candidates& conditions = report.planning->conditions;
  if (conditions.all.size() > 1) {
    const std::vector<std::size_t> all = allocation(report.planning->shares, smallest.size);
    for (std::size_t k = 0; k < conditions.all.size(); ++k)
      text += fmt::format("{}{} at {}", k == 0 ? ": " : ", ", std::count(all.begin(), all.end(), k),
                          conditions.all[k].name);
  }
  text += ".";
  if (smallest.smoothed)
    text += fmt::format(
        " By a probit line through the simulated sizes; their Monte Carlo error leaves {} to {}.",
        std::floor(smallest.low), std::ceil(smallest.high));
  return text;
}

std::vector<std::string> basis(const SizeReport& report) {
  const SizeRow& any = report.rows.front();
  return {
      fmt::format("{} campaigns were simulated with parameters drawn from the priors of the study "
                  "(seed {}), and each was fitted by quadrature. The data of the study are not "
                  "used.",
                  any.runs, report.seed),
      "Campaigns of different sizes share their random numbers. Assurance is averaged over the "
      "priors: a narrow prior promises more."};
}

present::Table sizes_table(const SizeReport& report) {
  const TestStudy& tests = report.planning->tests;
  const std::string unit = tests.measured_unit.text;
  present::Table table{"sizes",
                       "Simulated campaigns by number of specimens",
                       {{"specimens", "1", present::given},
                        {"assurance", "%", present::digits(3)},
                        {"error", "%", present::digits(2)},
                        {report.ratio ? "median ratio" : "median width",
                         report.ratio ? "1" : report.goal.unit.text, present::digits(3)},
                        {"interval holds the truth", "%", present::digits(3)},
                        {"failures", "1", present::digits(3)},
                        {"run-outs", "1", present::digits(3)},
                        {"time on test", unit, present::digits(3)},
                        {"longest test", unit, present::digits(3)}}};
  for (const SizeRow& each : report.rows) {
    const AssurancePoint point{each.size, each.narrow, each.runs};
    table.rows.push_back({present::count(each.size), 100 * point.share(), 100 * point.error(),
                          each.median_width,
                          100 * static_cast<double>(each.covered) / static_cast<double>(each.runs),
                          each.failures, each.runouts, each.time, each.longest});
  }
  if (!tests.is_life) {
    table.columns.erase(table.columns.begin() + 5, table.columns.end());
    for (auto& row : table.rows) row.erase(row.begin() + 5, row.end());
  }
  return table;
}

html::Figure assurance_figure(const SizeReport& report) {
  std::vector<double> size, share, low, high;
  for (const AssurancePoint& each : report.search.points) {
    size.push_back(static_cast<double>(each.size));
    share.push_back(100 * each.share());
    low.push_back(100 * std::max(0.0, each.share() - 1.645 * each.error()));
    high.push_back(100 * std::min(1.0, each.share() + 1.645 * each.error()));
  }
  namespace colour = plot::colour;
  std::vector<plot::Json> marks = {
      plot::ranges({{"x", size}, {"y", high}, {"y2", low}}, {colour::posterior}),
      plot::line({{"x", size}, {"y", share}}, {colour::posterior}),
      plot::points({{"x", size}, {"y", share}}, {colour::posterior}),
      plot::horizontal_line(100 * report.assurance,
                            {colour::limit, "assurance asked for", 1, 1.5, true})};
  if (report.search.reached)
    marks.push_back(plot::vertical_line(static_cast<double>(report.search.smallest.size),
                                        {colour::measured, "smallest number", 1, 1.5, true}));
  return {"assurance", "Assurance against the number of specimens",
          "Share of simulated campaigns whose interval is narrow enough, with its 90 % Monte Carlo "
          "interval.",
          plot::plot("Assurance against the number of specimens", {"Specimens", true},
                     {"Assurance [%]", false, 0.0, 100.0}, std::move(marks), 300)};
}

html::Figure width_figure(const SizeReport& report) {
  std::vector<double> size, width;
  for (const SizeRow& each : report.rows) {
    if (!std::isfinite(each.median_width)) continue;
    size.push_back(static_cast<double>(each.size));
    width.push_back(each.median_width);
  }
  namespace colour = plot::colour;
  return {"width", "Width of the interval", "Median over the simulated campaigns.",
          plot::plot("Median width against the number of specimens", {"Specimens", true},
                     {report.ratio ? "Upper end / lower end"
                                   : fmt::format("Width [{}]", html::unit(report.goal.unit.text)),
                      true},
                     {plot::line({{"x", size}, {"y", width}}, {colour::posterior}),
                      plot::points({{"x", size}, {"y", width}}, {colour::posterior}),
                      plot::horizontal_line(report.width,
                                            {colour::limit, "width asked for", 1, 1.5, true})},
                     300)};
}

nlohmann::ordered_json size_json(const SizeReport& report) {
  using Json = nlohmann::ordered_json;
  Json json = {
      {"title", report.planning->study().title},
      {"plan", "size"},
      {"goal", report.goal.name},
      {"unit", report.goal.unit.text},
      {"width", {{"kind", report.ratio ? "ratio" : "difference"}, {"value", report.width}}},
      {"level", report.level},
      {"assurance", report.assurance},
      {"seed", report.seed},
      {"reached", report.search.reached}};
  json["specimens"] = Json();
  if (report.search.reached) {
    const SmallestSize& smallest = report.search.smallest;
    json["specimens"] = smallest.size;
    json["from"] = smallest.low;
    json["to"] = smallest.high;
    json["by"] = smallest.smoothed ? "probit" : "bisection";
    const std::vector<std::size_t> all = allocation(report.planning->shares, smallest.size);
    json["allocation"] = Json::array();
    for (std::size_t k = 0; k < report.planning->conditions.all.size(); ++k)
      json["allocation"].push_back({{"test", report.planning->conditions.all[k].name},
                                    {"specimens", std::count(all.begin(), all.end(), k)}});
  }
  json["sizes"] = Json::array();
  for (const SizeRow& each : report.rows) {
    const AssurancePoint point{each.size, each.narrow, each.runs};
    Json row = {
        {"specimens", each.size},
        {"simulations", each.runs},
        {"assurance", point.share()},
        {"error", point.error()},
        {"median_width", std::isfinite(each.median_width) ? Json(each.median_width) : Json()},
        {"coverage", static_cast<double>(each.covered) / static_cast<double>(each.runs)},
        {"unresolved", each.unresolved}};
    if (report.planning->tests.is_life) {
      row["failures"] = each.failures;
      row["runouts"] = each.runouts;
      row["time_on_test"] = each.time;
      row["longest_test"] = each.longest;
    }
    json["sizes"].push_back(std::move(row));
  }
  json["checks"] = Json::array();
  for (const Check& each : size_checks(report))
    json["checks"].push_back({{"name", each.name}, {"verdict", "warn"}, {"detail", each.detail}});
  return json;
}

}  // namespace

std::vector<Check> size_checks(const SizeReport& report) {
  std::vector<Check> checks;
  const auto worst = std::max_element(
      report.rows.begin(), report.rows.end(),
      [](const SizeRow& a, const SizeRow& b) { return a.unresolved < b.unresolved; });
  if (worst->unresolved > 0)
    checks.push_back(
        {"quadrature", Verdict::warn,
         fmt::format("up to {} of {} simulated posteriors did not converge; they count "
                     "as too wide",
                     worst->unresolved, worst->runs),
         "Give narrower priors."});
  return checks;
}

Answer size_answer(const SizeReport& report) {
  Answer answer;
  answer.title = report.planning->study().title;
  answer.text = wrapped(printable(answer.title), 0, 2) + wrapped(printable(asked(report)), 2, 4) +
                "\n" + wrapped(printable(size_result(report)), 0, 2) + "\n" +
                present::text(sizes_table(report)) + "\n";
  for (const std::string& each : basis(report)) answer.text += wrapped(printable(each), 0, 2);
  const std::vector<Check> checks = size_checks(report);
  if (!checks.empty()) answer.text += "\nChecks\n" + checks_text(checks);
  present::Section sizes{"size", "Number of specimens"};
  sizes.add(present::Prose{size_result(report), true});
  sizes.add(present::Prose{html::capital(asked(report)) + "."});
  for (const Check& check : checks)
    sizes.add(present::Callout{"warn", check.name, check.detail + ". " + check.advice});
  sizes.add(present::Figures{{assurance_figure(report), width_figure(report)}});
  sizes.add(sizes_table(report));
  for (const std::string& each : basis(report)) sizes.add(present::Prose{each});
  answer.sections = {sizes};
  answer.json = size_json(report);
  return answer;
}

}  // namespace wearwell::plan
