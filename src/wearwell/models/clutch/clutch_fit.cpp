#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_predict.h"
#include "wearwell/models/clutch/clutch_study.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/map_fit.h"
#include "wearwell/models/clutch/nested_map.h"
#include "wearwell/study/units_check.h"

// Longer than others: the chain of one campaign with the check of each step.
namespace wearwell::clutch {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Points within this of a temperature level belong to it, degrees.
constexpr double level_width = 10;
constexpr Index least_points_of_level = 15;
constexpr int nested_folds = 10;

/// The set temperatures of the factorial.
std::vector<double> temperature_levels(const Campaign& campaign) {
  std::set<double> levels;
  for (const DesignPoint& point : campaign.design) {
    if (point.role == Role::model) levels.insert(point.at.temperature);
  }
  return {levels.begin(), levels.end()};
}

SurrogateResult try_surrogate(const ClutchStudy& study, const WearPoints& points,
                              Surrogate surrogate, const ExponentSearch* done, int threads,
                              Progress* progress) {
  SurrogateResult result;
  result.surrogate = surrogate;
  result.best =
      done ? done->pairs[done->best]
           : best_exponents(points, surrogate, study.exponents, {}, threads, false, progress);
  for (const double level : temperature_levels(study.campaign)) {
    std::vector<Index> rows;
    for (Index j = 0; j < points.size(); ++j) {
      if (std::abs(points.at[static_cast<std::size_t>(j)].temperature - level) < level_width)
        rows.push_back(j);
    }
    if (std::ssize(rows) < least_points_of_level) continue;
    result.levels.push_back(level);
    result.r2p.push_back(best_exponents(chosen(points, rows), surrogate, study.exponents, {},
                                        threads, true, progress)
                             .r2p);
    result.mean_r2p += result.r2p.back();
  }
  if (!result.r2p.empty()) result.mean_r2p /= static_cast<double>(result.r2p.size());
  return result;
}

std::vector<SequenceResult> predict_sequences(const ClutchStudy& study, const ClutchResult& r) {
  std::vector<SequenceResult> sequences;
  CycleSum sum(r.model, true);
  CycleSum::Rates rates;
  std::set<int> plates;
  for (const WornBlock& block : r.blocks.blocks) {
    if (block.block == Block::sequence) plates.insert(block.plate);
  }
  for (const WornBlock& block : r.blocks.blocks) {
    if (!plates.count(block.plate)) continue;
    // All cycles on the plate count, whatever their purpose.
    const CycleColumns cycles = columns_of(study.campaign.cycles, block.first, block.last);
    sum.rates(cycles, rates);
    sum.add(cycles, rates);
    if (sequences.empty() || sequences.back().plate != block.plate)
      sequences.push_back({block.sequence, block.plate, {}});
    SequenceResult& sequence = sequences.back();
    if (block.block == Block::sequence) sequence.name = block.sequence;
    const PlateWear& wear = sum.plates().back();
    const double measured =
        (sequence.weighings.empty() ? 0 : sequence.weighings.back().measured) + block.volume;
    SequenceResult::Weighing weighing{wear.last_number,
                                      wear.energy,
                                      measured,
                                      wear.volume,
                                      wear.sd(),
                                      wear.full_sd(r.model.plate_sd),
                                      {}};
    for (const Realized& each : study.realized) {
      if (each.plate == block.plate && each.cycle == wear.last_number)
        weighing.realized = each.volume;
    }
    sequence.weighings.push_back(weighing);
  }
  return sequences;
}

Check run_in_check(const RunInFit& fit) {
  Findings findings("run-in");
  if (!fit.converged || fit.agreeing < 2)
    findings.add(Verdict::fail,
                 fmt::format("{} of {} starts reach the best fit{}", fit.agreeing, fit.starts,
                             fit.converged ? "" : ", which did not converge"),
                 "Weigh more often during run-in, or run it longer.");
  for (int i = 0; i < 3; ++i) {
    const double value = fit.parameters[i], error = std::sqrt(fit.covariance(i, i));
    if (value > 2 * error) continue;
    if (i == 0)
      findings.add(Verdict::fail,
                   fmt::format("the settled rate w0 is {:.3g} +- {:.3g} mm^3/MJ",
                               value / mm3_per_MJ, error / mm3_per_MJ),
                   "The wear of the plates has not settled: run them longer before the run-out.");
    else
      findings.add(Verdict::warn,
                   fmt::format("w{} is {:.3g} +- {:.3g} mm^3/MJ, not significantly above 0", i,
                               value / mm3_per_MJ, error / mm3_per_MJ),
                   "One exponential may be enough, or run-in was weighed too rarely.");
  }
  return findings.result(
      fmt::format("{} of {} starts agree; both modes are more than two "
                  "standard errors above 0",
                  fit.agreeing, fit.starts));
}

// R2p of the search's best model is biased upward by selection; points outside the search give an
// unbiased value: left out in turn, or held out by the design.
Check map_check(const std::vector<WearMap>& maps, const Nested& nested,
                const WearPoints& held_out) {
  Findings findings("wear map");
  if (!(nested.r2 > 0.5))
    findings.add(Verdict::fail, fmt::format("R2 of points outside the search is {:.3f}", nested.r2),
                 nested.r2 > 2 * nested.r2_error
                     ? "The inputs explain less than half of the wear rates: look for a missing "
                       "input, or run longer points."
                     : "These points show no dependence of the wear rate on the inputs: the "
                       "variation of the map is noise.");
  const std::string searched =
      fmt::format("R2 of points left out of the whole search {:.3f} (R2p of its best model {:.3f})",
                  nested.r2, maps[0].fit.r2p);
  constexpr Index least_points = 5;
  if (held_out.size() < least_points) return findings.result(searched);
  const double spread = (held_out.w.array() - held_out.w.mean()).square().sum();
  std::vector<Eigen::ArrayXd> errors;
  std::vector<std::string> texts;
  for (const WearMap& map : maps) {
    errors.push_back((map.predict(held_out.at) - held_out.w).array().square());
    texts.push_back(fmt::format("{} {:.3f}", map.name, 1 - errors.back().sum() / spread));
  }
  const auto n = static_cast<double>(held_out.size());
  for (std::size_t i = 1; i < maps.size(); ++i) {
    const Eigen::ArrayXd gain = errors[i] - errors[0];  // from the search, point by point
    const double error = std::sqrt((gain - gain.mean()).square().sum() / (n * (n - 1)));
    const double z = gain.mean() / error;
    if (z < -1)
      findings.add(
          z < -3 ? Verdict::fail : Verdict::warn,
          fmt::format("the {} model predicts the held-out points better ({:.1f} standard errors)",
                      maps[i].name, -z),
          "The search has fitted noise: use the simpler model, or run longer points.");
  }
  return findings.result(fmt::format("{}; R2 of the {} held-out points: {}", searched,
                                     held_out.size(), fmt::join(texts, ", ")));
}

Check validation_check(const Validation& validation) {
  Findings findings("validation");
  if (validation.points.empty()) {
    findings.add(Verdict::warn, "no point is held out",
                 "Plan points of role 'validation' (wearwell clutch design).");
    return findings.result("");
  }
  for (const ValidationPoint& p : validation.points) {
    if (p.outlier)
      findings.add(Verdict::warn,
                   fmt::format("point {} lies {:+.1f} standard deviations from its prediction",
                               p.number, p.t),
                   "Check the traces and weighings of these points; results are shown with and "
                   "without them.");
  }
  if (!(validation.without_outliers.r2 > 0))
    findings.add(Verdict::fail,
                 fmt::format("R2 of the held-out points is {:.2f}", validation.without_outliers.r2),
                 "The map predicts held-out points no better than their mean does.");
  return findings.result(
      fmt::format("no outlier among {} held-out points (|t| up to {:.1f} is expected); R2 {:.3f}",
                  validation.all.points, validation.critical, validation.all.r2));
}

Check sequence_check(const std::vector<SequenceResult>& sequences) {
  Findings findings("sequences");
  std::vector<std::string> good;
  for (const SequenceResult& s : sequences) {
    const auto& last = s.weighings.back();
    const double z = (last.measured - last.predicted) / last.full_sd;
    const std::string text =
        fmt::format("{}: predicted wear is {} at the end", s.name, error_text(s.final_error()));
    good.push_back(text);
    if (std::abs(z) > 2)
      findings.add(std::abs(z) > 4 ? Verdict::fail : Verdict::warn,
                   fmt::format("{}, {:.1f} full standard deviations", text, z),
                   "The plate, or its conditions, differ from those of the campaign.");
  }
  return findings.result(sequences.empty() ? "the campaign has no sequence"
                                           : fmt::format("{}", fmt::join(good, "; ")));
}

Check data_check(const Campaign& campaign, const ClutchResult& r) {
  Findings findings("data");
  std::set<int> run;
  for (const WornBlock& block : r.blocks.blocks) run.insert(block.point);
  std::vector<int> missing;
  for (const DesignPoint& point : campaign.design) {
    if (!run.count(point.number)) missing.push_back(point.number);
  }
  if (!missing.empty())
    findings.add(
        Verdict::warn,
        fmt::format("points {} of the design have no cycles", fmt::join(missing, ", ")),
        "The map is less certain there; run these points, or remove them from the design.");
  for (const std::string& each : off_design(campaign, r.blocks.blocks))
    findings.add(Verdict::warn, each, "Check units and point numbers of the tables.");
  for (const std::string& each : campaign.filled)
    findings.add(Verdict::warn, each,
                 "docs/reference/clutch.md explains the effect on the result.");
  for (const std::string& flag : r.blocks.flags)
    findings.add(Verdict::warn, flag, "Check the rows named; weigh longer blocks.");
  for (const Closing& closing : r.closings) {
    if (!closing.flag.empty())
      findings.add(
          Verdict::warn,
          fmt::format("trace of plate {}, closing {}: {}", campaign.plate_name(closing.cycle.plate),
                      closing.cycle.number, closing.flag),
          "Check the trace.");
  }
  return findings.result(
      fmt::format("{} blocks weighed; none gained mass", r.blocks.blocks.size()));
}

}  // namespace

WearPoints wear_points(const Campaign& campaign, const std::vector<WornBlock>& blocks,
                       const RunInFit& run_in, bool held_out) {
  std::map<int, Role> roles;
  for (const DesignPoint& point : campaign.design) roles[point.number] = point.role;
  WearPoints points;
  std::vector<double> w, cycles, balance_sd, factors;
  for (const WornBlock& block : blocks) {
    if (block.block != Block::point) continue;
    const auto role = roles.find(block.point);
    if (role == roles.end())
      throw InputError(fmt::format("plate {}: point {} has cycles but is not in the design",
                                   campaign.plate_name(block.plate), block.point));
    if ((role->second == Role::validation) != held_out) continue;
    double factor = run_in.run_in.mean(block.energy_before, block.energy_before + block.energy);
    for (const PlateFactor& plate : run_in.plates) {
      if (plate.plate == block.plate) factor *= plate.factor();
    }
    points.number.push_back(block.point);
    points.at.push_back(block.mean);
    w.push_back(block.w / factor);
    cycles.push_back(block.cycles());
    balance_sd.push_back(block.balance_sd / factor);
    factors.push_back(factor);
    points.plate.push_back(block.plate);
    points.from.push_back(block.energy_before);
    points.to.push_back(block.energy_before + block.energy);
  }
  const auto vector = [](const std::vector<double>& values) {
    return VectorXd(Eigen::Map<const VectorXd>(values.data(), std::ssize(values)));
  };
  points.w = vector(w);
  points.cycles = vector(cycles);
  points.balance_sd = vector(balance_sd);
  points.factor = vector(factors);
  return points;
}

ClutchResult prepare_campaign(const ClutchStudy& study) {
  ClutchResult r;
  r.plate_names = study.campaign.plate_names;
  r.version = WEARWELL_VERSION;
  r.closings = find_closings(study.traces);
  r.blocks = worn_blocks(study.campaign);
  r.run_in = fit_run_in(r.blocks.blocks);
  r.points = wear_points(study.campaign, r.blocks.blocks, r.run_in, false);
  r.held_out = wear_points(study.campaign, r.blocks.blocks, r.run_in, true);
  constexpr Index least_points = 25;  // more than the number of terms of the full cubic
  if (r.points.size() < least_points)
    throw InputError(
        fmt::format("{} points to fit; at least {} are needed", r.points.size(), least_points));
  return r;
}

ClutchResult run_clutch_study(const ClutchStudy& study, int threads, Progress* progress) {
  const auto start = std::chrono::steady_clock::now();
  ClutchResult r = prepare_campaign(study);
  r.correlations = correlations(r.points);
  r.search =
      search_exponents(r.points, Surrogate::distance, study.exponents, threads, false, progress);
  for (const Surrogate surrogate : surrogates) {
    r.surrogates.push_back(try_surrogate(study, r.points, surrogate,
                                         surrogate == Surrogate::distance ? &r.search : nullptr,
                                         threads, progress));
  }
  const PairBest& best = r.search.pairs[r.search.best];
  const auto fitted = [&](const char* name, int degree, const std::vector<int>& terms) {
    return fit_map(name, r.points, Surrogate::distance, best.r, best.q, degree, terms);
  };
  r.maps = {fitted("selected", 3, best.terms), fitted("linear", 1, {}), fitted("full cubic", 3, {}),
            fit_temperature_map(r.points)};
  const WearMap& map = r.maps.front();
  r.nested = nested_map(r.points, Surrogate::distance, study.exponents, best.terms, nested_folds,
                        study.seed, threads, progress);
  r.scatter = fit_scatter(r.points, map);
  r.model = make_model(study.title, r.points, map, r.run_in, r.scatter, study.worn_out);
  r.model.replicates =
      draw_replicates(r.points, map, point_sd(r.model.scatter, r.points, map.fit.fitted), r.run_in,
                      repeat_run_in(r.blocks.blocks, r.run_in, study.replicates, study.seed),
                      study.exponents, study.seed, threads, progress);
  r.validation = validate(map, r.model.covariance, r.model.scatter, r.held_out);
  r.averaging = averaging_effect(r.model.polynomial(), study.campaign.cycles, r.blocks.blocks);
  r.sequences = predict_sequences(study, r);
  for (const auto& [name, at] : study.life_points) {
    const Cycle cycle{1, 1, at, closing_energy(at)};
    r.lives.push_back({name, at, predict_life(r.model, {cycle}, study.levels)});
  }
  r.checks = {data_check(study.campaign, r),
              run_in_check(r.run_in),
              map_check(r.maps, r.nested, r.held_out),
              fit_check(judge_map(r.points, map, r.scatter_fit().law)),
              validation_check(r.validation),
              sequence_check(r.sequences)};
  if (!r.lives.empty()) {
    r.checks.push_back(extrapolation_check(r.model, r.lives));
    r.checks.push_back(sense_check(r.lives));
  }
  if (const auto units = units_check(cycle_columns(study.campaign))) r.checks.push_back(*units);
  for (const Check& check : r.checks) r.trusted = r.trusted && check.verdict != Verdict::fail;
  r.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return r;
}

}  // namespace wearwell::clutch
