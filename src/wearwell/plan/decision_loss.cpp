#include "wearwell/plan/decision_loss.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <cmath>
#include <limits>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/plan/candidates.h"
#include "wearwell/present/plain.h"
#include "wearwell/prognosis/money.h"
#include "wearwell/prognosis/quantity_like.h"
#include "wearwell/prognosis/replacement.h"
#include "wearwell/prognosis/study_lives.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

constexpr std::size_t most_ages = 120;

prognosis::Costs costs_of(const NextQuestion& question, prognosis::Currency& currency) {
  const auto require = [](const char* option, const std::string& text) {
    if (text.empty())
      throw InputError(fmt::format(
          "{} is missing: --by loss needs --failure-cost and --replacement-cost", option));
  };
  require("--failure-cost", question.failure_cost);
  require("--replacement-cost", question.replacement_cost);
  prognosis::Costs costs;
  costs.failure = prognosis::amount("--failure-cost", question.failure_cost, currency);
  costs.replacement = prognosis::replacement_amount(question.replacement_cost, currency);
  if (!(costs.failure > costs.replacement))
    throw InputError(
        "--failure-cost: must be above --replacement-cost; otherwise nothing is replaced before it "
        "fails, whatever tests show");
  return costs;
}

// Lives of units of the population at each node.
std::vector<prognosis::WeightedLives> lives_at(const Goal& goal, const Points& nodes) {
  std::vector<prognosis::WeightedLives> lives(static_cast<std::size_t>(nodes.rows()));
  tbb::parallel_for(std::size_t{0}, lives.size(), [&](std::size_t j) {
    const auto x = nodes.row(static_cast<Index>(j));
    lives[j] = prognosis::represented_lives(
        goal.lives({x.data(), static_cast<std::size_t>(x.size())}).quantile);
  });
  return lives;
}

}  // namespace

DecisionLoss decision_loss(const NextQuestion& question, const Goal& goal, const Points& nodes,
                           GoalNodes& points) {
  if (!goal.lives)
    throw InputError(fmt::format(
        "--by loss: {} is not a life of new units; name one as the goal, like 'B10 at NAME'",
        printable(goal.name)));
  prognosis::Currency currency;
  const prognosis::Costs costs = costs_of(question, currency);
  DecisionLoss loss{currency.text, goal.unit.text};
  if (!question.fleet_use.empty())
    loss.fleet_use = from_si(goal.unit, prognosis::quantity_like("--fleet-use", question.fleet_use,
                                                                 goal.unit, Allowed::positive));
  const std::vector<prognosis::WeightedLives> lives = lives_at(goal, nodes);
  std::vector<double> ages = prognosis::ages_of(lives, most_ages);
  ages.push_back(std::numeric_limits<double>::infinity());
  points.loss.resize(nodes.rows(), std::ssize(ages));
  tbb::parallel_for(std::size_t{0}, lives.size(), [&](std::size_t j) {
    const prognosis::PopulationLives population(lives[j]);
    for (std::size_t a = 0; a < ages.size(); ++a)
      points.loss(static_cast<Index>(j), static_cast<Index>(a)) =
          goal.unit.scale * prognosis::cost_rate(population, costs, ages[a]);
  });
  const Eigen::Map<const Eigen::VectorXd> weight(points.weight.data(), std::ssize(points.weight));
  loss.now = (weight.transpose() * points.loss).minCoeff(&points.best) / weight.sum();
  loss.known = weight.dot(points.loss.rowwise().minCoeff()) / weight.sum();
  loss.age = from_si(goal.unit, ages[static_cast<std::size_t>(points.best)]);
  return loss;
}

std::string loss_text(const DecisionLoss& loss) {
  // Per 1e5 cycles a rate has a size that people read; the words keep the power.
  const auto [factor, unit] = plain_unit(loss.per);
  const std::string per = factor == 1 ? unit : fmt::format("{} {}", plain_number(factor), unit);
  return fmt::format(
      "Replacement {} costs {}{}{} per {} today; with lives known exactly it would cost {}, so "
      "that no test saves more than {:.3g} %.",
      std::isfinite(loss.age) ? fmt::format("at {} {}", plain_number(loss.age * factor), unit)
                              : std::string("at failure only"),
      plain_number(loss.now), loss.currency.empty() ? "" : " ", loss.currency, per,
      plain_number(loss.known), 100 * (1 - loss.known / loss.now));
}

}  // namespace wearwell::plan
