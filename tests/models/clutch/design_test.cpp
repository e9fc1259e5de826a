#include "wearwell/models/clutch/design.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "models/clutch/sample_campaign.h"
#include "support/scratch.h"
#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"

namespace wearwell::clutch {
namespace {

using testing::HasSubstr;

double least_distance(const DesignRequest& request, const std::vector<DesignPoint>& points,
                      Role role) {
  double least = INFINITY;
  for (const DesignPoint& a : points) {
    for (const DesignPoint& b : points) {
      if (a.role == role && a.number != b.number)
        least = std::min(least, design_distance(request, a.at, b.at));
    }
  }
  return least;
}

// Haramina et al. (2025), section 2.2: 81 + 20 + 20.
TEST(Design, IsThePapersPlan) {
  const DesignRequest request = paper_design();
  const auto design = plan(request);
  ASSERT_EQ(design.size(), 121u);
  int count[3] = {};
  for (std::size_t i = 0; i < design.size(); ++i) {
    const DesignPoint& p = design[i];
    EXPECT_EQ(p.number, static_cast<int>(i) + 1);
    ++count[static_cast<int>(p.role)];
    bool beyond = false;
    for (std::size_t c = 0; c < inputs.size(); ++c) {
      const double x = p.at.*inputs[c].value;
      const auto& levels = request.levels[c];
      EXPECT_GE(x, request.lowest[c] - 1e-9);
      EXPECT_LE(x, request.highest[c] + 1e-9);
      beyond = beyond || x < levels.front() || x > levels.back();
      if (p.role == Role::model) {
        EXPECT_EQ(std::count(levels.begin(), levels.end(), x), 1);
      }
    }
    EXPECT_EQ(beyond, p.role == Role::extrapolation) << p.number;
    EXPECT_LE(closing_energy(p.at), request.most_energy);
  }
  EXPECT_EQ(count[0], 81);
  EXPECT_EQ(count[1], 20);
  EXPECT_EQ(count[2], 20);
  EXPECT_GT(least_distance(request, design, Role::model), 0) << "a point is there twice";
}

TEST(Design, IsTheSameForOneSeed) {
  DesignRequest request = paper_design();
  request.inside = request.outside = 4;
  const auto once = plan(request), again = plan(request);
  request.seed = 2;
  const auto other = plan(request);
  for (std::size_t i = 0; i < once.size(); ++i)
    EXPECT_EQ(once[i].at.slip_speed, again[i].at.slip_speed);
  EXPECT_NE(once.back().at.slip_speed, other.back().at.slip_speed);
}

// Two levels 0 and 1 of each input, so distances are Euclidean. The best place for one point inside
// is the centre, at a distance of 1 from all 16 corners.
TEST(Design, OnePointInsideACubeIsItsCentre) {
  DesignRequest request{};
  for (std::size_t i = 0; i < 4; ++i) {
    request.levels[i] = {0, 1};
    request.lowest[i] = 0;
    request.highest[i] = 1;
    request.step[i] = 0.25;  // 625 places, and thousands of candidates: each is tried
  }
  request.inside = 1;
  request.outside = 0;
  const auto design = plan(request);
  ASSERT_EQ(design.size(), 17u);
  EXPECT_DOUBLE_EQ(least_distance(request, design, Role::validation), 1);
  for (const Input& input : inputs) EXPECT_DOUBLE_EQ(design.back().at.*input.value, 0.5);
}

// Brute force over all pairs of the places of a grid: no two points are farther from everything.
TEST(Design, TwoPointsInsideAreAsFarApartAsAnyTwo) {
  DesignRequest request{};
  for (std::size_t i = 0; i < 4; ++i) {
    request.levels[i] = {0, 1};
    request.lowest[i] = 0;
    request.highest[i] = 1;
    request.step[i] = 1.0 / 3;
  }
  request.inside = 2;
  request.outside = 0;
  const auto design = plan(request);
  std::vector<OperatingPoint> grid, corners;
  for (int code = 0; code < 256; ++code) {
    const OperatingPoint at{code % 4 / 3.0, code / 4 % 4 / 3.0, code / 16 % 4 / 3.0,
                            code / 64 / 3.0};
    grid.push_back(at);
  }
  for (int i = 0; i < 16; ++i) corners.push_back(design[static_cast<std::size_t>(i)].at);
  double best = 0;
  for (std::size_t a = 0; a < grid.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      double least = design_distance(request, grid[a], grid[b]);
      for (const OperatingPoint& corner : corners)
        least = std::min({least, design_distance(request, grid[a], corner),
                          design_distance(request, grid[b], corner)});
      best = std::max(best, least);
    }
  }
  EXPECT_NEAR(least_distance(request, design, Role::validation), best, 1e-9);
}

// Against the same number of points drawn at random: 200 plans, none as good.
TEST(Design, SpreadsBetterThanChance) {
  const DesignRequest request = paper_design();
  const auto design = plan(request);
  const double reached = least_distance(request, design, Role::validation);
  Rng rng(3, 0);
  for (int run = 0; run < 200; ++run) {
    auto random = design;
    for (DesignPoint& p : random) {
      if (p.role != Role::validation) continue;
      for (std::size_t c = 0; c < inputs.size(); ++c)
        p.at.*inputs[c].value = rng.uniform(request.levels[c].front(), request.levels[c].back());
    }
    EXPECT_LT(least_distance(request, random, Role::validation), reached);
  }
}

TEST(Design, RefusesWhatCannotBe) {
  const auto refused = [](auto change) {
    DesignRequest request = paper_design();
    change(request);
    return message_of<InputError>([&] { plan(request); });
  };
  EXPECT_THAT(refused([](auto& r) { r.levels[1] = {50}; }), HasSubstr("torque needs at least two"));
  EXPECT_THAT(refused([](auto& r) {
                r.levels[2] = {170, 120};
              }),
              HasSubstr("levels of temperature must ascend"));
  EXPECT_THAT(refused([](auto& r) { r.highest[3] = 3; }),
              HasSubstr("feasible range of closing_time"));
  EXPECT_THAT(refused([](auto& r) { r.inside = -1; }), HasSubstr("must not be negative"));
  EXPECT_THAT(refused([](auto& r) { r.most_energy = 10e3; }), HasSubstr("more than feasible"));
  EXPECT_THAT(refused([](auto& r) {
                for (std::size_t i = 0; i < 4; ++i) {
                  r.lowest[i] = r.levels[i].front();
                  r.highest[i] = r.levels[i].back();
                }
              }),
              HasSubstr("widen the ranges"));
}

}  // namespace
}  // namespace wearwell::clutch
