#include "wearwell/models/fatigue/design_curve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/models/fatigue/design_curve_points.h"
#include "wearwell/models/fatigue/lives_under.h"
#include "wearwell/models/fatigue/scatter_range.h"
#include "wearwell/models/fatigue/sn_figures.h"
#include "wearwell/models/fatigue/sn_result.h"
#include "wearwell/models/fatigue/standard_fit.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell {
namespace {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::Outcome;
using fatigue::SnLaw;
using fatigue::Stress;
using fatigue::StressLine;
using present::Table;

constexpr std::size_t shown_points = 3;
// A random limit makes a mixture of each point of the posterior.
constexpr Eigen::Index most_draws_with_limit = 600;

std::string with_unit(const SnData& data, double si) {
  return fmt::format("{:.4g}{}", from_si(data.stress_unit, si), after_number(data.stress_unit));
}

// The mean stress of the curves: if the tests have several, it may differ from all of them.
std::string line_text(const SnLaw& law, const SnData& data) {
  if (law.correction == MeanStress::none) return "";
  const StressLine line = line_of_tests(law, data);
  if (line.ratio) return fmt::format(" at the tests' stress ratio R = {:.4g}", *line.ratio);
  if (line.mean == 0) return ", fully reversed";
  return fmt::format(" at a mean stress of {}, the tests' average", with_unit(data, line.mean));
}

Table curves_table(const SnData& data, const std::vector<CurvePoint>& points,
                   const std::string& where) {
  const std::string unit = data.life_unit.text;
  Table table{
      "design-curves",
      fmt::format("Design curves{}: lives that this share outlasts, with this confidence", where),
      {{"curve"},
       {"alternating stress", data.stress_unit.text},
       {"mean stress", data.stress_unit.text},
       {"life", unit},
       {"ISO 12107", unit},
       {"Owen", unit},
       {"ASTM E739, band of the median", unit}}};
  const auto life = [&](double cycles) { return from_si(data.life_unit, cycles); };
  const auto& levels = design_levels();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    for (const CurvePoint& at : points) {
      table.rows.push_back({levels[l].name,
                            from_si(data.stress_unit, at.stress),
                            from_si(data.stress_unit, at.mean),
                            life(at.posterior[l]),
                            {},
                            {},
                            {}});
      if (at.iso.empty()) continue;
      table.rows.back()[4] = life(at.iso[l]);
      table.rows.back()[5] = life(at.owen[l]);
    }
  }
  for (const CurvePoint& at : points) {
    table.rows.push_back({"median",
                          from_si(data.stress_unit, at.stress),
                          from_si(data.stress_unit, at.mean),
                          life(at.median),
                          {},
                          {},
                          {}});
    if (at.band > 0) table.rows.back()[6] = life(at.band);
  }
  return table;
}

html::Figure curves_figure(const SnLaw& law, const SnData& data,
                           const std::vector<CurvePoint>& points) {
  namespace colour = plot::colour;
  std::vector<double> stress, median;
  for (const CurvePoint& at : points) {
    stress.push_back(from_si(data.stress_unit, at.stress));
    median.push_back(from_si(data.life_unit, at.median));
  }
  std::vector<plot::Json> marks = {
      plot::line({{"x", median}, {"y", stress}, {"median", median}, {"stress", stress}},
                 {colour::prior, "median", 1, 1.5})};
  constexpr const char* colours[] = {colour::chains[0], colour::chains[1], colour::limit,
                                     colour::chains[2]};
  const auto& levels = design_levels();
  std::vector<double> all = median;
  for (std::size_t l = 0; l < levels.size(); ++l) {
    std::vector<double> life;
    for (const CurvePoint& at : points) life.push_back(from_si(data.life_unit, at.posterior[l]));
    all.insert(all.end(), life.begin(), life.end());
    marks.push_back(
        plot::line({{"x", life}, {"y", stress}, {"life", life}, {"stress", stress}},
                   {colours[l % std::size(colours)], levels[l].name, 1, 2, l % 2 == 1}));
  }
  std::erase_if(all, [](double life) { return !std::isfinite(life) || !(life > 0); });
  plot::Axis lives{fmt::format("Life [{}]", html::unit(data.life_unit.text)), true};
  if (!all.empty()) {
    // A fatigue limit gives curves with infinite lives.
    double tested = 0;
    for (const fatigue::LifeTest& test : data.tests)
      tested = std::max({tested, test.life, test.until});
    lives.low = *std::min_element(all.begin(), all.end()) / 1.5;
    lives.high = std::min(1.5 * *std::max_element(all.begin(), all.end()),
                          100 * from_si(data.life_unit, tested));
  }
  html::Figure figure{"design-curves", "Design curves",
                      "The life that this share outlasts, with this confidence, under each "
                      "alternating stress. The table has the numbers.",
                      plot::plot("Design curves: alternating stress against life", lives,
                                 {fmt::format("Alternating {} [{}]", driver_word(law, data),
                                              html::unit(data.stress_unit.text)),
                                  true, *std::min_element(stress.begin(), stress.end()),
                                  *std::max_element(stress.begin(), stress.end())},
                                 marks, 320, true)};
  figure.wide = true;
  return figure;
}

// ASTM E739's line log10 N = A + B log10 S in the table's own units.
struct StandardUnits {
  double a = 0, b = 0, sd = 0;
};
StandardUnits e739_line(const SnData& data, const fatigue::FittedLine& line) {
  const double shift = std::log10(data.stress_unit.scale);
  return {line.intercept + line.slope * shift - std::log10(data.life_unit.scale), line.slope,
          line.sd};
}

// The E739 fit of the same tests, and the closed form of Owen's and ISO's curves.
std::string e739_text(const SnData& data, const std::vector<CurvePoint>& points,
                      const StandardFit& standard) {
  if (!standard.line) return "";
  const StandardUnits e739 = e739_line(data, *standard.line);
  const auto life = [&](const CurvePoint& at) {
    return fmt::format("{} at {}", plain_number(from_si(data.life_unit, at.band)),
                       with_unit(data, at.stress));
  };
  std::string text = fmt::format(
      "ASTM E739: log10 N = {:.4f} {} {:.4f} log10 S, standard deviation {:.4f} (N in {}, S in "
      "{}); the lower end of its 95 % band of the median is {}",
      e739.a, e739.b < 0 ? "-" : "+", std::abs(e739.b), e739.sd, data.life_unit.text,
      data.stress_unit.text, life(points.front()));
  if (points.size() > 1) text += fmt::format(" and {}", life(points.back()));
  const double middle = standard.line->mean_x - std::log10(data.stress_unit.scale);
  return text +
         fmt::format(
             ". ISO 12107 lies k sd sqrt(1 + 1/n + (x {0} {1:.4f})^2/{2:.4g}) below that line, x = "
             "log10 S, n = {3:.0f}; Owen k sd with the k of 1/n + (x {0} {1:.4f})^2/{2:.4g}.",
             middle < 0 ? "+" : "-", std::abs(middle), standard.line->sum_xx, standard.line->n);
}

std::string difference(const SnLaw& law, const StandardFit& standard) {
  if (!standard.line)
    return fmt::format("ISO 12107, ASTM E739 and Owen's factor do not apply: {}.",
                       standard.why_not);
  std::string text = fmt::format("ISO 12107 and Owen fit a straight line to the {} failures only",
                                 standard.failures);
  if (standard.left_out > 0)
    text += fmt::format(" and leave out {} test{} that did not fail, which tend to be long-lived",
                        standard.left_out, standard.left_out == 1 ? "" : "s");
  text += "; they do not use priors";
  if (law.bends())
    text += ", and they have no knee and no fatigue limit, which the posterior's curve approaches";
  return text +
         ". ISO 12107 treats the uncertainty of the line as scatter; Owen's factor is exact.";
}

std::string text_of(const SnData& data, const std::vector<CurvePoint>& points,
                    const std::string& where, const std::string& why, const std::string& e739) {
  const auto& levels = design_levels();
  std::vector<std::vector<std::string>> rows = {{""}};
  for (const DesignLevel& level : levels) rows[0].push_back(level.name);
  const auto add = [&](const std::string& name, const std::vector<double>& lives) {
    rows.push_back({"  " + name});
    for (const double life : lives)
      rows.back().push_back(plain_number(from_si(data.life_unit, life)));
  };
  const std::size_t step = std::max<std::size_t>(1, (points.size() - 1) / (shown_points - 1));
  for (std::size_t i = 0; i < points.size(); i += step) {
    const CurvePoint& at = points[i];
    rows.push_back({"at " + with_unit(data, at.stress)});
    add("posterior", at.posterior);
    if (at.iso.empty()) continue;
    add("ISO 12107", at.iso);
    add("Owen", at.owen);
  }
  return fmt::format("Design curves{}, {}\n", where,
                     printable_heading("life", data.life_unit.text)) +
         text_table(rows) + wrapped(why, 2, 4) + (e739.empty() ? "" : wrapped(e739, 2, 4));
}

nlohmann::ordered_json json_of(const SnLaw& law, const SnData& data,
                               const std::vector<CurvePoint>& points, const StandardFit& standard,
                               const std::string& why) {
  using Json = nlohmann::ordered_json;
  const auto life = [&](double cycles) { return from_si(data.life_unit, cycles); };
  Json curves = Json::array();
  const auto& levels = design_levels();
  for (std::size_t l = 0; l < levels.size(); ++l) {
    Json rows = Json::array();
    for (const CurvePoint& at : points) {
      Json row = {{"stress", from_si(data.stress_unit, at.stress)},
                  {"life", life(at.posterior[l])}};
      if (!at.iso.empty()) {
        row["iso_12107"] = life(at.iso[l]);
        row["owen"] = life(at.owen[l]);
      }
      rows.push_back(std::move(row));
    }
    curves.push_back({{"name", levels[l].name},
                      {"reliability", levels[l].reliability},
                      {"confidence", levels[l].confidence},
                      {"points", std::move(rows)}});
  }
  Json json = {{"curves", std::move(curves)}, {"why", why}};
  if (law.correction != MeanStress::none) {
    const StressLine line = line_of_tests(law, data);
    if (line.ratio) {
      json["stress_ratio"] = *line.ratio;
    } else {
      json["mean_stress"] = from_si(data.stress_unit, line.mean);
    }
  }
  if (standard.line) {
    const StandardUnits e739 = e739_line(data, *standard.line);
    Json band = Json::array();
    for (const CurvePoint& at : points)
      band.push_back({{"stress", from_si(data.stress_unit, at.stress)}, {"life", life(at.band)}});
    json["astm_e739"] = {{"A", e739.a},
                         {"B", e739.b},
                         {"sd", e739.sd},
                         {"failures", standard.failures},
                         {"left_out", standard.left_out},
                         {"band", std::move(band)}};
  }
  return json;
}

}  // namespace

const std::vector<DesignLevel>& design_levels() {
  static const std::vector<DesignLevel> levels = {{"90/90", 0.9, 0.9},
                                                  {"B-basis", 0.9, 0.95},
                                                  {"A-basis", 0.99, 0.95},
                                                  {"97.7/90", 0.977, 0.9}};
  return levels;
}

StressLine line_of_tests(const SnLaw& law, const SnData& data) {
  StressLine line;
  double tests = 0;
  bool one_ratio = true;
  const Stress& first = data.tests.front().stress;
  for (const LifeTest& test : data.tests) {
    line.mean += test.count * test.stress.mean;
    tests += test.count;
    one_ratio = one_ratio && std::abs(test.stress.mean / test.stress.alternating -
                                      first.mean / first.alternating) < 1e-6;
  }
  line.mean /= tests;
  // Tests of one stress ratio are reported at that ratio, others at their common mean stress.
  if (one_ratio && data.tests.size() > 1 && law.correction != MeanStress::none)
    line = {0, (first.mean - first.alternating) / (first.mean + first.alternating)};
  return line;
}

PresetAddition sn_addition(const SnLaw& law, const SnData& data, const Fit& fit) {
  PresetAddition added;
  added.body["fatigue"] = fatigue::sn_json(law, data);
  const WeightedDraws& all = fit.exact ? fit.exact->nodes : fit.pooled;
  const WeightedDraws draws = fatigue::curve_nodes(law, all, most_draws_with_limit);
  const StandardFit standard = standard_fit(law, data);
  const std::vector<CurvePoint> points = curve_points(law, data, draws, standard);
  const std::string where = line_text(law, data);
  std::string why = difference(law, standard);
  if (draws.values.rows() < all.values.rows() && law.integrated())
    why += fmt::format(
        " A random limit is slow to compute: the posterior's curves come from {} draws, with an "
        "error of some percent.",
        draws.values.rows());
  const std::string e739 = e739_text(data, points, standard);
  std::vector<present::Block>& blocks = added.blocks["predictions"];
  blocks.push_back(
      {present::Prose{"Design curves" + where +
                      ": 90/90, B-basis (90 % with 95 % confidence), A-basis (99 % with 95 %) and "
                      "97.7 % with 90 % (FKM's probability of survival). " +
                      why + " " + e739}});
  blocks.push_back({present::Figures{{curves_figure(law, data, points)}}});
  blocks.push_back({curves_table(data, points, where)});
  added.text += text_of(data, points, where, why, e739);
  added.body["design_curves"] = json_of(law, data, points, standard, why);
  const bool has_slope =
      law.curve == fatigue::SnCurve::basquin || law.curve == fatigue::SnCurve::knee;
  if (!law.logarithmic() || !has_slope || law.scatter_grows) return added;
  const fatigue::ScatterRange t = fatigue::scatter_range(law, all);
  present::Table table{"scatter",
                       "Slope and scatter ranges, 10 to 90 % of items (FKM, DIN 50100)",
                       {{"of"}, {"5 %"}, {"50 %"}, {"95 %"}}};
  table.rows = {{"slope k", t.k05, t.k50, t.k95},
                {"T_N, of lives", t.n05, t.n50, t.n95},
                {"T_S, of stresses", t.s05, t.s50, t.s95}};
  blocks.push_back({table});
  added.body["design_curves"]["scatter"] = {
      {"k", {t.k05, t.k50, t.k95}}, {"T_N", {t.n05, t.n50, t.n95}}, {"T_S", {t.s05, t.s50, t.s95}}};
  return added;
}

}  // namespace wearwell
