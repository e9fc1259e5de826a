#pragma once

#include <span>
#include <vector>

#include "wearwell/plan/outcomes.h"

namespace wearwell::plan {

/// `possible_outcomes` of tests that show counts (Poisson, binomial): whole numbers, all of them
/// where their distributions are narrow, else blocks of an odd number of them, of at most half a
/// standard deviation, by the middle one (midpoint rule).
std::vector<Outcomes> count_outcomes(const TestStudy& study, const Table& conditions,
                                     std::span<const PlannedTest> tests, const Points& nodes,
                                     std::span<const double> weights);

}  // namespace wearwell::plan
