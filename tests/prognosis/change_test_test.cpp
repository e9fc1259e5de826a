// The sequential test of one unit: its evidence by brute force, its false alarms, and what it finds.
#include "wearwell/prognosis/change_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::prognosis {
namespace {

PredictiveTails tails_at(double z) {
  return {std::erfc(-z / std::sqrt(2.0)) / 2, std::erfc(z / std::sqrt(2.0)) / 2};
}

double weight_from(int k) {
  return 1 / (1 + std::log(k));
}

// Sums over all places of the change, without recursion.
TEST(ChangeTest, EvidenceByBruteForce) {
  const std::vector<double> z = {0.3, -1.2, 2.1, 1.7, -0.4, 3.0, 2.2};
  const std::vector<double> repeat = {1, 0.1, 0.1, 2, 1, 0.9, 30};
  ChangeTest test;
  for (std::size_t n = 1; n <= z.size(); ++n) {
    const PredictiveTails tails = tails_at(z[n - 1]);
    test.add({&tails, 1}, repeat[n - 1]);
    double sum = 0;
    for (std::size_t k = 1; k <= n; ++k) {
      const double weight = weight_from(static_cast<int>(k)) - weight_from(static_cast<int>(k) + 1);
      for (const double d : {0.5, 1.0, 2.0, 4.0, -0.5, -1.0, -2.0, -4.0}) {
        double product = weight;
        for (std::size_t i = k; i <= n; ++i) product *= std::exp(d * z[i - 1] - d * d / 2);
        sum += product / 10;
      }
      double scatter = weight, equal = weight;
      for (std::size_t i = k; i <= n; ++i) {
        scatter *= std::cosh(2 * z[i - 1]) * std::exp(-2.0);
        equal *= repeat[i - 1];
      }
      sum += (scatter + equal) / 10;
    }
    EXPECT_NEAR(test.evidence(), sum, 1e-9 * sum) << n;
  }
}

// The mean of a bet over all values of a right unit is 1 at most: by sums over a Poisson distribution, and for a part
// that survives or fails.
TEST(ChangeTest, BetsAreFair) {
  const double start = (weight_from(1) - weight_from(2));
  for (const double mean : {0.02, 0.7, 12.0}) {
    double sum = 0, below = 0, pmf = std::exp(-mean);
    for (int y = 0; y < 200; pmf *= mean / ++y) {
      double above = 0, rest = pmf;
      for (int x = y; x < y + 200; rest *= mean / ++x) above += rest;
      below += pmf;
      const PredictiveTails tails{std::min(below, 1.0), above};
      ChangeTest test;
      test.add({&tails, 1});
      sum += pmf * test.evidence();
    }
    // Less where a far value counts as its nearer end, and by the bound on the evidence.
    EXPECT_LE(sum / start, 1 + 1e-9) << mean;
    EXPECT_GT(sum / start, 0.9) << mean;
  }
  for (const double survives : {0.999, 0.5, 1e-3}) {
    const PredictiveTails tails{1, survives};
    ChangeTest test;
    test.add({&tails, 1});
    EXPECT_LE(survives * test.evidence() / start, 1);
  }
}

int doubted(int units, int readings, const std::function<PredictiveTails(Rng&)>& reading) {
  int count = 0;
  for (int u = 0; u < units; ++u) {
    Rng rng(41, static_cast<std::uint64_t>(u));
    ChangeTest test;
    bool any = false;
    for (int i = 0; i < readings; ++i) {
      const PredictiveTails tails = reading(rng);
      test.add({&tails, 1},
               rng.uniform() < 0.3 ? evidence_of_repeat(0.3) : evidence_of_difference());
      any |= test.in_doubt();
    }
    count += any;
  }
  return count;
}

TEST(ChangeTest, DoubtsOneRightUnitInAThousandAtMost) {
  const int units = 10'000;
  const auto continuous = [](Rng& rng) {
    const double u = rng.uniform();
    return PredictiveTails{u, 1 - u};
  };
  // 10, and three standard errors.
  EXPECT_LE(doubted(units, 60, continuous), 20);
  const auto rare = [](Rng& rng) {  // 1 with a probability of 0.03, else 0
    return rng.uniform() < 0.03 ? PredictiveTails{1, 0.03} : PredictiveTails{0.97, 1};
  };
  EXPECT_LE(doubted(units, 60, rare), 20);
}

TEST(ChangeTest, FindsChanges) {
  Rng rng(7, 1);
  const auto delay = [&](int before, const std::function<double()>& z) {
    int sum = 0;
    for (int u = 0; u < 100; ++u) {
      ChangeTest test;
      const auto add = [&](double score) {
        const PredictiveTails tails = tails_at(score);
        test.add({&tails, 1});
      };
      for (int i = 0; i < before; ++i) add(rng.normal());
      for (int i = 0; i < 500 && !test.in_doubt(); ++i, ++sum) add(z());
    }
    return sum / 100.0;
  };
  // The logarithm of 10^4 over the weight, by d^2/2 a reading.
  EXPECT_LT(delay(20, [&] { return 2 + rng.normal(); }), 10);
  EXPECT_LT(delay(20, [&] { return -1 + rng.normal(); }), 35);
  EXPECT_LT(delay(2000, [&] { return 2 + rng.normal(); }), 15);
  EXPECT_LT(delay(20, [&] { return 3 * rng.normal(); }), 15);
  EXPECT_EQ(delay(20, [] { return 9.0; }), 1);
}

TEST(ChangeTest, DoubtEnds) {
  Rng rng(7, 2);
  ChangeTest test;
  const auto add = [&](double score) {
    const PredictiveTails tails = tails_at(score);
    test.add({&tails, 1});
  };
  for (int i = 0; i < 300; ++i) add(5 + rng.normal());
  EXPECT_TRUE(test.in_doubt());
  int more = 0;
  for (; more < 100 && test.in_doubt(); ++more) add(rng.normal());
  EXPECT_GT(more, 2);
  EXPECT_LT(more, 80);
}

TEST(ChangeTest, IsSavedAndRestored) {
  Rng rng(7, 3);
  ChangeTest test, again;
  const auto bytes = [](const ChangeTest& of) {
    ByteWriter to;
    of.save(to);
    return to.take();
  };
  for (int i = 0; i < 30; ++i) {
    const PredictiveTails tails = tails_at(rng.normal() + (i > 20 ? 3 : 0));
    test.add({&tails, 1});
    again.add({&tails, 1});
    const std::string saved = bytes(again);
    ByteReader from(saved, "state");
    again = {};
    again.load(from);
    from.end();
    EXPECT_EQ(bytes(again), bytes(test));
  }
  EXPECT_TRUE(again.in_doubt());
  std::string damaged = bytes(test);
  for (int i = 8; i < 16; ++i) damaged[static_cast<std::size_t>(i)] = '\xff';
  ByteReader from(damaged, "state");
  EXPECT_THROW(again.load(from), InputError);
}

}  // namespace
}  // namespace wearwell::prognosis
