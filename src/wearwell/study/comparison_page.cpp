#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/present/page.h"
#include "wearwell/present/plot.h"
#include "wearwell/present/section.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/comparison_overlays.h"
#include "wearwell/study/density_unit.h"
#include "wearwell/study/never_reached.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {
namespace {

using present::Cell;
using present::digits;
using present::fixed;
using present::Prose;
using present::Section;
using present::Table;
using Numbers = std::vector<double>;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : fmt::format("{} [{}]", name, html::unit(unit));
}

Section verdict_section(const Comparison& comparison) {
  Section section{"comparison", "Comparison"};
  if (!comparison.note.empty()) section.add(Prose{comparison.note});
  if (!comparison.comparable) {
    section.add(present::Callout{"warn", "Not ranked.", comparison.obstacle});
  } else {
    Table table{"comparison",
                "Prediction of each observation from all others, best first",
                {{"Study"},
                 {"elpd", "1", fixed(2)},
                 {"Se", "1", fixed(2)},
                 {"Behind the best", "1", fixed(2)},
                 {"Se of that", "1", fixed(2)},
                 {"Weight", "1", fixed(3)},
                 {"p_loo", "1", fixed(1)},
                 {"Largest Pareto k", "1", fixed(2)},
                 {"AIC", "1", fixed(2)},
                 {"BIC", "1", fixed(2)},
                 {"Parameters", "1", fixed(0)}}};
    for (const auto& [name, result, behind, weight] : comparison.studies) {
      const Loo& loo = result.loo->loo;
      const bool mode = result.mode && result.mode->problem.empty();
      table.rows.push_back({name, loo.elpd(), loo.se(), behind->value, behind->se, weight,
                            loo.p_loo(), loo.khat_max(), mode ? Cell(result.mode->aic) : Cell(),
                            mode ? Cell(result.mode->bic) : Cell(),
                            static_cast<double>(result.parameters.size())});
    }
    section.add(std::move(table));
    const std::string data_unit =
        DensityUnit::description(comparison.studies.front().result.loo->density_unit);
    section.add(Prose{fmt::format(
        "elpd is the expected log predictive density, summed over the observations (natural "
        "logarithm{}); larger is better. Weights are those of the mixture that predicts best "
        "(stacking). Smaller AIC and BIC are better.",
        data_unit.empty() ? "" : ", " + data_unit)});
  }
  if (!comparison.conclusion.empty()) section.add(Prose{comparison.conclusion});
  for (const std::string& caution : comparison.cautions) section.add(Prose{caution});
  return section;
}

struct Overlaid {
  std::string name, unit;
  struct Of {
    std::size_t index;  // of the study
    std::string study;
    const ParameterSummary* summary;
    Numbers draws;  // finite values, ascending
  };
  std::vector<Of> of;
};

std::vector<Overlaid> overlaid(const Comparison& comparison) {
  std::vector<Overlaid> all;
  for (std::size_t s = 0; s < comparison.studies.size(); ++s) {
    const auto& [name, result, behind, weight] = comparison.studies[s];
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      const ParameterSummary& p = result.parameters[i];
      auto found = std::find_if(all.begin(), all.end(), [&](const Overlaid& each) {
        return each.name == p.name && each.unit == p.unit;
      });
      if (found == all.end()) {
        all.push_back({p.name, p.unit, {}});
        found = all.end() - 1;
      }
      Numbers draws;
      for (const Chain& chain : result.draws) {
        const auto column = chain.values.col(static_cast<Eigen::Index>(i));
        std::copy_if(column.begin(), column.end(), std::back_inserter(draws),
                     [](double x) { return std::isfinite(x); });
      }
      std::sort(draws.begin(), draws.end());
      found->of.push_back({s, name, &p, std::move(draws)});
    }
  }
  return all;
}

// Fig. 6 of Heo et al. (2011): the histograms of one parameter in several studies.
html::Figure histograms(const Overlaid& parameter) {
  constexpr std::size_t bins = 40;
  double low = INFINITY, high = -INFINITY;
  for (const auto& each : parameter.of) {
    const std::size_t cut = each.draws.size() / 400;
    low = std::min(low, each.draws[cut]);
    high = std::max(high, each.draws[each.draws.size() - 1 - cut]);
  }
  if (!(high > low)) high = low + std::max(1e-12, 1e-6 * std::abs(low));
  const double width = (high - low) / bins;
  Numbers edges;
  for (std::size_t i = 0; i <= bins; ++i) {
    edges.push_back(std::lerp(low, high, static_cast<double>(i) / bins));
  }
  std::vector<plot::Json> marks;
  for (std::size_t s = 0; s < parameter.of.size(); ++s) {
    const Numbers& draws = parameter.of[s].draws;
    Numbers density(bins, 0.0);
    for (const double x : draws) {
      if (x < low || x > high) continue;
      const auto bin = std::min(bins - 1, static_cast<std::size_t>((x - low) / width));
      density[bin] += 1 / (static_cast<double>(draws.size()) * width);
    }
    density.push_back(density.back());
    marks.push_back(plot::steps({{"x", edges}, {"y", density}},
                                look_of_study(parameter.of[s].index, parameter.of[s].study)));
  }
  return {"overlay-" + parameter.name, parameter.name,
          "The posterior draws of each study; each area is one.",
          plot::plot(fmt::format("Histograms of {} in each study", parameter.name),
                     {with_unit(parameter.name, parameter.unit)},
                     {"Density", false, 0.0, {}, {}, false}, marks)};
}

Section parameter_section(const std::vector<Overlaid>& parameters, bool one_study) {
  Table table{"parameters",
              one_study ? "Parameters of the written family, for each family of lives"
                        : "Parameters of each study",
              {{"Parameter"},
               {"Unit"},
               {"Study"},
               {"Mean"},
               {"Sd", "1", digits(3)},
               {"5 %"},
               {"50 %"},
               {"95 %"}}};
  std::vector<html::Figure> figures;
  for (const Overlaid& parameter : parameters) {
    for (const auto& each : parameter.of) {
      const ExactSummary b = each.summary->best();
      table.rows.push_back(
          {parameter.name, parameter.unit, each.study, b.mean, b.sd, b.q05, b.q50, b.q95});
    }
    const bool drawn = std::none_of(parameter.of.begin(), parameter.of.end(),
                                    [](const Overlaid::Of& each) { return each.draws.empty(); });
    if (drawn) figures.push_back(histograms(parameter));
  }
  Section section{"parameters", "Parameters"};
  section.add(present::Figures{std::move(figures)});
  section.add(std::move(table));
  return section;
}

// B-lives of one study with several families.
Table b_life_table(const Comparison& comparison) {
  Table table{"b-lives",
              "B-lives of each family",
              {{"Life"}, {"Unit"}, {"Family"}, {"5 %"}, {"50 %"}, {"95 %"}}};
  if (comparison.note.empty()) return table;
  for (const QuantitySummary& wanted : comparison.studies.front().result.quantities) {
    if (!is_b_life(wanted)) continue;
    for (const auto& study : comparison.studies) {
      const QuantitySummary* const found = same_quantity(study.result, wanted);
      if (!found) continue;
      const QuantityQuantiles& q = found->best();
      table.rows.push_back({life_label(wanted), wanted.unit, study.name, q.q05, q.q50, q.q95});
    }
  }
  return table;
}

Section answer_section(const Comparison& comparison) {
  Section section{"answers", "Curves and lives"};
  if (auto figures = curve_figures(comparison); !figures.empty())
    section.add(present::Figures{std::move(figures)});
  if (auto table = b_life_table(comparison); !table.rows.empty()) section.add(std::move(table));
  if (auto table = life_table(comparison); !table.rows.empty()) section.add(std::move(table));
  return section;
}

Section study_section(const Comparison& comparison) {
  Table table{
      "studies",
      "Studies",
      {{"Study"}, {"Title"}, {"Model"}, {"Data"}, {"Rows", "1", present::given}, {"Trusted"}},
      {},
      true};
  for (const auto& [name, result, behind, weight] : comparison.studies) {
    const Header& header = result.header;
    table.rows.push_back({name, header.title, header.equation, header.data.names(),
                          static_cast<double>(header.data.rows), trust_word(header.checks)});
  }
  Section section{"studies", "Studies"};
  section.add(std::move(table));
  return section;
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  std::string names;
  for (const auto& each : comparison.studies) names += (names.empty() ? "" : ", ") + each.name;
  std::vector<Section> sections = {verdict_section(comparison)};
  if (Section section = answer_section(comparison); !section.blocks.empty())
    sections.push_back(std::move(section));
  sections.push_back(parameter_section(overlaid(comparison), !comparison.note.empty()));
  sections.push_back(study_section(comparison));
  return html_page(
      {comparison.studies.front().result.header.version, "Comparison of studies", names, sections});
}

}  // namespace wearwell
