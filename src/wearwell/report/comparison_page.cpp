#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "wearwell/report/comparison.h"
#include "wearwell/report/html.h"
#include "wearwell/report/page.h"
#include "wearwell/report/plot.h"

namespace wearwell {
namespace {

using html::escape;
using html::number;
using Numbers = std::vector<double>;

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit == "1" ? name : fmt::format("{} [{}]", name, html::unit(unit));
}

std::string fixed(double x) {
  return fmt::format("{:.2f}", x);
}

std::string verdict_section(const Comparison& comparison) {
  std::string out;
  if (!comparison.comparable) {
    out += html::callout("warn", "Not ranked.", comparison.obstacle);
  } else {
    html::Table table{"Prediction of each observation from all others, best first",
                      {"Study", "elpd", "Se", "Behind the best", "Se of that", "p_loo",
                       "Largest Pareto k", "AIC", "BIC", "Parameters"},
                      {}};
    for (const auto& [name, result, behind] : comparison.studies) {
      const Loo& loo = result.loo->loo;
      const bool mode = result.mode && result.mode->problem.empty();
      table.rows.push_back({name, fixed(loo.elpd()), fixed(loo.se()), fixed(behind->value),
                            fixed(behind->se), fmt::format("{:.1f}", loo.p_loo()),
                            fixed(loo.khat_max()), mode ? fixed(result.mode->aic) : "–",
                            mode ? fixed(result.mode->bic) : "–",
                            fmt::format("{}", result.parameters.size())});
    }
    out += html::table(table) +
           "<p>elpd is the expected log predictive density, summed over the observations (natural "
           "logarithm, data in SI units); larger is better. Smaller AIC and BIC are better.</p>\n";
  }
  for (const std::string& caution : comparison.cautions) {
    out += fmt::format("<p>{}</p>\n", escape(caution));
  }
  return out;
}

struct Overlaid {
  std::string name, unit;
  struct Of {
    std::string study;
    const ParameterSummary* summary;
    Numbers draws;  // those that are finite, ascending
  };
  std::vector<Of> of;
};

std::vector<Overlaid> overlaid(const Comparison& comparison) {
  std::vector<Overlaid> all;
  for (const auto& [name, result, behind] : comparison.studies) {
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
      for (const Chain& chain : result.posterior_draws) {
        const auto column = chain.values.col(static_cast<Eigen::Index>(i));
        std::copy_if(column.begin(), column.end(), std::back_inserter(draws),
                     [](double x) { return std::isfinite(x); });
      }
      std::sort(draws.begin(), draws.end());
      found->of.push_back({name, &p, std::move(draws)});
    }
  }
  return all;
}

// Fig. 6 of Heo et al. (2011): the histograms of one parameter in several studies.
html::Figure histograms(const Overlaid& parameter) {
  constexpr std::size_t bins = 40;
  static constexpr const char* colours[] = {plot::colour::chains[0], plot::colour::chains[1],
                                            plot::colour::chains[2], plot::colour::chains[3],
                                            plot::colour::limit,     plot::colour::prior};
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
                                {colours[s % std::size(colours)], parameter.of[s].study, 0.95, 2,
                                 s >= std::size(colours)}));
  }
  return {"overlay-" + parameter.name, parameter.name,
          "The posterior's draws of each study; the areas are one.",
          plot::plot(fmt::format("Histograms of {} in each study", parameter.name),
                     {with_unit(parameter.name, parameter.unit)},
                     {"Density", false, 0.0, {}, {}, false}, marks)};
}

std::string parameter_section(const std::vector<Overlaid>& parameters) {
  html::Table table{
      "Parameters of each study", {"Parameter", "Study", "Mean", "Sd", "5 %", "50 %", "95 %"}, {}};
  std::vector<html::Figure> figures;
  for (const Overlaid& parameter : parameters) {
    for (const auto& each : parameter.of) {
      const ParameterSummary& p = *each.summary;
      const ExactSummary b = p.best();
      table.rows.push_back({with_unit(parameter.name, parameter.unit), each.study, number(b.mean),
                            number(b.sd, 3), number(b.q05), number(b.q50), number(b.q95)});
    }
    const bool drawn = std::none_of(parameter.of.begin(), parameter.of.end(),
                                    [](const Overlaid::Of& each) { return each.draws.empty(); });
    if (drawn) figures.push_back(histograms(parameter));
  }
  return html::figures(figures) + html::table(table);
}

std::string study_section(const Comparison& comparison) {
  html::Table table{"Studies", {"Study", "Title", "Model", "Data", "Trusted"}, {}, true};
  for (const auto& [name, result, behind] : comparison.studies) {
    table.rows.push_back({name, result.title, html::raised(result.equation),
                          fmt::format("{}, {} rows", result.data_file, result.data_rows),
                          result.trusted ? "yes" : "no"});
  }
  return html::table(table);
}

}  // namespace

std::string comparison_page(const Comparison& comparison) {
  std::string names;
  for (const auto& each : comparison.studies) names += (names.empty() ? "" : ", ") + each.name;
  return html_page({comparison.studies.front().result.version,
                    "Comparison of studies",
                    names,
                    {{"comparison", "Comparison", verdict_section(comparison)},
                     {"parameters", "Parameters", parameter_section(overlaid(comparison))},
                     {"studies", "Studies", study_section(comparison)}}});
}

}  // namespace wearwell
