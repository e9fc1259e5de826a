#include "wearwell/models/clutch/clutch_report.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"
#include "wearwell/models/clutch/clutch_figures.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell::clutch {
namespace {

using present::Cell;
using present::count;
using present::digits;
using present::Figures;
using present::fixed;
using present::given;
using present::Prose;
using present::Section;
using present::Table;

constexpr const char* rate_unit = "mm^3/MJ";

std::string percent_text(double share) {
  return html::given(100 * share) + "\u00a0%";
}

std::string cycles_text(double cycles) {
  return html::given(std::round(cycles));
}

Section verdict_section(const ClutchStudy& study, const ClutchResult& r) {
  Section section{"verdict", "Verdict"};
  if (study.simulated) {
    section.add(present::Callout{"warn", "Simulated.",
                                 "This campaign is simulated from a known truth, not measured."});
  }
  const WearMap& map = r.maps.front();
  for (const NamedLife& each : r.lives) {
    const LifeAtLevel& at = each.life.levels.back();
    section.add(
        Prose{fmt::format("Operating point {}: {} worn after {} cycles; {} cycles (95\u00a0%).",
                          each.name, percent_text(at.level), cycles_text(at.repetitions),
                          description(at.full)),
              true});
  }
  section.add(Prose{fmt::format("The wear rate follows {} terms of slip, temperature and torque; "
                                "the predicted R2 (R2p) is {:.3f}.",
                                map.terms.size(), map.fit.r2p),
                    true});
  for (const SequenceResult& s : r.sequences)
    section.add(Prose{fmt::format("The {} sequence: predicted wear is {} at its end.", s.name,
                                  error_text(s.final_error())),
                      true});
  section.add(trust_callout(r.checks));
  std::vector<html::Tile> tiles;
  for (const NamedLife& each : r.lives) {
    const LifeAtLevel& at = each.life.levels.back();
    tiles.push_back(
        {fmt::format("Life, {}", each.name), cycles_text(at.repetitions), "cycles",
         fmt::format("to {} worn; {} (95\u00a0%)", percent_text(at.level), description(at.full))});
  }
  tiles.push_back(
      {"R2p", fmt::format("{:.3f}", map.fit.r2p), "",
       fmt::format("linear {:.3f}, full cubic {:.3f}", r.maps[1].fit.r2p, r.maps[2].fit.r2p)});
  tiles.push_back({"Plate to plate", fmt::format("{:.1f}", 100 * r.run_in.plate_sd), "%",
                   "standard deviation of the log of a plate's factor"});
  section.add(present::Tiles{std::move(tiles)});
  std::vector<html::Figure> figures;
  for (const SequenceResult& s : r.sequences) figures.push_back(sequence_figure(s));
  if (figures.empty()) figures.push_back(parity_figure(r));
  section.add(Figures{std::move(figures)});
  return section;
}

Table life_table(const ClutchResult& r) {
  Table table{"life",
              "Life",
              {{"Operating point"},
               {"Worn", "%", given},
               {"Cycles", "1", fixed(0)},
               {"95 % by scatter", "1", present::life(5), true},
               {"95 % total", "1", present::life(5), true},
               {"Without run-in", "1", fixed(0)},
               {"Volume by scatter, ±", "mm^3", digits(3)},
               {"Relative, ±", "%", fixed(1)},
               {"Total volume, ±", "mm^3", digits(3)},
               {"Relative total, ±", "%", fixed(1)}}};
  for (const NamedLife& each : r.lives) {
    for (const LifeAtLevel& at : each.life.levels)
      table.rows.push_back({each.name, 100 * at.level, at.repetitions,
                            present::Range{at.scatter.low, at.scatter.high},
                            present::Range{at.full.low, at.full.high}, at.without_run_in,
                            2 * at.sd / mm3, 100 * at.relative, 2 * at.full_sd / mm3,
                            100 * at.full_relative});
  }
  return table;
}

/// A plate by its number or its name.
present::Cell plate_cell(const ClutchResult& r, int plate) {
  if (r.plate_names.empty()) return static_cast<double>(plate);
  return r.plate_name(plate);
}

Table sequence_table(const ClutchResult& r) {
  Table table{"sequences",
              "Worn volume along the sequences",
              {{"Sequence"},
               {"Plate", "1", given},
               {"Cycle", "1", given},
               {"Energy", "MJ"},
               {"Measured", "mm^3"},
               {"Predicted", "mm^3"},
               {"Sd by scatter", "mm^3", digits(3)},
               {"Sd total", "mm^3", digits(3)}}};
  for (const SequenceResult& s : r.sequences) {
    for (const auto& w : s.weighings)
      table.rows.push_back({s.name, plate_cell(r, s.plate), static_cast<double>(w.cycle),
                            w.energy / MJ, w.measured / mm3, w.predicted / mm3, w.sd / mm3,
                            w.full_sd / mm3});
  }
  return table;
}

Section prediction_section(const ClutchResult& r) {
  Section section{"predictions", "Predictions"};
  if (!r.lives.empty()) {
    section.add(Figures{{width_figure(r)}});
    section.add(life_table(r));
  }
  section.add(
      Prose{fmt::format("Using the mean inputs of a point instead of summing its cycles changes "
                        "the predicted volume of the whole campaign by {:.3f}\u00a0%.",
                        100 * r.averaging.total)});
  if (!r.sequences.empty())
    section.add(present::Details{"Every weighing of a sequence", {{sequence_table(r)}}});
  return section;
}

Table correlation_table(const ClutchResult& r) {
  Table table{"correlations",
              "Correlation of the wear rate with each input",
              {{"Input"}, {"r", "1", fixed(3)}}};
  for (std::size_t i = 0; i < inputs.size(); ++i)
    table.rows.push_back({inputs[i].symbol, r.correlations[i]});
  return table;
}

Table map_table(const ClutchResult& r) {
  Table table{"models",
              "Models",
              {{"Model"},
               {"R2", "1", fixed(3)},
               {"R2p", "1", fixed(3)},
               {"RMSE, relative", "1", fixed(3)},
               {"RMSEp, relative", "1", fixed(3)},
               {"Terms", "1", given}}};
  const double unit = r.maps.front().fit.rmse;
  for (const WearMap& map : r.maps)
    table.rows.push_back({map.name, map.fit.r2, map.fit.r2p, map.fit.rmse / unit,
                          map.fit.rmsep / unit, count(map.terms.size())});
  return table;
}

Table term_table(const WearModel& model) {
  Table table{"terms",
              "Selected terms, each scaled to [0, 1]",
              {{"Term"}, {"Coefficient", rate_unit}, {"Standard error", rate_unit, digits(3)}}};
  for (std::size_t j = 0; j < model.terms.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    table.rows.push_back({model.terms[j].name, model.terms[j].coefficient / mm3_per_MJ,
                          std::sqrt(model.covariance(at, at)) / mm3_per_MJ});
  }
  return table;
}

Table surrogate_table(const ClutchResult& r) {
  Table table{"surrogates",
              "Surrogate inputs, best R2p",
              {{"Surrogate"},
               {"r", "1", fixed(1)},
               {"q", "1", fixed(1)},
               {"R2p", "1", fixed(3)},
               {"Mean over temperature levels", "1", fixed(3)}}};
  for (const SurrogateResult& s : r.surrogates)
    table.rows.push_back({name_of(s.surrogate), s.best.r, s.best.q, s.best.r2p,
                          s.r2p.empty() ? Cell() : Cell(s.mean_r2p)});
  return table;
}

Table validation_table(const Validation& validation) {
  Table table{"held-out-points",
              "Held-out points",
              {{"Point", "1", given},
               {"Measured", rate_unit, digits(3)},
               {"Predicted", rate_unit, digits(3)},
               {"Studentized residual", "1", fixed(2)},
               {"Verdict"}}};
  for (const ValidationPoint& p : validation.points)
    table.rows.push_back({static_cast<double>(p.number), p.measured / mm3_per_MJ,
                          p.predicted / mm3_per_MJ, p.t, p.outlier ? "outlier" : ""});
  return table;
}

Table measure_table(const Validation& validation) {
  Table table{
      "validation",
      "Held-out points together",
      {{"Which"}, {"Points", "1", given}, {"R2", "1", fixed(3)}, {"RMSE", rate_unit, digits(3)}}};
  const auto add = [&](const char* name, const Validation::Metrics& m) {
    table.rows.push_back({name, static_cast<double>(m.points), m.r2, m.rmse / mm3_per_MJ});
  };
  add("All", validation.all);
  if (validation.without_outliers.points < validation.all.points)
    add("Without outliers", validation.without_outliers);
  return table;
}

Section map_section(const ClutchStudy& study, const ClutchResult& r) {
  Section section{"map", "Wear rate"};
  std::vector<html::Figure> figures = {exponent_figure(r.search)};
  if (!r.sequences.empty()) figures.insert(figures.begin(), parity_figure(r));
  for (html::Figure& each : map_figures(study, r)) figures.push_back(std::move(each));
  section.add(Figures{std::move(figures)});
  section.add(correlation_table(r));
  section.add(map_table(r));
  section.add(term_table(r.model));
  section.add(surrogate_table(r));
  if (r.validation.points.empty()) return section;
  section.add(measure_table(r.validation));
  section.add(validation_table(r.validation));
  return section;
}

Section run_in_section(const ClutchResult& r) {
  Section section{"run-in-section", "Run-in"};
  section.add(Figures{{run_in_figure(r)}});
  Table constants{"run-in",
                  "Constants of run-in",
                  {{"Constant"}, {"Unit"}, {"Fitted"}, {"Standard error", "1", digits(3)}}};
  for (int i = 0; i < RunInFit::size; ++i) {
    const auto& [name, unit, si] = run_in_constants[static_cast<std::size_t>(i)];
    constants.rows.push_back(
        {name, unit, r.run_in.parameters[i] / si, std::sqrt(r.run_in.covariance(i, i)) / si});
  }
  Table plates{"plates",
               "Plates",
               {{"Plate", "1", given},
                {"Factor fitted", "1", fixed(3)},
                {"Relative error", "%", fixed(1)},
                {"Factor used", "1", fixed(3)}}};
  for (const PlateFactor& p : r.run_in.plates)
    plates.rows.push_back(
        {plate_cell(r, p.plate), std::exp(p.log_factor), 100 * p.standard_error, p.factor()});
  section.add(std::move(constants));
  section.add(std::move(plates));
  return section;
}

Section scatter_section(const ClutchResult& r) {
  Section section{"scatter-section", "Scatter"};
  section.add(Figures{{normal_figure(r), scatter_figure(r)}});
  Table table{"scatter",
              "Candidates for the scatter of one cycle",
              {{"sigma_w"},
               {"−log L", "1", fixed(2)},
               {"AIC", "1", fixed(2)},
               {"Kolmogorov-Smirnov p", "1", fixed(3)},
               {"Lilliefors p", "1", fixed(3)}}};
  for (const ScatterFit& fit : r.scatter.candidates)
    table.rows.push_back({formula_of(fit.law.kind), fit.negative_log_likelihood, fit.aic,
                          fit.kolmogorov.p, fit.lilliefors.p});
  section.add(std::move(table));
  return section;
}

Table closing_table(const ClutchResult& r) {
  Table table{"closings",
              "Closings found in the raw traces",
              {{"Plate", "1", given},
               {"Closing", "1", given},
               {"ω₀", "rpm"},
               {"t₂", "s", digits(3)},
               {"M", "N m", digits(3)},
               {"T", "°C"},
               {"E", "kJ"},
               {"Flag"}}};
  for (const Closing& c : r.closings)
    table.rows.push_back({plate_cell(r, c.cycle.plate), static_cast<double>(c.cycle.number),
                          c.cycle.at.slip_speed / rpm, c.cycle.at.closing_time, c.cycle.at.torque,
                          c.cycle.at.temperature, c.cycle.energy / 1e3, c.flag});
  return table;
}

Section method_section(const ClutchStudy& study, const ClutchResult& r) {
  Section section{"method", "Method", {}, "Method and reproducibility"};
  present::Facts facts{
      {{"Program", "wearwell " + r.version},
       {"Model", "clutch-wear"},
       {"Search", fmt::format("{} exact searches of {:.0f} submodels each", r.search.pairs.size(),
                              r.search.submodels)},
       {"Points left out of the whole search",
        fmt::format("R2 {:.3f} +- {:.3f}, {} parts", r.nested.r2, r.nested.r2_error,
                    r.nested.folds)},
       {"Time of the search", fmt::format("{:.1f} s", r.search.seconds)},
       {"Time taken", fmt::format("{:.1f} s", r.seconds)},
       {valid_utf8(study.file.filename().string()), "SHA-1 " + sha1_of(study.file_text)}}};
  for (std::size_t i = 0; i < study.files.size(); ++i)
    facts.facts.emplace_back(study.files[i].filename().string(), "SHA-1 " + study.sha1s.at(i));
  section.add(std::move(facts));
  if (!r.closings.empty()) section.add(closing_table(r));
  section.add(present::Details{"Study file", {{present::Verbatim{study.file_text}}}});
  return section;
}

}  // namespace

std::vector<Section> report_sections(const ClutchStudy& study, const ClutchResult& r) {
  Section checks{"checks", "Checks"};
  checks.add(checks_table(r.checks));
  return {verdict_section(study, r), prediction_section(r), map_section(study, r),
          run_in_section(r),         scatter_section(r),    checks,
          method_section(study, r)};
}

}  // namespace wearwell::clutch
