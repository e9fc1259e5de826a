#pragma once

#include <string>

#include "wearwell/plan/gain.h"
#include "wearwell/plan/goal.h"
#include "wearwell/plan/next_question.h"

namespace wearwell::plan {

/// The decision that tests may improve: at which age units are replaced (prognosis/replacement.h).
/// Its loss is the long-run cost per unit of use, given the population. Rates are in the currency
/// per unit of the goal.
struct DecisionLoss {
  std::string currency;  ///< may be empty
  std::string per;       ///< unit of use: "1e5 cycles"
  double now = 0;        ///< mean cost rate of the best age today
  double known = 0;      ///< of the best age of each population, if it were known
  double age = 0;        ///< the best today, unit of the goal; infinite: at failure only
  double fleet_use =
      0;  ///< use of all units that the decision is for, unit of the goal; 0: not given

  double saved(double rate) const { return rate * fleet_use; }  ///< in the currency
  double share(double rate) const { return rate / now; }        ///< of today's cost
};

/// Puts the losses of candidate ages at each node into `points`. Throws InputError that names the
/// option: a goal that is not a B-life, costs that are missing or wrong.
DecisionLoss decision_loss(const NextQuestion& question, const Goal& goal, const Points& nodes,
                           GoalNodes& points);

/// "Age replacement today: ..." in one sentence.
std::string loss_text(const DecisionLoss& loss);

}  // namespace wearwell::plan
