#include <cmath>

#include "wearwell/plan/inspect_report.h"

namespace wearwell::plan {
namespace {

using Json = nlohmann::ordered_json;

Json cost_json(const InspectReport& report, const InspectionCost& cost) {
  const double scale = report.lives->unit.scale;
  return {{"total", cost.total},
          {"inspections", cost.inspections},
          {"failing", cost.failing},
          {"replaced", cost.replaced},
          {"downtime", cost.downtime / scale},
          {"lost", cost.lost / scale}};
}

Json unit_json(const InspectReport& report, const UnitInspections& unit) {
  const double scale = report.lives->unit.scale;
  Json json = {{"unit", unit.name.empty() ? Json() : Json(unit.name)},
               {"now", std::isfinite(unit.now) ? Json(unit.now / scale) : Json()},
               {"passed", unit.life.passed()},
               {"past", unit.past}};
  if (unit.past) return json;
  json["until"] = unit.bounds.until / scale;
  Json inspections = Json::array();
  const std::vector<double> risks = risks_between(unit.life, unit.times, unit.bounds.until);
  for (std::size_t k = 0; k < unit.times.size(); ++k)
    inspections.push_back({{"after", unit.times[k] / scale},
                           {"risk", risks[k]},
                           {"reached", unit.life.reached(unit.times[k])}});
  json["inspections"] = std::move(inspections);
  json["end"] = {{"risk", risks.back()}, {"reached", unit.life.reached(unit.bounds.until)}};
  if (report.warning)
    json["unforeseen"] = unforeseen(unit.life, unit.times, unit.bounds.until, *report.warning);
  if (!unit.cost) return json;
  json["cost"] = cost_json(report, *unit.cost);
  json["compared"] = Json::array();
  for (const OtherPlan& each : unit.others) {
    Json other = {{"plan", each.name}};
    if (each.interval > 0) other["interval"] = each.interval / scale;
    other["cost"] = cost_json(report, each.cost);
    json["compared"].push_back(std::move(other));
  }
  return json;
}

}  // namespace

nlohmann::ordered_json inspect_json(const InspectReport& report) {
  const double scale = report.lives->unit.scale;
  const auto optional = [](const std::optional<double>& x, double one = 1) {
    return x ? Json(*x / one) : Json();
  };
  static constexpr const char* aims[] = {"fewest", "total risk", "cheapest"};
  Json json = {{"title", report.lives->title},
               {"plan", "inspect"},
               {"trusted", report.lives->trusted},
               {"unit", report.lives->unit.text},
               {"aim", aims[static_cast<int>(report.aim)]},
               {"risk", optional(report.risk)},
               {"total_risk", optional(report.total)},
               {"warning", optional(report.warning, scale)},
               {"until", report.until / scale},
               {"step", report.step > 0 ? Json(report.step / scale) : Json()}};
  if (report.aim == InspectAim::cheapest)
    json["currency"] = report.currency.empty() ? Json() : Json(report.currency);
  json["units"] = Json::array();
  for (const UnitInspections& each : report.units) json["units"].push_back(unit_json(report, each));
  if (report.fleet) {
    json["visits"] = Json::array();
    for (std::size_t v = 0; v < report.visits.size(); ++v)
      json["visits"].push_back({{"after", report.visits[v] / scale},
                                {"expected", report.expected[v]},
                                {"at_least_one", report.any[v]}});
    json["visits_alone"] = report.alone_visits;
    if (report.joint)
      json["joint"] = {{"cost", report.joint->total},
                       {"least_possible", report.joint->least_possible}};
  }
  if (report.next) {
    const NextIntervals& next = *report.next;
    json["next_reading"] = {{"reads", next.column},
                            {"after", next.first / scale},
                            {"planned", next.planned / scale},
                            {"outcomes", Json::array()}};
    for (std::size_t i = 0; i < next.reading.size(); ++i)
      json["next_reading"]["outcomes"].push_back(
          {{"reading", from_si(next.reading_unit, next.reading[i])},
           {"interval",
            std::isfinite(next.interval[i]) ? Json(next.interval[i] / scale) : Json()}});
  }
  json["checks"] = Json::array();
  static constexpr const char* words[] = {"pass", "warn", "fail"};
  for (const Check& each : inspect_checks(report))
    json["checks"].push_back({{"name", each.name},
                              {"verdict", words[static_cast<int>(each.verdict)]},
                              {"detail", each.detail}});
  return json;
}

}  // namespace wearwell::plan
