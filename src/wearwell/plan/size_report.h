#pragma once

#include <cstdint>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/plan/answer.h"
#include "wearwell/plan/assurance.h"
#include "wearwell/plan/planning_study.h"

namespace wearwell::plan {

/// What campaigns of one size showed, on average.
struct SizeRow {
  std::size_t size = 0, runs = 0;
  std::size_t narrow = 0;           ///< campaigns whose interval is narrow enough
  std::size_t covered = 0;          ///< campaigns whose interval contains the truth
  std::size_t unresolved = 0;       ///< quadrature did not converge: counted as too wide
  std::size_t without_failure = 0;  ///< the study refuses run-outs alone: counted as too wide
  double median_width = 0;          ///< ratio, or unit of the goal
  double failures = 0, runouts = 0;
  double time = 0;     ///< sum of the values of all specimens, unit of the measured column
  double longest = 0;  ///< of the longest test
};

/// The answer with all that is needed to describe it.
struct SizeReport {
  const PlanningStudy* planning = nullptr;
  Goal goal;
  bool ratio = true;
  double width = 0, assurance = 0, level = 0;
  std::uint64_t seed = 0;
  std::vector<SizeRow> rows;
  AssuranceSearch search;
};

std::vector<Check> size_checks(const SizeReport& report);
Answer size_answer(const SizeReport& report);

}  // namespace wearwell::plan
