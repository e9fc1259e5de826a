#include "wearwell/study/family_ranking.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/infer/exact.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"
#include "wearwell/prob/log_location_scale.h"
#include "wearwell/study/family_study.h"
#include "wearwell/study/never_reached.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell {
namespace {

// Lives agree if the largest is at most this times the least.
constexpr double agreement = 1.1;

std::vector<std::string> listed_families(const std::string& text) {
  if (text == "all") {
    const auto all = exchangeable_families();
    return {all.begin(), all.end()};
  }
  std::vector<std::string> names;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    std::string name = text.substr(at, comma - at);
    std::erase(name, ' ');
    at = comma + 1;
    if (name.empty()) throw InputError("--families: an empty name; write weibull,lognormal");
    std::vector<std::string> meant = {name};
    if (name == LogLocationScale::name) {
      meant.clear();
      for (const LogLocationScale& each : log_location_scale_families)
        meant.emplace_back(each.family);
    }
    for (const std::string& each : meant) {
      if (contains(names, each)) throw InputError(fmt::format("--families: '{}' twice", each));
      names.push_back(each);
    }
  }
  return names;
}

SavedResult fitted(const Source& source, const std::string& family, Models models,
                   const Monitor& monitor) {
  const auto study = read_study(source, models);
  const auto* const posterior = dynamic_cast<const PosteriorStudy*>(study.get());
  RunOptions options;
  options.report = false;
  if (posterior && posterior->parameters.size() <= max_exact_dimension)
    options.sampler.method = Method::exact;
  Result result = study->run(options, monitor);
  if (!result.posterior)
    throw InputError(
        fmt::format("{}: has no posterior for {} lives", source.study.path.string(), family));
  const PosteriorSummary& summary = *result.posterior;
  return {std::move(result.header),
          summary.parameters,
          summary.mode,
          summary.loo,
          summary.posterior_draws,
          summary.quantities,
          {}};
}

std::string interval_text(const QuantityQuantiles& known) {
  return fmt::format("{} ({} to {})", plain_number(known.q50), plain_number(known.q05),
                     plain_number(known.q95));
}

std::string label(const QuantitySummary& each) {
  return life_label(each) + fmt::format(" [{}]", each.unit);
}

// Least and largest value of one quantile under the families that are close.
struct CloseRange {
  double least = INFINITY, most = -INFINITY;
  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
  bool agrees() const { return least > 0 && most <= agreement * least; }
};

struct LifeRange {
  CloseRange low, median, high;
  bool known = true;  // by all of them
};

LifeRange range_of(const FamilyRanking& ranking, const QuantitySummary& wanted) {
  LifeRange range;
  for (const Comparison::Entry& each : ranking.comparison.studies) {
    if (!contains(ranking.close, each.name)) continue;
    const QuantitySummary* const found = same_quantity(each.result, wanted);
    range.known = range.known && found;
    if (!found) continue;
    range.low.add(found->best().q05);
    range.median.add(found->best().q50);
    range.high.add(found->best().q95);
  }
  return range;
}

std::string conclusion(const FamilyRanking& ranking) {
  const auto& studies = ranking.comparison.studies;
  if (!ranking.comparison.comparable) return "";
  if (ranking.close.size() == 1)
    return fmt::format("The data separate {} from all others: one distribution will do.",
                       ranking.close.front());
  std::string text = fmt::format(
      "The data do not separate {}: differences of elpd are below {:.0f}, or below twice their "
      "standard error.",
      fmt::join(ranking.close, ", "), small_elpd_difference);
  std::vector<std::string> agree, near, differ;
  for (const QuantitySummary& wanted : studies.front().result.quantities) {
    if (!is_b_life(wanted)) continue;
    const auto [low, median, high, known] = range_of(ranking, wanted);
    if (!known) continue;
    const bool inside = median.least >= low.most && median.most <= high.least;
    (low.agrees() && median.agrees() && high.agrees() ? agree
     : inside                                         ? near
                                                      : differ)
        .push_back(fmt::format("{} ({} to {})", label(wanted), plain_number(median.least),
                               plain_number(median.most)));
  }
  if (!agree.empty())
    text +=
        fmt::format(" One of them will do for {}: median and both bounds agree within {:.0f} %.",
                    fmt::join(agree, ", "), 100 * (agreement - 1));
  if (!near.empty())
    text += fmt::format(
        " For {} the medians differ less than their uncertainty, but medians or "
        "bounds differ by more than {:.0f} %.",
        fmt::join(near, ", "), 100 * (agreement - 1));
  if (!differ.empty())
    text += fmt::format(" The choice matters for {}: report all of them.", fmt::join(differ, ", "));
  if (!agree.empty() || !near.empty() || !differ.empty()) return text;
  return text + " State predict.b_lives to see whether the choice matters.";
}

// An error in a study that the user did not write begins with its family.
template <class Work>
auto in_family(const std::string& family, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", family, error.what()));
  }
}

}  // namespace

FamilyRanking rank_families(const Source& study, const std::string& families, Models models,
                            const Monitor& monitor) {
  const std::vector<std::string> names = listed_families(families);
  if (names.size() < 2) throw InputError("--families: needs two families or more, or all");
  std::vector<std::pair<std::string, SavedResult>> results;
  // All studies are written before the first fit, without the tables, which can be large.
  std::vector<TextFile> written;
  for (const std::string& each : names)
    written.push_back(study_with_family({study.study}, each).study);
  Source source = study;
  for (std::size_t i = 0; i < names.size(); ++i) {
    source.study = written[i];
    results.emplace_back(
        names[i], in_family(names[i], [&] { return fitted(source, names[i], models, monitor); }));
  }
  FamilyRanking ranking{compare(std::move(results)), {}};
  for (const Comparison::Entry& each : ranking.comparison.studies) {
    if (each.behind &&
        (each.behind->value < small_elpd_difference || each.behind->value < 2 * each.behind->se))
      ranking.close.push_back(each.name);
  }
  ranking.comparison.note = family_priors(written_family(study), names);
  ranking.comparison.conclusion = conclusion(ranking);
  return ranking;
}

std::string ranking_text(const FamilyRanking& ranking) {
  std::vector<std::vector<std::string>> lines = {{""}};
  const auto& studies = ranking.comparison.studies;
  for (const QuantitySummary& each : studies.front().result.quantities)
    if (is_b_life(each)) lines.front().push_back(label(each));
  for (const Comparison::Entry& each : studies) {
    lines.push_back({"  " + each.name});
    for (const QuantitySummary& wanted : studies.front().result.quantities) {
      if (!is_b_life(wanted)) continue;
      const QuantitySummary* const found = same_quantity(each.result, wanted);
      lines.back().push_back(found ? interval_text(found->best()) : "-");
    }
  }
  std::string text = comparison_text(ranking.comparison);
  if (lines.front().size() > 1) text += "\nLives, median (90 %)\n" + text_table(lines);
  if (const std::string& end = ranking.comparison.conclusion; !end.empty())
    text += "\n" + wrapped(printable(end), 0, 2);
  return text;
}

nlohmann::ordered_json ranking_json(const FamilyRanking& ranking) {
  nlohmann::ordered_json json = to_json(ranking.comparison);
  for (std::size_t i = 0; i < ranking.comparison.studies.size(); ++i) {
    nlohmann::ordered_json lives = nlohmann::ordered_json::array();
    for (const QuantitySummary& each : ranking.comparison.studies[i].result.quantities) {
      if (!is_b_life(each)) continue;
      lives.push_back({{"name", each.name},
                       {"of", each.of},
                       {"at", each.at},
                       {"unit", each.unit},
                       {"q05", each.best().q05},
                       {"q50", each.best().q50},
                       {"q95", each.best().q95}});
    }
    json["studies"][i]["b_lives"] = std::move(lives);
  }
  json["close"] = ranking.close;
  return json;
}

}  // namespace wearwell
