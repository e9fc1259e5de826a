// Twenty simulated clutch campaigns with the example's truth: is what the study says of itself true?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/clutch/clutch_predict.h"
#include "wearwell/models/clutch/clutch_study.h"

namespace wearwell::clutch {
namespace {

constexpr int campaigns = 20;

struct Outcome {
  ClutchStudy study;
  ClutchResult result;
};

/// The example with other seeds, every second exponent, 30 replicates.
const std::vector<Outcome>& runs() {
  static const std::vector<Outcome> all = [] {
    std::vector<Outcome> list;
    const ClutchStudy example = read_clutch_study(PROJECT_SOURCE_DIR "/examples/clutch/study.toml");
    for (int i = 1; i <= campaigns; ++i) {
      const auto seed = static_cast<std::uint64_t>(1000 + i);
      ClutchStudy study = example;
      Simulation simulation = simulate(example.campaign.design, *example.truth, seed);
      study.campaign = std::move(simulation.campaign);
      study.realized = std::move(simulation.realized);
      study.plate_factors = std::move(simulation.plate_factors);
      study.seed = seed;
      study.replicates = 30;
      study.exponents.clear();
      for (int e = 1; e <= 15; ++e) study.exponents.push_back(0.2 * e);
      ClutchResult result = run_clutch_study(study);
      list.push_back({std::move(study), std::move(result)});
    }
    return list;
  }();
  return all;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
}

// Of both sequences at the end of life: the volume that was really lost.
void check_intervals() {
  std::vector<double> errors, widths;
  for (std::size_t s = 0; s < 2; ++s) {
    int covered = 0, by_scatter = 0;
    for (const Outcome& run : runs()) {
      ASSERT_EQ(run.result.sequences.size(), 2u);
      const auto& last = run.result.sequences[s].weighings.back();
      ASSERT_TRUE(last.realized);
      const double error = last.predicted - *last.realized;
      covered += std::abs(error) <= 2 * last.full_sd;
      by_scatter += std::abs(error) <= 2 * last.sd;
      errors.push_back(std::abs(error) / *last.realized);
      widths.push_back(2 * last.full_sd / last.predicted);
    }
    EXPECT_GE(covered, 17) << "sequence " << s;
    std::printf("sequence %zu: %d of %d covered, %d by the scatter of cycles alone\n", s, covered,
                campaigns, by_scatter);
  }
  std::printf("median error %.2f %%, median half width %.1f %%\n", 100 * median(errors),
              100 * median(widths));
  EXPECT_LT(median(errors), 0.06);
  EXPECT_LT(median(widths), 0.2) << "an interval that covers because it is wide says nothing";
}

// The geometric mean of the plates' true factors belongs to w0; energies are compared by logarithm.
void check_run_in() {
  int beyond = 0;
  double squares = 0;
  for (const Outcome& run : runs()) {
    const Truth& t = *run.study.truth;
    double mean_log = 0;
    for (int p = 0; p < t.plates; ++p)
      mean_log += std::log(run.study.plate_factors[static_cast<std::size_t>(p)]) / t.plates;
    const double w0 = t.w(t.run_in_point) * std::exp(mean_log);
    const double truth[] = {w0, t.run_in.slow * w0, t.run_in.fast * w0, t.run_in.slow_energy,
                            t.run_in.fast_energy};
    const RunInFit& fit = run.result.run_in;
    for (int i = 0; i < RunInFit::size; ++i) {
      const double sd = std::sqrt(fit.covariance(i, i)), value = fit.parameters[i];
      const double z = i < 3 ? (value - truth[i]) / sd : std::log(value / truth[i]) * value / sd;
      squares += z * z / (campaigns * RunInFit::size);
      if (std::abs(z) > 3) {
        ++beyond;
        std::printf("constant %d: %.2f standard errors\n", i, z);
      }
    }
  }
  std::printf("run-in: %d of 100 beyond 3 standard errors, mean square %.2f\n", beyond, squares);
  // Standard errors are by linearization; the slow mode is small beside its noise.
  EXPECT_LE(beyond, 3);
  EXPECT_LT(squares, 1.6);
}

void check_map() {
  std::vector<double> r2, r2p, ks;
  int failed = 0;
  for (const Outcome& run : runs()) {
    const auto& maps = run.result.maps;
    r2.push_back(maps[0].fit.r2);
    r2p.push_back(maps[0].fit.r2p);
    for (const Check& check : run.result.checks)
      failed += check.name == "wear map" && check.verdict == Verdict::fail;
    ks.push_back(run.result.scatter_fit().kolmogorov.p);
  }
  std::printf("median R2 %.3f, R2p %.3f; check failed in %d; KS p from %.3f to %.3f\n", median(r2),
              median(r2p), failed, *std::min_element(ks.begin(), ks.end()),
              *std::max_element(ks.begin(), ks.end()));
  EXPECT_NEAR(median(r2), 0.88, 0.03);
  EXPECT_EQ(failed, 0);
  EXPECT_LE(std::count_if(ks.begin(), ks.end(), [](double p) { return p < 0.05; }), 4);
  EXPECT_GT(median(ks), 0.2);
}

// A held-out point whose plate lost five standard deviations more while it ran: all later weighings
// of the plate are lower by that. Beside the point's own noise 3.1 of 5 are needed: 97 % are named.
void check_planted_outlier() {
  int named = 0, clean = 0;
  for (std::size_t i = 0; i < runs().size(); ++i) {
    const ClutchResult& r = runs()[i].result;
    const ValidationPoint& victim = r.validation.points[i % r.validation.points.size()];
    Campaign campaign = runs()[i].study.campaign;
    const auto hit = std::find_if(r.blocks.blocks.begin(), r.blocks.blocks.end(),
                                  [&](const WornBlock& b) { return b.point == victim.number; });
    ASSERT_NE(hit, r.blocks.blocks.end());
    const long long cycle = campaign.cycles[hit->last - 1].number;
    double factor = r.run_in.run_in.mean(hit->energy_before, hit->energy_before + hit->energy);
    for (const PlateFactor& plate : r.run_in.plates) {
      if (plate.plate == hit->plate) factor *= plate.factor();
    }
    for (Weighing& weighing : campaign.weighings) {
      if (weighing.plate == hit->plate && weighing.cycle >= cycle)
        weighing.mass -= 5 * victim.sd * factor * hit->energy * campaign.density;
    }
    const WearPoints held_out = wear_points(campaign, worn_blocks(campaign).blocks, r.run_in, true);
    const Validation spoilt = validate(r.maps[0], r.model.covariance, r.model.scatter, held_out);
    for (const ValidationPoint& p : spoilt.points) {
      if (p.number != victim.number) continue;
      EXPECT_NEAR(p.t, victim.t + 5, 0.1);
      named += p.outlier;
    }
    clean += std::none_of(r.validation.points.begin(), r.validation.points.end(),
                          [](const ValidationPoint& p) { return p.outlier; });
  }
  std::printf("outliers: %d of %d named; no false alarm in %d\n", named, campaigns, clean);
  EXPECT_GE(named, 17);
  EXPECT_GE(clean, 16);
}

/// What the full interval is made of, at the end of a plate's life, relative to the volume: as
/// predicted, and as it was.
struct Parts {
  double scatter = 0, true_scatter = 0;  ///< standard deviation of the closings' sum
  double plate = 0;                      ///< of a new plate's factor, predicted
  double model = 0;            ///< root mean square of the replicates about the prediction
  double model_error = 0;      ///< prediction over what a plate of mean factor would wear, less 1
  double error = 0, full = 0;  ///< of the volume that was lost; standard deviation as predicted
};

/// The chain of a campaign up to its replicates, and what becomes of the two plates of the sequences.
std::vector<Parts> parts_of(const ClutchStudy& example, const Truth& truth,
                            const std::vector<double>& exponents, std::uint64_t seed) {
  constexpr int replicates = 30;
  const Simulation simulation = simulate(example.campaign.design, truth, seed);
  const std::vector<WornBlock> blocks = worn_blocks(simulation.campaign).blocks;
  const RunInFit run_in = fit_run_in(blocks);
  const WearPoints points = wear_points(simulation.campaign, blocks, run_in, false);
  const PairBest best = best_exponents(points, Surrogate::distance, exponents, {});
  const WearMap map =
      fit_map("selected", points, Surrogate::distance, best.r, best.q, 3, best.terms);
  WearModel model = make_model("", points, map, run_in, fit_scatter(points, map), truth.worn_out);
  model.replicates =
      draw_replicates(points, map, point_sd(model.scatter, points, map.fit.fitted), run_in,
                      repeat_run_in(blocks, run_in, replicates, seed), exponents, seed);
  double mean_log = 0;  // of the plates that the map is of
  for (int p = 0; p < truth.plates; ++p)
    mean_log += std::log(simulation.plate_factors[static_cast<std::size_t>(p)]) / truth.plates;
  std::vector<Parts> all;
  for (const int plate : {truth.plates + 1, truth.plates + 2}) {
    const auto& cycles = simulation.campaign.cycles;
    const auto of_plate = [&](const Cycle& cycle) { return cycle.plate == plate; };
    const auto first = std::find_if(cycles.begin(), cycles.end(), of_plate);
    const auto last = std::find_if_not(first, cycles.end(), of_plate);
    CycleSum sum(model, true);
    CycleSum::Rates rates;
    const CycleColumns columns =
        columns_of(cycles, static_cast<std::size_t>(first - cycles.begin()),
                   static_cast<std::size_t>(last - cycles.begin()));
    sum.rates(columns, rates);
    sum.add(columns, rates);
    const PlateWear& wear = sum.plates().front();
    double expected = 0, variance = 0, energy = 0;
    for (auto cycle = first; cycle != last; ++cycle) {
      const double w = truth.w(cycle->at);
      expected += truth.run_in.g(energy) * w * cycle->energy;
      variance += std::pow(truth.scatter.formula(w, cycle->at) * cycle->energy, 2);
      energy += cycle->energy;
    }
    double realized = 0;
    for (const Realized& each : simulation.realized) {
      if (each.plate == plate) realized = each.volume;
    }
    all.push_back({wear.sd() / wear.volume, std::sqrt(variance) / expected, model.plate_sd,
                   std::sqrt((wear.replicates / wear.volume - 1).square().mean()),
                   wear.volume / (expected * std::exp(mean_log)) - 1,
                   (wear.volume - realized) / wear.volume,
                   wear.full_sd(model.plate_sd) / wear.volume});
  }
  return all;
}

// The interval as a whole, and each of its parts, against a truth that is known.
void check_parts(double plate_sd, double least_coverage) {
  constexpr int count = 80;
  const ClutchStudy example = read_clutch_study(PROJECT_SOURCE_DIR "/examples/clutch/study.toml");
  Truth truth = *example.truth;
  truth.plate_sd = plate_sd;
  std::vector<double> exponents;
  for (int e = 1; e <= 10; ++e) exponents.push_back(0.3 * e);
  double z2 = 0;
  int covered = 0;
  std::vector<Parts> all;
  for (int i = 1; i <= count; ++i) {
    for (const Parts& p : parts_of(example, truth, exponents, static_cast<std::uint64_t>(3000 + i)))
      all.push_back(p);
  }
  const auto n = static_cast<double>(all.size());
  const auto root_mean_square = [&](double Parts::*part) {
    double sum = 0;
    for (const Parts& p : all) sum += p.*part * p.*part / n;
    return std::sqrt(sum);
  };
  for (const Parts& p : all) {
    z2 += p.error * p.error / (p.full * p.full) / n;
    covered += std::abs(p.error) <= 2 * p.full;
  }
  const double coverage = covered / n;
  const double scatter = root_mean_square(&Parts::scatter),
               true_scatter = root_mean_square(&Parts::true_scatter),
               model = root_mean_square(&Parts::model),
               model_error = root_mean_square(&Parts::model_error);
  std::printf(
      "plates %.3f: %d of %.0f covered, rms z %.3f; scatter %.4f (true %.4f), plates %.4f (true "
      "%.4f), map and run-in %.4f (true %.4f); error %.4f, predicted %.4f\n",
      plate_sd, covered, n, std::sqrt(z2), scatter, true_scatter, root_mean_square(&Parts::plate),
      plate_sd * std::sqrt(1 + 1.0 / truth.plates), model, model_error,
      root_mean_square(&Parts::error), root_mean_square(&Parts::full));
  // Two plates of a campaign share its map: about 100 independent ones, binomial errors of 2 %.
  EXPECT_GT(coverage, least_coverage);
  EXPECT_NEAR(std::sqrt(z2), 1, 0.15);
  EXPECT_NEAR(scatter / true_scatter, 1, 0.1);
  EXPECT_NEAR(model / model_error, 1, 0.25);
}

TEST(ClutchCalibration, PartsOfTheInterval) {
  check_parts(0.04, 0.9);
}

TEST(ClutchCalibration, PartsOfTheIntervalWherePlatesDifferMore) {
  check_parts(0.08, 0.9);
}

// One test, so that the campaigns are run once.
TEST(ClutchCalibration, TwentyCampaigns) {
  check_intervals();
  check_run_in();
  check_map();
  check_planted_outlier();
}

}  // namespace
}  // namespace wearwell::clutch
