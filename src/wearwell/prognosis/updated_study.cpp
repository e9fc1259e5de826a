#include "wearwell/prognosis/updated_study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>

#include "wearwell/base/printable.h"
#include "wearwell/bayes/normal_score.h"
#include "wearwell/present/section.h"
#include "wearwell/present/text_table.h"

namespace wearwell::prognosis {
namespace {

constexpr int judged_draws = 400, judged_expensive = 100;
constexpr std::size_t most_reported = 5;  // number in a sentence; the table has all

// Points of the posterior, evenly by weight.
std::vector<Eigen::Index> evenly(const WeightedDraws& draws, int most) {
  std::vector<Eigen::Index> points;
  double sum = 0;
  for (Eigen::Index i = 0; i < draws.values.rows(); ++i) {
    sum += draws.weights[i];
    while (static_cast<int>(points.size()) < most &&
           sum > (static_cast<double>(points.size()) + 0.5) / most)
      points.push_back(i);
  }
  return points;
}

std::string plural(std::size_t n, const char* one, const char* many) {
  return fmt::format("{} {}", n, n == 1 ? one : many);
}

Check check_of(const JoinedData& joined, const std::string& files) {
  std::string detail =
      fmt::format("{} of {} counted", plural(joined.counted, "row", "rows"), files);
  if (joined.repeated > 0)
    detail += fmt::format("; {} known already and {} once",
                          joined.repeated == 1 ? "1 was" : fmt::format("{} were", joined.repeated),
                          joined.repeated == 1 ? "counts" : "count");
  if (joined.counted > 0 && joined.fresh.empty())
    detail += "; data.sql leaves them out, so that the study has no new rows";
  if (joined.contradictions.empty()) return {"new-data", Verdict::pass, detail, ""};
  std::vector<std::string> reported;
  for (const Contradiction& each : joined.contradictions) {
    if (reported.size() < most_reported)
      reported.push_back(fmt::format("{}: {}", each.place, each.why));
  }
  const std::size_t more = joined.contradictions.size() - reported.size();
  detail +=
      fmt::format("; {} the earlier posterior: {}{}",
                  joined.contradictions.size() == 1
                      ? "1 contradicts"
                      : fmt::format("{} contradict", joined.contradictions.size()),
                  fmt::join(reported, "; "), more > 0 ? fmt::format("; and {} more", more) : "");
  return {"new-data", Verdict::warn, detail,
          "They still count. Check them for a typing error, a reading of another unit, another "
          "gauge, or an event that the model does not describe."};
}

PresetAddition addition_of(const JoinedData& joined, const std::string& files) {
  PresetAddition added;
  added.body["update"] = rows_json(joined, files);
  present::Table table{"new-data",
                       "New readings that contradict the earlier posterior",
                       {{"row", "1", present::given}, {"reading"}, {"contradicts"}},
                       {},
                       true};
  for (const Contradiction& each : joined.contradictions)
    table.rows.push_back({present::count(each.row + 1), each.place, each.why});
  if (!joined.contradictions.empty()) added.blocks["checks"] = {{table}};
  return added;
}

void add(PresetAddition own, PresetAddition& all) {
  for (auto& [key, value] : own.body.items()) all.body[key] = value;
  for (auto& [section, blocks] : own.blocks) {
    auto& to = all.blocks[section];
    to.insert(to.end(), blocks.begin(), blocks.end());
  }
  all.text += own.text;
}

}  // namespace

nlohmann::ordered_json rows_json(const JoinedData& joined, const std::string& files) {
  nlohmann::ordered_json update = {{"files", files},
                                   {"rows_before", joined.before},
                                   {"counted", joined.counted},
                                   {"repeated", joined.repeated},
                                   {"contradictions", nlohmann::ordered_json::array()},
                                   {"notes", joined.notes}};
  for (const Contradiction& each : joined.contradictions)
    update["contradictions"].push_back(
        {{"row", each.row + 1}, {"place", each.place}, {"why", each.why}});
  return update;
}

std::optional<std::vector<Contradiction>> hardly_possible(const PosteriorStudy& study,
                                                          const WeightedDraws& before,
                                                          const JoinedData& joined) {
  constexpr double least = 1e-3;
  const std::size_t rows = data_table(joined.source).rows;
  std::vector<Contradiction> found;
  if (joined.fresh.empty()) return found;
  if (!study.fit_data || before.values.cols() != static_cast<Eigen::Index>(study.parameters.size()))
    return std::nullopt;
  std::size_t of_effects = 0;
  for (const UnitEffect& effect : study.fit_data->effects) of_effects += effect.of.size();
  const std::vector<Eigen::Index> points =
      evenly(before, study.fit_data->cheap ? judged_draws : judged_expensive);
  std::vector<std::vector<NormalScore>> scores(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t p) {
    scores[p] = study.fit_data->scores(before.values.row(points[p]).data());
  });
  if (scores.empty() || scores.front().size() != rows + of_effects) return std::nullopt;
  for (const std::size_t row : joined.fresh) {
    double below = 0, above = 0;  // for an observation in an interval its most favorable value
    for (const std::vector<NormalScore>& each : scores) {
      below += normal_cdf(each[row].high);
      above += normal_cdf(-each[row].low);
    }
    const double p = 2 * std::min(below, above) / static_cast<double>(points.size());
    if (!(p * static_cast<double>(joined.fresh.size()) < least)) continue;
    found.push_back({row, "", fmt::format("two-sided predictive p-value {}", probability_text(p))});
  }
  return found;
}

void judge_new_data(const PosteriorStudy& study, const WeightedDraws& before, JoinedData& joined) {
  auto found = hardly_possible(study, before, joined);
  if (!found) {
    joined.notes.push_back(
        "new readings were compared with known ones by their place only: the model has no score "
        "for each row");
    found.emplace();
  }
  for (Contradiction& each : *found) {
    const auto known =
        std::find_if(joined.contradictions.begin(), joined.contradictions.end(),
                     [&](const Contradiction& other) { return other.row == each.row; });
    if (known != joined.contradictions.end()) {
      known->why += ", and " + each.why;
      continue;
    }
    each.place = place_text(data_table(joined.source), joined.roles, each.row);
    joined.contradictions.push_back(std::move(each));
  }
}

PosteriorStudy updated_study(const PosteriorStudy& study, JoinedData joined,
                             const std::string& files) {
  PosteriorStudy updated = study;
  const auto shared = std::make_shared<const JoinedData>(std::move(joined));
  updated.checks = [shared, files, own = study.checks](const Fit& fit) {
    std::vector<Check> checks = own ? own(fit) : std::vector<Check>();
    checks.insert(checks.begin(), check_of(*shared, files));
    return checks;
  };
  updated.addition = [shared, files, own = study.addition](const Fit& fit) {
    PresetAddition all = own ? own(fit) : PresetAddition();
    add(addition_of(*shared, files), all);
    return all;
  };
  return updated;
}

void add_new_data(const JoinedData& joined, const std::string& files, Result& result) {
  const Check check = check_of(joined, files);
  const PresetAddition added = addition_of(joined, files);
  result.header.checks.insert(result.header.checks.begin(), check);
  for (const auto& [key, value] : added.body.items()) result.body[key] = value;
  if (!result.sections.empty()) {
    present::Section section{"new-data", "New data"};
    section.add(present::Prose{check.detail + ". " + check.advice});
    for (const auto& [_, blocks] : added.blocks) {
      for (const auto& each : blocks) section.add(each);
    }
    result.sections.push_back(std::move(section));
  }
  if (!result.text) return;
  const std::string reported =
      wrapped((check.verdict == Verdict::pass ? "New data: " : "New data, WARN: ") +
                  printable(check.detail),
              0, 2);
  result.text = [reported, own = result.text](const TerminalStyle& style) {
    return own(style) + reported;
  };
}

}  // namespace wearwell::prognosis
