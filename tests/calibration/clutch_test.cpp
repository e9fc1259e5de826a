// Twenty simulated clutch campaigns with the example's truth: is what the study says of itself true?
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

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
  std::printf(
      "median R2 %.3f, R2p %.3f; check failed in %d; KS p from %.3f to %.3f\n",
      median(r2), median(r2p), failed, *std::min_element(ks.begin(), ks.end()),
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

// One test, so that the campaigns are run once.
TEST(ClutchCalibration, TwentyCampaigns) {
  check_intervals();
  check_run_in();
  check_map();
  check_planted_outlier();
}

}  // namespace
}  // namespace wearwell::clutch
