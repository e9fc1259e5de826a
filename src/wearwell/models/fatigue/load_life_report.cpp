#include "wearwell/models/fatigue/load_life_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/present/number.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::fatigue {
namespace {

using present::Table;
namespace colour = plot::colour;

constexpr double worth_telling = 0.01;  // a share of the damage
constexpr double worth_a_warning = 0.05;

std::string percent(double share) {
  return share > 0 && share < 0.001 ? "less than 0.1 %" : fmt::format("{:.3g} %", 100 * share);
}

std::string rule_text(const LoadLifeReport& report) {
  static constexpr const char* words[] = {"no damage below the knee", "no knee",
                                          "slope 2k - 1 below the knee",
                                          "slope (k + 3.6)/2 down to half of the knee's stress"};
  const DamageRule& rule = report.question.rule;
  std::string text =
      fmt::format("Miner, {}: {}", miner_rule_names()[static_cast<std::size_t>(rule.miner)],
                  report.result.law.limit     ? "no damage below each item's own fatigue limit"
                  : report.result.law.bends() ? "with the study's own curve"
                                              : words[static_cast<int>(rule.miner)]);
  if (rule.knee.life) text += fmt::format("; knee at {} cycles", plain_given(*rule.knee.life));
  if (rule.knee.stress)
    text +=
        fmt::format("; knee at {:.6g} {}", from_si(report.result.stress_unit, *rule.knee.stress),
                    report.result.stress_unit.text);
  const DamageSum& sum = report.question.sum;
  return text + fmt::format("; failure at a damage sum of {:.4g}{}", sum.median,
                            sum.factor > 1 ? fmt::format(" x/ {:.4g}", sum.factor) : "");
}

double largest(const LoadLifeReport& report) {
  double most = 0;
  for (const LoadCycle& each : report.block.cycles) most = std::max(most, each.stress.alternating);
  return from_si(report.result.stress_unit, most);
}

std::string block_text(const LoadLifeReport& report) {
  std::string text =
      fmt::format("{}: {} cycles per block, amplitudes up to {:.6g} {}", report.block.description,
                  plain_given(report.block.count), largest(report), report.result.stress_unit.text);
  if (const double mean = report.block.largest_mean_left_out; mean > 0)
    text += fmt::format(
        "; means up to {:.6g} {} are ignored, since the study's model has no mean stress",
        from_si(report.result.stress_unit, mean), report.result.stress_unit.text);
  if (report.unit != "blocks")
    text += fmt::format("; a block is {:.6g} {}", report.per_block, report.unit);
  if (report.reduction > 1e-3)
    text += fmt::format("; summed in {} classes, which changes the damage by {}",
                        report.cycles.size(), percent(report.reduction));
  return text;
}

std::string b_name(double percent_failed) {
  return fmt::format("B{:.6g}", percent_failed);
}

Table lives_table(const LoadLifeReport& report) {
  const std::string unit = report.unit;
  Table table{"lives",
              "Lives by percentage failed",
              {{"life"},
               {fmt::format("at least, {:.4g} %", 100 * report.question.confidence), unit},
               {"5 %", unit},
               {"50 %", unit},
               {"95 %", unit},
               {"next one", unit}}};
  const double n = report.per_block;
  for (const BlockLife& each : report.life.lives)
    table.rows.push_back({b_name(each.percent), n * each.bound, n * each.q05, n * each.q50,
                          n * each.q95, n * each.next});
  return table;
}

Table contributions_table(const LoadLifeReport& report) {
  Table table{"contributions",
              "Sources of the spread of the predictive log10 life",
              {{"of"}, {"share", "%", present::digits(3)}}};
  for (const Contribution& each : report.life.contributions)
    table.rows.push_back({each.name, 100 * each.share});
  return table;
}

// By amplitude, in twenty classes.
Table damage_table(const LoadLifeReport& report) {
  constexpr std::size_t classes = 20;
  const Unit& unit = report.result.stress_unit;
  double most = 0;
  for (const LoadCycle& each : report.cycles) most = std::max(most, each.stress.alternating);
  std::vector<double> cycles(classes, 0), damage(classes, 0);
  for (std::size_t i = 0; i < report.cycles.size(); ++i) {
    const double at = report.cycles[i].stress.alternating / most * classes;
    const auto c =
        std::min(classes - 1, static_cast<std::size_t>(std::max(0.0, std::ceil(at) - 1)));
    cycles[c] += report.cycles[i].count;
    damage[c] += report.life.shares[i];
  }
  Table table{"damage",
              "Damage by amplitude",
              {{"amplitude from", unit.text},
               {"amplitude to", unit.text},
               {"cycles"},
               {"damage", "%", present::digits(3)}}};
  const double width = from_si(unit, most) / classes;
  for (std::size_t c = 0; c < classes; ++c)
    table.rows.push_back({width * static_cast<double>(c), width * static_cast<double>(c + 1),
                          cycles[c], 100 * damage[c]});
  return table;
}

std::string number(double x) {
  return std::isinf(x) ? "never" : plain_number(x);
}

html::Figure life_figure(const LoadLifeReport& report) {
  std::vector<double> x, y;
  for (const auto& [log10, p] : report.life.cdf) {
    x.push_back(report.per_block * std::pow(10, log10));
    y.push_back(100 * p);
  }
  return {"life", "Predictive life",
          "The probability that the next item has failed by then, averaged over all uncertainty.",
          plot::plot("Probability of failure against life",
                     {fmt::format("Life [{}]", html::unit(report.unit)), true},
                     {"Failed [%]", false, 0.0, 100.0},
                     {plot::line({{"x", x}, {"y", y}}, {colour::posterior})}, 300, true)};
}

html::Figure damage_figure(const LoadLifeReport& report) {
  const Table table = damage_table(report);
  std::vector<double> x, x2, y, y2;
  for (const auto& row : table.rows) {
    x.push_back(std::get<double>(row[0]));
    x2.push_back(std::get<double>(row[1]));
    y.push_back(0);
    y2.push_back(std::get<double>(row[3]));
  }
  const auto in_unit = [&](double si) { return from_si(report.result.stress_unit, si); };
  return {"damage", "Damage by amplitude",
          "Share of the damage by amplitude; the two lines are the smallest and the largest tested "
          "amplitude: outside, the curve rests on the model.",
          plot::plot("Share of the damage by amplitude",
                     {fmt::format("Amplitude [{}]", html::unit(report.result.stress_unit.text))},
                     {"Damage [%]", false, 0.0},
                     {plot::cells({{"x", x},
                                   {"x2", x2},
                                   {"y", y},
                                   {"y2", y2},
                                   {"density", std::vector<double>(x.size(), 0.8)}},
                                  {colour::posterior}),
                      plot::vertical_line(in_unit(report.result.tested.alternating_low),
                                          {colour::limit, "tested from", 1, 1.5, true}),
                      plot::vertical_line(in_unit(report.result.tested.alternating_high),
                                          {colour::limit, "tested to", 1, 1.5, true})},
                     300)};
}

}  // namespace

const std::vector<std::string>& miner_rule_names() {
  static const std::vector<std::string> names = {"original", "elementary", "haibach", "liu-zenner"};
  return names;
}

std::vector<Check> load_life_checks(const LoadLifeReport& report) {
  std::vector<Check> checks;
  const LoadLife& life = report.life;
  const TestedSpan& tested = report.result.tested;
  const Unit& unit = report.result.stress_unit;
  const auto span = [&](double low, double high) {
    return fmt::format("{:.6g} to {:.6g} {}", from_si(unit, low), from_si(unit, high), unit.text);
  };
  Findings extrapolation("extrapolation");
  const auto add = [&](double share, const std::string& what) {
    if (share < worth_telling) return;
    extrapolation.add(share < worth_a_warning ? Verdict::pass : Verdict::warn,
                      fmt::format("{} of the damage is {}", percent(share), what),
                      share < worth_a_warning
                          ? ""
                          : "There the result rests on the model, not on tests. Test there, or "
                            "compare other rules (--rule).");
  };
  const std::string amplitudes = span(tested.alternating_low, tested.alternating_high);
  add(life.above, fmt::format("due to amplitudes above the tested range ({})", amplitudes));
  add(life.below, fmt::format("due to amplitudes below the tested range ({})", amplitudes));
  add(life.beyond_mean, fmt::format("due to mean stresses outside the tested range ({})",
                                    span(tested.mean_low, tested.mean_high)));
  double most = 0;
  for (const LoadCycle& each : report.block.cycles) most = std::max(most, each.stress.alternating);
  if (most > tested.alternating_high * (1 + 1e-9) && life.above < worth_telling)
    extrapolation.add(
        Verdict::pass,
        fmt::format(
            "amplitudes reach {:.6g} {}, above the tested range, and cause {} of the damage",
            from_si(unit, most), unit.text, percent(life.above)),
        "");
  checks.push_back(extrapolation.result(
      fmt::format("all but {} of the damage is in the tested range", percent(worth_telling))));
  if (!report.result.trusted)
    checks.push_back({"study", Verdict::fail, "the study itself is not trusted",
                      "Look at its checks first: wearwell report."});
  return checks;
}

std::string load_life_text(const LoadLifeReport& report) {
  const LoadLife& life = report.life;
  std::string text =
      wrapped(printable(report.result.title), 0, 2) +
      wrapped(printable(powers_text(report.result.equation, Script::terminal)), 2, 4) +
      wrapped(printable(block_text(report)), 2, 4) + wrapped(printable(rule_text(report)), 2, 4);
  std::vector<std::vector<std::string>> rows = {
      {"", fmt::format("at least, {:.4g} %", 100 * report.question.confidence), "5 %", "50 %",
       "95 %", "next one"}};
  const auto scaled = [&](double blocks) { return number(report.per_block * blocks); };
  for (const BlockLife& each : life.lives)
    rows.push_back({fmt::format("  {} life [{}]", b_name(each.percent), report.unit),
                    scaled(each.bound), scaled(each.q05), scaled(each.q50), scaled(each.q95),
                    scaled(each.next)});
  text += "\nLife under this history\n" + text_table(rows);
  text += fmt::format(
              "\n"
              "The next item (predictive)\n") +
          text_table({{"", "5 %", "50 %", "95 %"},
                      {fmt::format("  life [{}]", report.unit), scaled(life.next05),
                       scaled(life.next50), scaled(life.next95)},
                      {"  damage of one block", plain_number(life.damage05),
                       plain_number(life.damage50), plain_number(life.damage95)}});
  if (!life.contributions.empty()) {
    std::vector<std::vector<std::string>> shares = {{"", "share of the variance"}};
    for (const Contribution& each : life.contributions)
      shares.push_back({"  " + each.name, fmt::format("{:.1f} %", 100 * each.share)});
    text += fmt::format(
                "\n"
                "Sources of the spread of the predictive life (log10, standard deviation {:.3g})\n",
                life.sd) +
            text_table(shares);
  } else {
    text +=
        "\n"
        "Some items never fail: their life has no finite variance.\n";
  }
  text += "\nChecks\n";
  text += checks_text(load_life_checks(report));
  return text;
}

std::vector<present::Section> load_life_sections(const LoadLifeReport& report) {
  present::Section life{"life", "Life"};
  life.add(present::Prose{block_text(report) + ".", true});
  life.add(present::Prose{rule_text(report) + "."});
  for (const Check& check : load_life_checks(report)) {
    if (check.verdict == Verdict::pass) continue;
    life.add(present::Callout{verdict_kind(check.verdict), check.name,
                              check.detail + ". " + check.advice});
  }
  life.add(present::Figures{{life_figure(report), damage_figure(report)}});
  life.add(lives_table(report));
  life.add(
      present::Prose{"At least: the true value over all such items lies above it with this "
                     "confidence (credible level); 5, 50 and 95 % are its quantiles. Next one: the "
                     "quantile of the predictive life of the next item."});
  present::Section parts{"parts", "Sources of the spread"};
  if (!report.life.contributions.empty()) parts.add(contributions_table(report));
  parts.add(damage_table(report));
  return {life, parts};
}

nlohmann::ordered_json load_life_json(const LoadLifeReport& report) {
  using Json = nlohmann::ordered_json;
  const LoadLife& life = report.life;
  const DamageRule& rule = report.question.rule;
  const double n = report.per_block;
  Json json = {{"title", report.result.title},
               {"equation", report.result.equation},
               {"trusted", report.result.trusted},
               {"history", report.block.description},
               {"unit", report.unit},
               {"per_block", n},
               {"cycles", report.block.count},
               {"largest_amplitude", largest(report)},
               {"stress_unit", report.result.stress_unit.text},
               {"rule", miner_rule_names()[static_cast<std::size_t>(rule.miner)]},
               {"damage_sum",
                {{"median", report.question.sum.median}, {"factor", report.question.sum.factor}}},
               {"confidence", report.question.confidence},
               {"draws", life.draws}};
  if (rule.knee.life) json["knee_life"] = *rule.knee.life;
  if (rule.knee.stress) json["knee_stress"] = from_si(report.result.stress_unit, *rule.knee.stress);
  Json lives = Json::array();
  for (const BlockLife& each : life.lives)
    lives.push_back({{"percent", each.percent},
                     {"q05", n * each.q05},
                     {"q50", n * each.q50},
                     {"q95", n * each.q95},
                     {"bound", n * each.bound},
                     {"predictive", n * each.next}});
  json["lives"] = std::move(lives);
  json["next"] = {{"q05", n * life.next05}, {"q50", n * life.next50}, {"q95", n * life.next95}};
  json["damage"] = {{"q05", life.damage05}, {"q50", life.damage50}, {"q95", life.damage95}};
  json["sd_log10"] = life.contributions.empty() ? Json() : Json(life.sd);
  Json contributions = Json::array();
  for (const Contribution& each : life.contributions)
    contributions.push_back({{"of", each.name}, {"share", each.share}});
  json["contributions"] = std::move(contributions);
  json["extrapolated"] = {
      {"above", life.above}, {"below", life.below}, {"beyond_mean", life.beyond_mean}};
  json["reduction"] = report.reduction;
  Json checks = Json::array();
  static constexpr const char* words[] = {"pass", "warn", "fail"};
  for (const Check& each : load_life_checks(report))
    checks.push_back({{"name", each.name},
                      {"verdict", words[static_cast<int>(each.verdict)]},
                      {"detail", each.detail}});
  json["checks"] = std::move(checks);
  return json;
}

}  // namespace wearwell::fatigue
