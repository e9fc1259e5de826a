// Few responses in place of many, against the sum over all.
#include "wearwell/prob/gathered_responses.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"

namespace wearwell {
namespace {

// Lives about 1000, of every kind, some seen from an entry on, some several times.
struct EveryKind {
  std::vector<Response> responses;
  std::vector<double> counts;
};

EveryKind lives_of_every_kind(int count) {
  Rng rng(20261125, 2);
  EveryKind all;
  for (int i = 0; i < count; ++i) {
    const double life = 1000 * std::pow(-std::log(rng.uniform()), 0.5);
    const double lot = rng.uniform();
    Response y{.seen = Censoring::none, .at = life};
    if (lot < 0.3) y = {.seen = Censoring::right, .at = life * rng.uniform()};
    if (lot > 0.9) y = {.seen = Censoring::left, .at = life * (1 + rng.uniform())};
    if (lot > 0.95) {
      const double looked = 200 * std::floor(life / 200);
      y = {.seen = looked > 0 ? Censoring::interval : Censoring::left,
           .at = looked,
           .until = looked + 200};
      if (looked == 0) y.at = 200;
    }
    if (y.seen == Censoring::none && i % 4 == 0) y.entry = 0.5 * y.at;
    all.responses.push_back(y);
    all.counts.push_back(1 + i % 2);
  }
  return all;
}

TEST(GatheredResponses, HaveTheSumOfAllUnderEveryFamily) {
  const EveryKind all = lives_of_every_kind(40'000);
  int tried = 0;
  for (const ResponseForm& form : response_forms()) {
    if (!can_be_gathered(form)) continue;
    const auto few = gathered_responses(all.responses, all.counts, form.positive);
    EXPECT_LT(few.size(), 3000u) << form.name;
    // Each slot as its kind may be for such lives, and at half and twice that.
    for (const double factor : {0.5, 1.0, 2.0}) {
      double family_parameters[most_response_parameters] = {};
      for (std::size_t s = 0; s < form.family_parameters.size(); ++s) {
        const ParameterKind kind = form.family_parameters[s].kind;
        family_parameters[s] =
            factor * (kind == ParameterKind::location ? 800
                      : kind == ParameterKind::scale  ? (form.positive ? 900 : 400)
                                                      : 1.5);
      }
      double sum = 0, size = 0, gathered = 0;
      for (std::size_t i = 0; i < all.responses.size(); ++i) {
        const double each = log_response_value(form.family, all.responses[i], family_parameters);
        sum += all.counts[i] * each;
        size += all.counts[i] * std::abs(each);
      }
      if (!std::isfinite(sum)) continue;
      for (const WeightedResponse& each : few)
        gathered += each.weight * log_response_value(form.family, each.response, family_parameters);
      EXPECT_NEAR(gathered, sum, 1e-10 * size) << form.name << " " << factor;
      ++tried;
    }
  }
  EXPECT_GE(tried, 20);
}

TEST(GatheredResponses, OfEqualLivesAreOne) {
  const std::vector<Response> all(5000, {.seen = Censoring::right, .at = 1000});
  const auto few = gathered_responses(all, std::vector<double>(5000, 1.0), true);
  ASSERT_EQ(few.size(), 1u);
  EXPECT_NEAR(few[0].response.at, 1000, 1e-10);
  EXPECT_EQ(few[0].weight, 5000);
}

TEST(GatheredResponses, KeepWhatHasNoPlace) {
  std::vector<Response> all(100, {.seen = Censoring::none, .at = 1000});
  all[50] = {.seen = Censoring::right, .at = 0};
  const auto few = gathered_responses(all, std::vector<double>(100, 1.0), true);
  ASSERT_EQ(few.size(), 2u);
  EXPECT_EQ(few[0].response.at, 0);
  EXPECT_EQ(few[0].weight, 1);
  EXPECT_EQ(few[1].weight, 99);
}

TEST(GatheredResponses, AreNotOfCountsNorOfThresholds) {
  for (const ResponseForm& form : response_forms()) {
    const bool has_threshold =
        std::any_of(form.family_parameters.begin(), form.family_parameters.end(),
                    [](const auto& s) { return s.name == "threshold"; });
    EXPECT_EQ(can_be_gathered(form), !form.counted && !has_threshold) << form.name;
  }
}

}  // namespace
}  // namespace wearwell
