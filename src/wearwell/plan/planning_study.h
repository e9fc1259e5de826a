#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/infer/exact.h"
#include "wearwell/plan/candidates.h"
#include "wearwell/plan/goal.h"
#include "wearwell/plan/outcomes.h"
#include "wearwell/plan/test_study.h"

namespace wearwell::plan {

/// A study before any test: its priors and its formula, without its data.
struct PlanningStudy {
  TestStudy tests;                     ///< its own rows are stand-ins that no result depends on
  std::unique_ptr<const Study> whole;  ///< with [predict], for goals
  Candidates conditions;
  std::vector<double> shares;  ///< of specimens by candidate; sum to 1

  const PosteriorStudy& study() const;
};

/// `rows` has the tests: conditions, an allocation `specimens` (numbers or proportions), optional
/// `stop` and `name`. The study's data file is not read and need not exist. Throws InputError that
/// names what is wrong: a prior that is improper or taken from data, columns that are missing.
PlanningStudy planning_study(const Source& source, const ReadStudy& read, const Table& rows,
                             const std::string& measure);

/// The conditions of specimen 0, 1, ...: each next one goes where most is missing, so that the first
/// n of a longer campaign are a campaign of n.
std::vector<std::size_t> allocation(std::span<const double> shares, std::size_t count);

/// One simulated campaign of the largest size: smaller ones are its first specimens.
struct SimulatedCampaign {
  std::vector<double> truth;          ///< parameters, natural, SI
  std::vector<TestOutcome> outcomes;  ///< of each specimen
};

/// Campaigns with parameters drawn from the priors; campaign i uses stream i of the seed. Throws
/// InputError where a test is impossible or may never end.
std::vector<SimulatedCampaign> simulated_campaigns(const PlanningStudy& planning,
                                                   std::span<const std::size_t> specimens,
                                                   std::size_t count, std::uint64_t seed);

/// The study with these finished tests as its only data; `specimens` are indices of candidates.
Source with_tests(const PlanningStudy& planning, std::span<const std::size_t> specimens,
                  std::span<const TestOutcome> outcomes);

/// The posterior of a study by the same quadrature as a fit, with moments to 0.1 %; `failure` is
/// not empty where quadrature does not resolve it within `max_evaluations` of the density.
ExactPosterior tested_posterior(const PosteriorStudy& study,
                                long max_evaluations = ExactSettings{}.max_evaluations);

struct GoalInterval {
  double low = 0, middle = 0, high = 0;  ///< unit of the goal
};

/// The central interval of the goal; empty where quadrature does not resolve the posterior.
std::optional<GoalInterval> goal_interval(const ExactPosterior& exact, const Goal& goal,
                                          double level);

/// The same after the first `size` specimens of a campaign.
std::optional<GoalInterval> goal_interval(const PlanningStudy& planning, const Goal& goal,
                                          std::span<const std::size_t> specimens,
                                          const SimulatedCampaign& campaign, std::size_t size,
                                          double level);

}  // namespace wearwell::plan
