#include "wearwell/prognosis/change_test.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "wearwell/bayes/normal_score.h"

namespace wearwell::prognosis {
namespace {

constexpr std::array shifts = {0.5, 1.0, 2.0, 4.0, -0.5, -1.0, -2.0, -4.0};
constexpr double scatter_shift = 2;       // of z, in both directions: readings that scatter more
constexpr double farthest = 8;            // a larger |z| counts as this one
constexpr double most_evidence = 1200;    // of one alternative: so doubt can end again
constexpr double repeats = 0.9;           // the probability that a stuck sensor repeats itself
constexpr double least_repeat = 1e-3;     // a smaller probability of a repeat counts as this one
constexpr double own_probability = 1e-6;  // of a value: a smaller one counts as continuous

// The weight of changes from reading k on: from 1 down to 0 as slowly as possible, so that a change
// after many readings is found as well.
double weight_from(std::uint64_t k) {
  return 1 / (1 + std::log(static_cast<double>(k)));
}

double score(double below, double above) {
  if (!(below > 0)) return -farthest;
  if (!(above > 0)) return farthest;
  return std::clamp(normal_score(std::log(below), std::log(above)), -farthest, farthest);
}

/// The normal scores between which a value lies: equal for a continuous one.
struct ScoreRange {
  double low, high;
};

std::optional<ScoreRange> scores_of(const PredictiveTails& tails) {
  const double sum = tails.below + tails.above;
  if (!(sum > 0.5) || !std::isfinite(sum)) return {};
  if (sum - 1 > own_probability)
    return ScoreRange{score(1 - tails.above, tails.above), score(tails.below, 1 - tails.below)};
  const double z = score(tails.below / sum, tails.above / sum);
  return ScoreRange{z, z};
}

// The mean of the likelihood ratio of a shift over the scores of the value.
double evidence_of_shift(const ScoreRange& z, double shift) {
  if (z.low == z.high) return std::exp(shift * (z.low - shift / 2));
  // From the side where both probabilities are small.
  const double side = z.low + z.high > 0 ? -1 : 1;
  const auto between = [&](double low, double high) {
    return std::abs(normal_cdf(side * high) - normal_cdf(side * low));
  };
  const double own = between(z.low, z.high);
  return own > 0 ? between(z.low - shift, z.high - shift) / own : 1;
}

}  // namespace

void ChangeTest::add(std::span<const PredictiveTails> tails, double repeat) {
  std::array<double, alternatives> evidence = {};
  double values = 0;
  for (const PredictiveTails& each : tails) {
    const auto z = scores_of(each);
    if (!z) continue;
    ++values;
    for (std::size_t i = 0; i < shifts.size(); ++i) evidence[i] += evidence_of_shift(*z, shifts[i]);
    evidence[shifts.size()] +=
        0.5 * (evidence_of_shift(*z, scatter_shift) + evidence_of_shift(*z, -scatter_shift));
  }
  for (double& each : evidence) each = values > 0 ? each / values : 1;
  evidence.back() = repeat;
  ++readings_;
  const double begun = weight_from(readings_) - weight_from(readings_ + 1);
  for (std::size_t i = 0; i < alternatives; ++i)
    sums_[i] = std::min(evidence[i] * (sums_[i] + begun), most_evidence * alternatives);
  const double now = this->evidence();
  if (now + weight_from(readings_ + 1) >= begins) in_doubt_ = true;
  if (now < ends) in_doubt_ = false;
}

double ChangeTest::evidence() const {
  double sum = 0;
  for (const double each : sums_) sum += each;
  return sum / alternatives;
}

void ChangeTest::save(ByteWriter& to) const {
  to.u64(readings_);
  for (const double each : sums_) to.number(each);
  to.byte(in_doubt_);
}

void ChangeTest::load(ByteReader& from) {
  readings_ = from.u64();
  for (double& each : sums_) {
    each = from.number();
    if (!(each >= 0 && std::isfinite(each))) from.fail("the evidence of a change is not a number");
  }
  in_doubt_ = from.flag();
}

double evidence_of_repeat(double probability) {
  return repeats / std::clamp(probability, least_repeat, 1.0);
}

double evidence_of_difference() {
  return 1 - repeats;
}

}  // namespace wearwell::prognosis
