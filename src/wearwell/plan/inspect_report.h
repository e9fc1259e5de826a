#pragma once

#include <optional>
#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/plan/answer.h"
#include "wearwell/plan/joint_visits.h"
#include "wearwell/prognosis/known_lives.h"

namespace wearwell::plan {

/// What decides the times.
enum class InspectAim { fewest, total_risk, cheapest };

/// A plan to compare with.
struct OtherPlan {
  std::string name;     ///< "every 300 h"
  double interval = 0;  ///< SI; 0: none
  InspectionCost cost;
};

/// One unit's plan.
struct UnitInspections {
  std::string name;  ///< empty: a new unit
  double now = 0;    ///< position on the axis, SI; NaN if unknown
  LifeAhead life;
  InspectionBounds bounds;
  bool past = false;     ///< it has more likely than not reached its threshold: no plan
  bool shorter = false;  ///< its plan ends before the horizon, where hardly any is left running
  std::vector<double> times = {};
  std::optional<InspectionCost> cost = {};
  std::vector<OtherPlan> others = {};
};

/// How the first reading is expected to move the next inspection.
struct NextIntervals {
  std::string column;  ///< what is read
  Unit reading_unit;
  double first = 0;    ///< time of the reading, SI
  double planned = 0;  ///< the second interval by present knowledge, SI; NaN if there is none
  std::vector<double> reading, interval;  ///< of outcomes of equal probability, SI
};

/// A plan with all that is needed to describe it.
struct InspectReport {
  const prognosis::KnownLives* lives = nullptr;
  InspectAim aim = InspectAim::fewest;
  std::optional<double> risk = {}, total = {}, warning = {};
  double until = 0, step = 0;
  bool until_given = false;
  std::string currency;
  InspectionPrices prices;
  std::vector<UnitInspections> units;
  bool fleet = false;
  std::vector<double> visits = {};              ///< of a fleet
  std::vector<double> expected = {}, any = {};  ///< by visit: units that have reached their
                                                ///< threshold, the probability of at least one
  std::string counted = {};                     ///< how units are counted
  std::optional<JointVisits> joint = {};        ///< with costs of visits
  std::size_t alone_visits = 0;                 ///< visits if each unit is planned alone
  std::optional<NextIntervals> next = {};
  std::string no_next = {};  ///< why the next reading is missing although a unit is planned
};

std::vector<Check> inspect_checks(const InspectReport& report);
nlohmann::ordered_json inspect_json(const InspectReport& report);
Answer inspect_answer(const InspectReport& report);

/// Tables and figures of the page (inspect_tables.cpp).
present::Table inspections_table(const InspectReport& report, const UnitInspections& unit);
present::Table costs_table(const InspectReport& report, const UnitInspections& unit);
present::Table inspected_units_table(const InspectReport& report);
present::Table visits_table(const InspectReport& report);
html::Figure interval_risk_figure(const InspectReport& report, const UnitInspections& unit);
html::Figure reached_figure(const InspectReport& report, const UnitInspections& unit);
html::Figure visits_figure(const InspectReport& report);
html::Figure next_figure(const InspectReport& report);

}  // namespace wearwell::plan
