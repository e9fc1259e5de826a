#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/plan/candidates.h"
#include "wearwell/plan/decision_loss.h"
#include "wearwell/plan/gain.h"
#include "wearwell/plan/next_question.h"
#include "wearwell/present/html.h"

namespace wearwell::plan {

/// A candidate with its gain, on the scale of the goal.
struct Judged {
  Candidate candidate;
  const Outcomes* outcomes = nullptr;  ///< of one specimen; null where gains have a closed form
  Gain gain;
  double narrowing = 0, narrowing_error = 0;  ///< 1 - root of `variance_share`
  double variance_share = 0;                  ///< expected variance over the present one
  std::optional<double> cost = {};            ///< of all specimens
  double score = 0;                           ///< what the ranking maximizes: gain, or gain / cost
};

/// Specimens of one candidate, among tests done together.
struct Tested {
  std::size_t candidate = 0;  ///< of NextPlan::judged
  int specimens = 1;
};

/// Candidates chosen together.
struct ChosenBatch {
  std::vector<std::size_t> chosen;  ///< of NextPlan::judged, with repetitions
  Gain gain;
  double narrowing = 0, narrowing_error = 0;
  std::optional<double> cost = {};
  std::size_t shortlist = 0;  ///< so many candidates were considered
};

/// How far the goal is from its target.
struct Target {
  std::string text;  ///< "width <= factor 1.5"
  double width = 0;  ///< on the scale of the goal
  bool reached = false;
  std::optional<int> tests = {};  ///< further specimens of the best candidate; empty: beyond `most`
  int most = 64;
};

/// The present posterior of a goal, and what each candidate adds.
struct NextPlan {
  std::string title;
  Goal goal;
  bool logarithmic = false;
  GoalSpread now;    ///< over the whole posterior if the study reports the goal, else of the nodes
  GoalSpread nodes;  ///< of the nodes
  GoalNodes points;
  std::optional<DecisionLoss> loss = {};
  std::string use_unit;  ///< of Gain::use; empty unless tests are lives
  std::string currency;
  std::vector<ConditionColumn> conditions;
  Table condition_values;
  std::vector<Outcomes> outcomes;  ///< of one specimen of each different test
  std::vector<Judged> judged;      ///< best first
  /// The gain of tests done together, on the scale of `nodes`.
  std::function<Gain(const NextPlan& plan, std::span<const Tested> tests)> gain_together = {};
  std::string how = {};  ///< how gains are computed, in sentences; empty: over the nodes
  bool worth_it = true;  ///< whether the best is worth its cost, or gains anything
  std::string why_not = {};
  std::optional<ChosenBatch> batch = {};
  std::optional<Target> target = {};
  std::vector<double> typical = {};  ///< weights of `points` after the best
  std::size_t tests_done = 0;
  double kept = 1;  ///< of the effective number of nodes, after these tests
  std::vector<std::string> notes = {};
  std::vector<Check> checks = {};
  bool trusted = true;

  double in_unit(double goal_value) const;
  /// The width after this narrowing, from the present one of the whole posterior.
  double expected_width(double narrowing) const { return now.width() * (1 - narrowing); }
};

/// Throws InputError that names the option.
void check_question(const NextQuestion& question);

/// Shares, costs and order of the candidates, whose gains are known.
void rank_candidates(const NextQuestion& question, NextPlan& plan);

/// The answer of ranked candidates: checks, whether the best is worth its cost, batch and target.
Answer answer_of_ranked(NextPlan plan, const NextQuestion& question);

/// The best set of candidates by greedy choice and exchange, within `budget` and `most` of them.
ChosenBatch choose_batch(const NextPlan& plan, const NextQuestion& question);

nlohmann::ordered_json next_json(const NextPlan& plan, const NextQuestion& question);
/// Text, sections and JSON.
Answer answer_of(const NextPlan& plan, const NextQuestion& question);
std::vector<html::Figure> next_figures(const NextPlan& plan);

}  // namespace wearwell::plan
