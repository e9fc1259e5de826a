#include <algorithm>
#include <cmath>
#include <string_view>

#include "wearwell/plan/acceleration_question.h"

namespace wearwell::plan {
namespace {

constexpr double boltzmann = 8.617333262e-5;  // eV/K, CODATA 2018

// log(T/T_use) at a place between the use condition and the highest temperature.
double log_temperature(double use, double highest, double at) {
  return -std::log(std::lerp(1.0, use / highest, at));
}

double known_part_of(const AccelerationTest& test, double at) {
  return test.relation == Relation::eyring ? log_temperature(test.use, test.highest, at) : 0;
}

}  // namespace

double transformed_stress(Relation relation, double stress) {
  return is_of_temperature(relation)           ? -1 / (boltzmann * stress)
         : relation == Relation::inverse_power ? std::log(stress)
                                               : stress;
}

double stress_of(Relation relation, double transformed) {
  return is_of_temperature(relation)           ? -1 / (boltzmann * transformed)
         : relation == Relation::inverse_power ? std::exp(transformed)
                                               : transformed;
}

double AccelerationTest::xi(double stress) const {
  const double at_use = transformed_stress(relation, use);
  return (transformed_stress(relation, stress) - at_use) /
         (transformed_stress(relation, highest) - at_use);
}

double AccelerationTest::stress(double at) const {
  return stress_of(relation, std::lerp(transformed_stress(relation, use),
                                       transformed_stress(relation, highest), at));
}

double AccelerationTest::stop(const TestLevel& level) const {
  return until * std::exp(level.log_stop);
}

PlanningPoint AccelerationTest::point(const std::array<double, 3>& value) const {
  const double scale = values[0].name == "shape" ? 1 / value[0] : value[0];
  const auto is = [&](int i, std::string_view option) { return values[i].option == option; };
  double at_use = 0, at_highest = 0;
  bool use_known = false, highest_known = false;
  for (int i = 1; i < 3; ++i) {
    if (is(i, "--failing-at-use")) {
      at_use = quantile(distribution, value[i]);
      use_known = true;
    } else if (is(i, "--failing-at-highest")) {
      at_highest = quantile(distribution, value[i]);
      highest_known = true;
    } else if (is(i, "--life-at-highest")) {
      at_highest = quantile(distribution, life_share) + std::log(until / value[i]) / scale;
      highest_known = true;
    }
  }
  // The line is what the known part leaves.
  at_highest -= known_part_of(*this, 1) / scale;
  if (use_known && highest_known) return {at_use, at_highest - at_use, scale, 1};
  // The slope is the second: of log life by the transformed stress in its usual unit.
  const double reach = transformed_stress(relation, highest) - transformed_stress(relation, use);
  const double slope = is_of_temperature(relation)    ? value[2] / electron_volt
                       : relation == Relation::linear ? value[2] / stress_unit.scale
                                                      : value[2];
  const double rise = slope * reach / scale;
  return {use_known ? at_use : at_highest - rise, rise, scale, 1};
}

std::array<double, 3> AccelerationTest::medians() const {
  return {values[0].value.at(0), values[1].value.at(0), values[2].value.at(0)};
}

bool AccelerationTest::uncertain() const {
  return std::any_of(values.begin(), values.end(),
                     [](const NamedValue& each) { return each.value.uncertain; });
}

AccelerationGoal AccelerationTest::with(const std::array<double, 3>& value) const {
  AccelerationGoal goal{distribution, failing, {point(value)}};
  for (std::size_t i = 0; i < stops.size(); ++i) goal.log_stops[i] = std::log(stops[i] / until);
  if (relation == Relation::eyring)
    goal.known_part = [first = use, last = highest](double at) {
      return log_temperature(first, last, at);
    };
  return goal;
}

AccelerationGoal AccelerationTest::at_medians() const {
  return with(medians());
}

AccelerationGoal AccelerationTest::averaged() const {
  const std::vector<NormalNode> one = {{0, 1}}, many = normal_nodes(7);
  const auto nodes = [&](int i) -> const std::vector<NormalNode>& {
    return values[i].value.uncertain ? many : one;
  };
  AccelerationGoal goal = at_medians();
  goal.points.clear();
  for (const NormalNode& a : nodes(0))
    for (const NormalNode& b : nodes(1))
      for (const NormalNode& c : nodes(2)) {
        PlanningPoint each =
            point({values[0].value.at(a.z), values[1].value.at(b.z), values[2].value.at(c.z)});
        each.weight = a.weight * b.weight * c.weight;
        goal.points.push_back(each);
      }
  return goal;
}

}  // namespace wearwell::plan
