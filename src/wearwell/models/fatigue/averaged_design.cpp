#include "wearwell/models/fatigue/averaged_design.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/models/fatigue/lives_under.h"
#include "wearwell/prognosis/weighted_quantiles.h"
#include "wearwell/study/saved_result.h"

namespace wearwell::fatigue {
namespace {

// A random limit needs an integral at each point of a posterior.
constexpr Eigen::Index most_points_with_limit = 1000;
constexpr double slack = 1e-6;

bool alike(double a, double b) {
  return std::abs(a - b) <= slack * std::max(std::abs(a), std::abs(b));
}

// log10 of the lives that a share outlasts, with the weights of their points.
struct Lives {
  std::vector<double> log10, weights;

  double quantile(double p) const {
    if (std::any_of(log10.begin(), log10.end(), [](double life) { return std::isnan(life); }))
      return std::nan("");
    return std::pow(10, prognosis::weighted_quantiles(log10, weights, std::array{p}).front());
  }
  void add(const Lives& other, double weight) {
    log10.insert(log10.end(), other.log10.begin(), other.log10.end());
    for (const double each : other.weights) weights.push_back(weight * each);
  }
};

Lives lives_of(const SnLaw& law, const LivesUnder& under, const WeightedDraws& posterior,
               double reliability) {
  Lives lives{under.at_points(reliability), {posterior.weights.begin(), posterior.weights.end()}};
  if (law.logarithmic()) return lives;
  for (double& life : lives.log10) life = std::log10(std::max(life, 0.0));
  return lives;
}

std::string span_text(const SnResult& result, double low, double high) {
  return fmt::format("{:.6g} to {:.6g} {}", from_si(result.stress_unit, low),
                     from_si(result.stress_unit, high), result.stress_unit.text);
}

// The comparison knows the outcomes, not the stresses.
void require_same_stresses(const WeightedModel& a, const WeightedModel& b) {
  const TestedSpan &x = a.result.tested, &y = b.result.tested;
  if (a.result.stress_si != b.result.stress_si)
    throw InputError(fmt::format("{} and {} have different stress quantities: {} and {}", a.name,
                                 b.name, a.result.stress_unit.text, b.result.stress_unit.text));
  if (!alike(x.alternating_low, y.alternating_low) ||
      !alike(x.alternating_high, y.alternating_high))
    throw InputError(
        fmt::format("{} and {} were tested under different alternating stresses: {} and {}", a.name,
                    b.name, span_text(a.result, x.alternating_low, x.alternating_high),
                    span_text(b.result, y.alternating_low, y.alternating_high)));
  const bool both =
      a.result.law.correction != MeanStress::none && b.result.law.correction != MeanStress::none;
  const double size = slack * x.alternating_high;
  if (both &&
      !(std::abs(x.mean_low - y.mean_low) <= size && std::abs(x.mean_high - y.mean_high) <= size))
    throw InputError(fmt::format("{} and {} were tested under different mean stresses: {} and {}",
                                 a.name, b.name, span_text(a.result, x.mean_low, x.mean_high),
                                 span_text(b.result, y.mean_low, y.mean_high)));
}

}  // namespace

std::vector<DesignPoint> averaged_design(const std::vector<WeightedModel>& models,
                                         const DesignQuestion& question,
                                         const std::stop_token& stop) {
  std::vector<WeightedDraws> posteriors;
  for (const auto& [name, weight, result] : models)
    posteriors.push_back(curve_nodes(result.law, result.posterior, most_points_with_limit));
  std::vector<DesignPoint> points(question.alternating.size());
  tbb::parallel_for(std::size_t{0}, points.size(), [&](std::size_t i) {
    DesignPoint& point = points[i];
    point.stress = question.line.at(question.alternating[i]);
    point.models.resize(models.size());
    std::vector<LivesUnder> under;
    for (std::size_t m = 0; m < models.size(); ++m)
      under.emplace_back(models[m].result.law, posteriors[m], point.stress);
    // The life at one level: of the mixture, and `each` gets that of every model.
    const auto at_level = [&](double reliability, double confidence, const auto& each) {
      if (stop.stop_requested()) throw Cancelled();
      Lives mixture;
      for (std::size_t m = 0; m < models.size(); ++m) {
        const Lives own = lives_of(models[m].result.law, under[m], posteriors[m], reliability);
        each(m, own.quantile(1 - confidence));
        if (models[m].weight > 0) mixture.add(own, models[m].weight);
      }
      return mixture.quantile(1 - confidence);
    };
    point.median = at_level(0.5, 0.5, [](std::size_t, double) {});
    for (const DesignLevel& level : question.levels) {
      double least = INFINITY;
      point.averaged.push_back(
          at_level(level.reliability, level.confidence, [&](std::size_t m, double life) {
            point.models[m].push_back(life);
            if (models[m].weight >= least_weight) least = std::min(least, life);
          }));
      point.cautious.push_back(least);
    }
  });
  return points;
}

ModelsToAverage models_to_average(
    const std::vector<std::pair<std::string, std::filesystem::path>>& folders) {
  std::vector<std::pair<std::string, SavedResult>> saved;
  std::vector<std::pair<std::string, SnResult>> results;
  for (const auto& [name, folder] : folders) {
    if (std::any_of(saved.begin(), saved.end(),
                    [&given = name](const auto& each) { return each.first == given; }))
      throw InputError(fmt::format("{} is given twice", name));
    results.emplace_back(name, read_sn_result(folder));
    if (folders.size() > 1) saved.emplace_back(name, read_saved_result(folder));
  }
  if (results.size() == 1)
    return {{{results.front().first, 1, std::move(results.front().second)}}, {}};
  const Comparison comparison = compare(std::move(saved));
  if (!comparison.comparable)
    throw InputError("no design curve is averaged over these: " + comparison.obstacle);
  ModelsToAverage all;
  for (const Comparison::Entry& entry : comparison.studies) {
    const auto found = std::find_if(results.begin(), results.end(),
                                    [&](const auto& each) { return each.first == entry.name; });
    all.models.push_back({entry.name, entry.weight, std::move(found->second)});
    require_same_stresses(all.models.front(), all.models.back());
  }
  // AIC and BIC are not used.
  for (const std::string& caution : comparison.cautions)
    if (!caution.starts_with("AIC")) all.cautions.push_back(caution);
  return all;
}

std::vector<double> design_stresses(const std::vector<WeightedModel>& models) {
  const TestedSpan& tested = models.front().result.tested;
  const double low = tested.alternating_low, high = tested.alternating_high;
  if (!(high > low)) return {high};
  const bool expensive = std::any_of(models.begin(), models.end(),
                                     [](const auto& each) { return each.result.law.integrated(); });
  const int count = expensive ? 9 : 21;
  std::vector<double> stresses;
  for (int i = 0; i < count; ++i) {
    const double share = static_cast<double>(i) / (count - 1);
    stresses.push_back(i + 1 == count ? low : high * std::pow(low / high, share));
  }
  return stresses;
}

StressLine design_line(const std::vector<WeightedModel>& models) {
  for (const auto& [name, weight, result] : models) {
    if (result.law.correction == MeanStress::none) continue;
    const TestedSpan& tested = result.tested;
    const double size = slack * tested.alternating_high;
    if (tested.mean_high - tested.mean_low <= size) return {tested.mean_low, {}};
    const double low = tested.mean_low / tested.alternating_low,
                 high = tested.mean_high / tested.alternating_high;
    if (alike(low, high)) return {0, (low - 1) / (low + 1)};
    throw InputError(
        fmt::format("the tests of {} had mean stresses of {} and no single stress ratio: give that "
                    "of the design, --mean-stress or --stress-ratio",
                    name, span_text(result, tested.mean_low, tested.mean_high)));
  }
  return {};
}

}  // namespace wearwell::fatigue
