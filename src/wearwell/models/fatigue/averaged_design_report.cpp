#include "wearwell/models/fatigue/averaged_design_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/comparison_overlays.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::fatigue {
namespace {

using present::Table;

const SnResult& first_of(const AveragedDesignReport& report) {
  return report.from.models.front().result;
}

// Of all models, from the first: they have the same tests.
double in_stress(const AveragedDesignReport& report, double si) {
  return from_si(first_of(report).stress_unit, si);
}
double in_life(const AveragedDesignReport& report, double cycles) {
  return from_si(first_of(report).life_unit, cycles);
}

std::string number(double x) {
  return std::isinf(x) ? "no end" : plain_number(x);
}

bool of_one(const AveragedDesignReport& report) {
  return report.from.models.size() == 1;
}

std::string weights_text(const AveragedDesignReport& report) {
  if (of_one(report)) return "From the posterior of one study.";
  std::vector<std::string> shares;
  for (const WeightedModel& each : report.from.models)
    shares.push_back(fmt::format("{} {:.3f}", each.name, each.weight));
  return fmt::format(
      "Weights of the mixture that predicts best (stacking): {}. Every point of a model's "
      "posterior counts with the model's weight.",
      fmt::join(shares, ", "));
}

std::string line_text(const AveragedDesignReport& report) {
  const auto& models = report.from.models;
  if (std::all_of(models.begin(), models.end(),
                  [](const auto& each) { return each.result.law.correction == MeanStress::none; }))
    return "";
  const StressLine& line = report.question.line;
  if (line.ratio) return fmt::format(", at R = {:.4g}", *line.ratio);
  return fmt::format(", at a mean stress of {:.5g} {}", in_stress(report, line.mean),
                     first_of(report).stress_unit.text);
}

Table curves_table(const AveragedDesignReport& report) {
  const std::string life = first_of(report).life_unit.text;
  Table table{"averaged-design",
              "Design curves averaged over models, and those of each model",
              {{"curve"},
               {"alternating stress", first_of(report).stress_unit.text},
               {"averaged", life},
               {"most cautious with weight", life}}};
  for (const WeightedModel& each : report.from.models) table.columns.push_back({each.name, life});
  const auto& levels = report.question.levels;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    for (const DesignPoint& point : report.points) {
      std::vector<present::Cell> cells(4 + point.models.size());
      cells[0] = levels[l].name;
      cells[1] = in_stress(report, point.stress.alternating);
      cells[2] = in_life(report, point.averaged[l]);
      cells[3] = in_life(report, point.cautious[l]);
      for (std::size_t m = 0; m < point.models.size(); ++m)
        cells[4 + m] = in_life(report, point.models[m][l]);
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

Table weights_table(const AveragedDesignReport& report) {
  Table table{"weights",
              "The models and their weights",
              {{"study"}, {"equation"}, {"weight", "1", present::fixed(3)}, {"trusted"}}};
  for (const WeightedModel& each : report.from.models)
    table.rows.push_back({each.name, each.result.equation, each.weight,
                          std::string(each.result.trusted ? "yes" : "no")});
  return table;
}

html::Figure curves_figure(const AveragedDesignReport& report) {
  const auto curve = [&](const auto& life_at) {
    std::pair<std::vector<double>, std::vector<double>> xy;
    for (const DesignPoint& point : report.points) {
      const double life = in_life(report, life_at(point));
      if (!std::isfinite(life) || !(life > 0)) continue;
      xy.first.push_back(life);
      xy.second.push_back(in_stress(report, point.stress.alternating));
    }
    return xy;
  };
  std::vector<plot::Json> marks;
  for (std::size_t m = 0; m < report.from.models.size(); ++m) {
    const auto [x, y] = curve([m](const DesignPoint& point) { return point.models[m].front(); });
    const WeightedModel& model = report.from.models[m];
    plot::Look look = look_of_study(m, fmt::format("{} ({:.2f})", model.name, model.weight));
    look.width = 1.5;
    look.opacity = model.weight >= least_weight ? 0.9 : 0.35;
    marks.push_back(plot::line({{"x", x}, {"y", y}, {"life", x}, {"stress", y}}, look));
  }
  const auto [x, y] = curve([](const DesignPoint& point) { return point.averaged.front(); });
  if (!of_one(report))
    marks.push_back(plot::line({{"x", x}, {"y", y}, {"life", x}, {"stress", y}},
                               {plot::colour::limit, "averaged", 1, 3, true}));
  const SnResult& first = first_of(report);
  return {
      "averaged-design", "Design curves: life against stress",
      fmt::format("{}{}.{}", report.question.levels.front().name, line_text(report),
                  of_one(report)
                      ? ""
                      : " The thick line is averaged over the models, the others are those of each "
                        "model, paler if its weight is negligible."),
      plot::plot("Design curves of each model and their average",
                 {fmt::format("Life [{}]", html::unit(first.life_unit.text)), true},
                 {fmt::format("Alternating stress [{}]", html::unit(first.stress_unit.text)), true},
                 std::move(marks), 340, true)};
}

}  // namespace

std::vector<Check> averaged_design_checks(const AveragedDesignReport& report) {
  const TestedSpan& tested = first_of(report).tested;
  Findings extrapolation("extrapolation");
  for (const DesignPoint& point : report.points) {
    const double at = point.stress.alternating;
    if (at >= tested.alternating_low * (1 - 1e-9) && at <= tested.alternating_high * (1 + 1e-9))
      continue;
    extrapolation.add(
        Verdict::warn,
        fmt::format("{:.5g} {} lies outside the stresses that were tested ({:.6g} to {:.6g} {})",
                    in_stress(report, at), first_of(report).stress_unit.text,
                    in_stress(report, tested.alternating_low),
                    in_stress(report, tested.alternating_high), first_of(report).stress_unit.text),
        "Models of the same tests diverge there, and the weights do not apply. Test there.");
  }
  std::vector<Check> checks = {extrapolation.result("every stress lies in the tested range")};
  Findings mean("mean-stress");
  for (const WeightedModel& each : report.from.models) {
    if (each.result.law.correction == MeanStress::none) continue;
    const TestedSpan& span = each.result.tested;
    const double size = 1e-6 * span.alternating_high;
    for (const DesignPoint& point : report.points) {
      if (point.stress.mean >= span.mean_low - size && point.stress.mean <= span.mean_high + size)
        continue;
      mean.add(
          Verdict::warn,
          fmt::format("the mean stress {:.5g} {} lies outside those tested ({:.6g} to {:.6g} {})",
                      in_stress(report, point.stress.mean), first_of(report).stress_unit.text,
                      in_stress(report, span.mean_low), in_stress(report, span.mean_high),
                      first_of(report).stress_unit.text),
          "There are no tests.");
      break;
    }
    break;
  }
  checks.push_back(mean.result("as tested"));
  Findings studies("studies");
  for (const WeightedModel& each : report.from.models) {
    if (each.result.trusted) continue;
    studies.add(each.weight >= least_weight ? Verdict::fail : Verdict::warn,
                fmt::format("{} is not trusted, weight {:.3f}", each.name, each.weight),
                "Look at its checks first: wearwell report.");
  }
  checks.push_back(studies.result("every study is trusted"));
  return checks;
}

std::string averaged_design_text(const AveragedDesignReport& report) {
  const SnResult& first = first_of(report);
  const auto& levels = report.question.levels;
  std::vector<std::vector<std::string>> rows = {{""}};
  for (const DesignLevel& level : levels) rows[0].push_back(level.name);
  const auto add = [&](const std::string& name, const std::vector<double>& lives) {
    rows.push_back({"  " + printable(name)});
    for (const double life : lives) rows.back().push_back(number(in_life(report, life)));
  };
  const std::size_t n = report.points.size();
  const std::size_t step = report.shown_all ? 1 : std::max<std::size_t>(1, (n - 1) / 2);
  for (std::size_t i = 0; i < n; i += step) {
    const DesignPoint& point = report.points[i];
    rows.push_back({fmt::format("at {:.4g} {}", in_stress(report, point.stress.alternating),
                                first.stress_unit.text)});
    if (of_one(report)) {
      add(first.title, point.averaged);
      continue;
    }
    add("averaged", point.averaged);
    add("most cautious with weight", point.cautious);
    for (std::size_t m = 0; m < point.models.size(); ++m)
      add(fmt::format("{} ({:.3f})", report.from.models[m].name, report.from.models[m].weight),
          point.models[m]);
  }
  std::string text =
      fmt::format(
          "Design curves{}, life [{}]{}\n",
          of_one(report) ? "" : fmt::format(" averaged over {} models", report.from.models.size()),
          first.life_unit.text, line_text(report)) +
      text_table(rows) + wrapped(printable(weights_text(report)), 2, 4);
  text += "\nChecks\n";
  text += checks_text(averaged_design_checks(report));
  if (!report.from.cautions.empty())
    text +=
        "\n"
        "Bear in mind\n";
  for (const std::string& caution : report.from.cautions) text += wrapped(printable(caution), 2, 4);
  return text;
}

std::vector<present::Section> averaged_design_sections(const AveragedDesignReport& report) {
  present::Section design{"design", "Design curves"};
  design.add(present::Prose{
      fmt::format("The life that this share of the items outlasts with this "
                  "confidence{}. ",
                  of_one(report) ? "" : ", averaged over the uncertainty of the model") +
          weights_text(report),
      true});
  for (const Check& check : averaged_design_checks(report)) {
    if (check.verdict == Verdict::pass) continue;
    design.add(present::Callout{verdict_kind(check.verdict), check.name,
                                check.detail + ". " + check.advice});
  }
  design.add(present::Figures{{curves_figure(report)}});
  design.add(curves_table(report));
  present::Section models{"models", "Models"};
  models.add(weights_table(report));
  for (const std::string& caution : report.from.cautions) models.add(present::Prose{caution});
  return {design, models};
}

nlohmann::ordered_json averaged_design_json(const AveragedDesignReport& report) {
  using Json = nlohmann::ordered_json;
  const SnResult& first = first_of(report);
  Json models = Json::array();
  for (const WeightedModel& each : report.from.models)
    models.push_back({{"study", each.name},
                      {"equation", each.result.equation},
                      {"weight", each.weight},
                      {"trusted", each.result.trusted}});
  Json curves = Json::array();
  const auto& levels = report.question.levels;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    Json points = Json::array();
    for (const DesignPoint& point : report.points) {
      Json own = Json::array();
      for (const auto& lives : point.models) own.push_back(in_life(report, lives[l]));
      points.push_back({{"stress", in_stress(report, point.stress.alternating)},
                        {"mean_stress", in_stress(report, point.stress.mean)},
                        {"life", in_life(report, point.averaged[l])},
                        {"most_cautious", in_life(report, point.cautious[l])},
                        {"models", std::move(own)}});
    }
    curves.push_back({{"name", levels[l].name},
                      {"reliability", levels[l].reliability},
                      {"confidence", levels[l].confidence},
                      {"points", std::move(points)}});
  }
  Json median = Json::array();
  for (const DesignPoint& point : report.points)
    median.push_back({{"stress", in_stress(report, point.stress.alternating)},
                      {"life", in_life(report, point.median)}});
  Json checks = Json::array();
  static constexpr const char* words[] = {"pass", "warn", "fail"};
  for (const Check& each : averaged_design_checks(report))
    checks.push_back({{"name", each.name},
                      {"verdict", words[static_cast<int>(each.verdict)]},
                      {"detail", each.detail}});
  return {{"models", std::move(models)},       {"stress_unit", first.stress_unit.text},
          {"life_unit", first.life_unit.text}, {"curves", std::move(curves)},
          {"median", std::move(median)},       {"checks", std::move(checks)},
          {"cautions", report.from.cautions}};
}

}  // namespace wearwell::fatigue
