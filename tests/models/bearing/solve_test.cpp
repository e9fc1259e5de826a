#include "wearwell/models/bearing/solve.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "support/between.h"
#include "wearwell/base/error.h"
#include "wearwell/models/bearing/scar.h"

namespace wearwell::bearing {
namespace {

using Input = std::optional<double> Bearing::*;

double relative(double value, double expected) {
  return std::abs(value - expected) / std::abs(expected);
}

/// The paper's first example, complete but for its rate.
Bearing example() {
  Bearing b;
  b.radius = 0.02;
  b.clearance = 2e-5;
  b.depth = 1e-4;
  b.pressure = 1e6;
  b.revolutions = 1e5;
  return b;
}

/// Any bearing, with all that can be asked of it; not one that `solve` takes.
rc::Gen<Bearing> bearings() {
  return rc::gen::exec([] {
    Bearing b;
    b.contact = *rc::gen::element(Contact::stationary, Contact::journal, Contact::bushing);
    b.radius = *between(1e-3, 0.1);
    b.clearance = *b.radius * *between(1e-5, 1e-2);
    b.depth = *b.radius * *between(1e-6, 0.05);
    b.force = *between(1, 1e5);
    b.length = *b.radius * *between(0.2, 5);
    b.pressure = *b.force / (2 * *b.radius * *b.length);
    b.speed = *between(0.01, 100);
    b.time = *between(10, 1e8);
    b.revolutions = *b.speed * *b.time;
    return b;
  });
}

Bearing without(Bearing b, const std::vector<Input>& inputs) {
  for (const Input input : inputs) b.*input = std::nullopt;
  return b;
}

const std::vector<Input> load = {&Bearing::force, &Bearing::length};
const std::vector<Input> duration = {&Bearing::speed, &Bearing::time};

// p_a = 1e6 N/m^2, n = 1e5; digits from tests/golden/bearing_examples.py.
TEST(Solve, FirstWorkedExample) {
  const Solution s = solve(Quantity::rate, example());
  EXPECT_LT(relative(s.wear_number, 7.185812700472977e-4), 1e-14);
  EXPECT_LT(relative(s.value, 7.185812700472977e-15), 1e-14);
  EXPECT_DOUBLE_EQ(s.sigma, 1e-3);
  EXPECT_DOUBLE_EQ(s.delta, 5e-3);
}

// sigma = 20e-4, p_a = 2e6 N/m^2, n = 1e6, k = 1e-16 m^3/(N m).
TEST(Solve, SecondWorkedExample) {
  Bearing b;
  b.radius = 0.01;
  b.clearance = 2e-5;
  b.rate = 1e-16;
  b.pressure = 2e6;
  b.revolutions = 1e6;
  const Solution s = solve(Quantity::depth, b);
  EXPECT_LT(relative(s.delta, 18.67228112810098e-4), 1e-14);
  EXPECT_LT(relative(s.value, 18.67228112810098e-6), 1e-14);
}

// k from k = W/(F s) of the definition itself: W = A L, s = 2 pi r n, A by even wear of the
// journal.
TEST(Solve, AgreesWithDefinition) {
  const double r = 0.02, d = 1e-4, L = 0.03, F = 1200, n = 1e5;
  Bearing b;
  b.contact = Contact::journal;
  b.radius = r;
  b.clearance = 2e-5;
  b.depth = d;
  b.force = F;
  b.length = L;
  b.speed = 2.5;
  b.time = n / 2.5;
  using std::numbers::pi;
  const double k = pi * (2 * r * d + d * d) * L / (F * 2 * pi * r * n);
  EXPECT_LT(relative(solve(Quantity::rate, b).value, k), 1e-14);
}

RC_GTEST_PROP(Solve, AnswersFitTogether, ()) {
  Bearing all = *bearings();
  const auto given = [&](std::vector<Input> left_out) { return without(all, left_out); };
  using B = Bearing;
  all.rate = solve(Quantity::rate, without(given(load), duration)).value;
  const auto close = [](double value, double expected) {
    return relative(value, expected) < 1e-12;
  };
  RC_ASSERT(close(solve(Quantity::rate, given({&B::rate, &B::pressure, &B::revolutions})).value,
                  *all.rate));
  RC_ASSERT(close(solve(Quantity::depth, given({&B::depth, &B::pressure, &B::revolutions})).value,
                  *all.depth));
  RC_ASSERT(
      close(solve(Quantity::pressure, given({&B::pressure, &B::force, &B::length, &B::revolutions}))
                .value,
            *all.pressure));
  RC_ASSERT(close(solve(Quantity::length, given({&B::pressure, &B::length, &B::revolutions})).value,
                  *all.length));
  RC_ASSERT(close(
      solve(Quantity::revolutions, given({&B::pressure, &B::revolutions, &B::speed, &B::time}))
          .value,
      *all.revolutions));
  RC_ASSERT(close(solve(Quantity::time, given({&B::pressure, &B::revolutions, &B::time})).value,
                  *all.time));
}

RC_GTEST_PROP(Solve, DeeperWearIsNeverSmallerRate, ()) {
  Bearing b = without(without(*bearings(), load), duration);
  const double before = solve(Quantity::rate, b).value;
  b.depth = *b.depth * *between(1 + 1e-9, 2);
  RC_ASSERT(solve(Quantity::rate, b).value >= before);
}

RC_GTEST_PROP(Solve, SensitivityIsSlope, ()) {
  using B = Bearing;
  Bearing all = *bearings();
  all.rate = *between(1e-18, 1e-14);
  if (*rc::gen::arbitrary<bool>()) {
    all.contact = Contact::stationary;
    all.scar_width = *all.radius * *between(0.01, 1.9);
    all.depth = std::nullopt;
  }
  struct Question {
    Quantity wanted;
    std::vector<Input> left_out;
  };
  const Question q = *rc::gen::element(
      Question{Quantity::rate, {&B::rate, &B::pressure, &B::revolutions}},
      Question{Quantity::pressure, {&B::pressure, &B::force, &B::length, &B::speed, &B::time}},
      Question{Quantity::length, {&B::pressure, &B::length, &B::revolutions}},
      Question{Quantity::revolutions,
               {&B::force, &B::length, &B::revolutions, &B::speed, &B::time}},
      Question{Quantity::time, {&B::pressure, &B::revolutions, &B::time}},
      Question{Quantity::depth, {&B::depth, &B::scar_width, &B::pressure, &B::revolutions}});
  Bearing b = without(all, q.left_out);
  if (q.wanted == Quantity::depth) {
    // A rate that wears a depth from `bearings`.
    Bearing worn = without(all, q.left_out);
    worn.rate = std::nullopt;
    worn.depth = *b.radius * *between(1e-6, 0.05);
    b.rate = solve(Quantity::rate, worn).value;
  }
  const Bearing s = sensitivity(q.wanted, b);
  for (const Input input :
       {&B::radius, &B::clearance, &B::depth, &B::scar_width, &B::rate, &B::pressure, &B::force,
        &B::length, &B::revolutions, &B::speed, &B::time}) {
    RC_ASSERT((s.*input).has_value() == (b.*input).has_value());
    if (!(b.*input)) continue;
    const double h = 1e-5;
    Bearing up = b, down = b;
    up.*input = *(b.*input) * (1 + h);
    down.*input = *(b.*input) * (1 - h);
    const double slope =
        std::log(solve(q.wanted, up).value / solve(q.wanted, down).value) / (2 * h);
    RC_ASSERT(std::abs(*(s.*input) - slope) < 1e-5 * (1 + std::abs(slope)));
  }
}

std::string refusal(Quantity wanted, const Bearing& b) {
  try {
    solve(wanted, b);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(Solve, NamesWhatIsWrong) {
  Bearing b = example();
  b.radius = std::nullopt;
  EXPECT_EQ(refusal(Quantity::rate, b), "radius is missing: the rate needs radius");
  b = example();
  b.depth = std::nullopt;
  EXPECT_EQ(refusal(Quantity::rate, b), "depth is missing: the rate needs depth (or scar width)");
  b = example();
  b.pressure = std::nullopt;
  b.force = 10;
  EXPECT_EQ(refusal(Quantity::rate, b),
            "length is missing: the rate needs pressure (or force and length)");
  b.pressure = 1e6;
  EXPECT_EQ(refusal(Quantity::rate, b),
            "both pressure and force and length are given; give one or the other");
  b = example();
  b.rate = 1e-16;
  EXPECT_EQ(refusal(Quantity::rate, b), "rate is given, but the rate does not depend on it");
  b = example();
  b.clearance = -2e-5;
  EXPECT_EQ(refusal(Quantity::rate, b), "clearance is -2e-05 in SI units; it must be positive");
  b = example();
  b.contact = Contact::journal;
  b.depth = std::nullopt;
  b.scar_width = 0.01;
  EXPECT_EQ(refusal(Quantity::rate, b),
            "scar width is given, but only a stationary contact leaves a scar");
  b = example();
  b.depth = 0.05;
  EXPECT_NE(refusal(Quantity::rate, b), "");
}

}  // namespace
}  // namespace wearwell::bearing
