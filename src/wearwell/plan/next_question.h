#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/plan/answer.h"
#include "wearwell/plan/test_study.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell::plan {

/// Which test next? `candidates` or `grid`, not both.
struct NextQuestion {
  std::string goal;                          ///< "B10 at hanger" (goal.h)
  std::optional<Table> candidates = {};      ///< (candidates.h)
  std::string grid = {};                     ///< "stress = 200 to 500 by 25 MPa; stop = 1e6 cycles"
  std::string specimens = {};                ///< "1, 3, 5", for rows without that column; "" for 1
  std::string cost = {};                     ///< column of costs; may be empty
  std::optional<double> specimen_cost = {};  ///< instead of a column: cost of each specimen
  std::optional<double> use_cost = {};       ///< and of each unit of its expected life on test
  std::string measure = {};                  ///< the measured column, if the study has several
  std::string by = "variance";  ///< ranks: variance (of the goal), information, or loss
  /// Of `loss`: costs of age replacement, "12000 EUR" (decision_loss.h), and optionally the use of
  /// all units that the decision is for, "1e9 cycles".
  std::string failure_cost = {}, replacement_cost = {}, fleet_use = {};
  std::optional<double> value = {};   ///< worth of one per cent of narrowing, in units of cost
  std::optional<double> budget = {};  ///< of a batch, in units of cost
  int batch = 1;                      ///< at most so many candidates together
  std::string until = {};             ///< "width <= factor 1.5", "width <= 20 MPa"
  std::vector<Table> tests = {};      ///< done since the fit, in the columns of the data
  int samples = 256;                  ///< of nested Monte Carlo, for more than one specimen
  int nodes = 800;                    ///< of the posterior, at most
  std::uint64_t seed = 1;
};

/// `result` names the result in messages. Throws InputError that names option, row or column.
Answer next_test(prognosis::CarriedState state, const std::string& result, const ReadStudy& read,
                 const NextQuestion& question);

}  // namespace wearwell::plan
