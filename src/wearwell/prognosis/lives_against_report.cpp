#include "wearwell/prognosis/lives_against_report.h"

#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/option_value.h"
#include "wearwell/present/table.h"
#include "wearwell/prognosis/required_lives.h"
#include "wearwell/prognosis/unit_life.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell::prognosis {
namespace {

using nlohmann::ordered_json;

// A life of a result. The study lives here, the posterior in the state.
struct FoundLife {
  std::unique_ptr<const Study> study;
  NamedLife life;
  std::string of;

  FoundLife(const NamedState& result, const std::string& unit, Models models)
      : study(read_study(result.state.source, models)) {
    const auto lives = required_lives(require_posterior_study(*study), printable(result.name));
    life = life_named(lives, unit, result.name + ": --unit");
    const std::string at = life.request->at.empty() ? "" : " " + life.request->at;
    of = printable(fmt::format("{}, {}{}", result.name, without_new(life.request->of), at));
  }
};

double confidence_of(const std::string& text) {
  const double confidence = option_value("--confidence", text, "1", Allowed::positive);
  if (!(confidence < 1))
    throw InputError(fmt::format("--confidence: {} must lie between 0 and 100 %", text));
  return std::round(confidence * 1e12) / 1e12;  // 0.95, not 0.9500000000000001, of 95 %
}

void refuse_other_dimension(const Unit& unit, const Unit& other) {
  const auto a = parse_unit(unit.text), b = parse_unit(other.text);
  if (unit.text != other.text && !(a && b && a->dimension == b->dimension))
    throw InputError(
        fmt::format("--against: lives in {} and in {} cannot be compared", unit.text, other.text));
}

ordered_json value_json(const ComparedValue& value) {
  return {{"q05", value.q05},   {"q50", value.q50},        {"q95", value.q95},
          {"mean", value.mean}, {"at_least", value.lower}, {"better", value.larger}};
}

present::Table against_table(const LivesAgainstReport& report) {
  const LivesAgainst& found = report.found;
  const present::Format share = present::digits(3);
  present::Table table{"against",
                       "The first against the other",
                       {{"", "1", {}},
                        {fmt::format("at least, {:.6g} %", 100 * found.confidence), "1", share},
                        {"5 %", "1", share},
                        {"50 %", "1", share},
                        {"95 %", "1", share},
                        {"better [%]", "1", share}}};
  const auto add = [&](const std::string& name, const ComparedValue& value, double scale) {
    table.rows.push_back({name, scale * value.lower, scale * value.q05, scale * value.q50,
                          scale * value.q95, 100 * value.larger});
  };
  for (const auto& each : found.ratios)
    add(fmt::format("B{:.6g} life, as a multiple", each.percent), each.of, 1);
  add("probability to outlive one of the other [%]", found.outlives, 100);
  if (found.survival)
    add("survival to " + report.horizon + ", difference [%]", *found.survival, 100);
  return table;
}

std::vector<std::string> notes_of(const LivesAgainstReport& report) {
  std::vector<std::string> notes = {
      "better: the probability that the first is better in this respect"};
  for (const double percent : report.found.without_ratio)
    notes.push_back(fmt::format(
        "B{:.6g} lives have no ratio: for some parameters neither is ever reached.", percent));
  return notes;
}

std::string sentence_of(const LivesAgainstReport& report) {
  return fmt::format("Of the next two, that of {} lives longer with probability {}.", report.name,
                     probability_text(report.found.outlives.mean));
}

std::string distrust(const std::string& of) {
  return fmt::format("Not trusted: a check of the fit of {} failed; its summary names it.", of);
}

}  // namespace

LivesAgainstReport lives_against_report(const LivesAgainstRequest& request, const NamedState& life,
                                        const NamedState& other, Models models) {
  const double confidence = request.confidence.empty() ? 0.9 : confidence_of(request.confidence);
  const FoundLife a(life, request.unit, models), b(other, request.unit, models);
  LivesAgainstReport report{life.name, a.of, b.of};
  report.unit = a.life.request->unit;
  refuse_other_dimension(report.unit, b.life.request->unit);
  std::optional<double> use;
  if (!request.horizon.empty()) {
    report.horizon = request.horizon;
    report.use = along_life("--horizon", request.horizon, report.unit.text);
    use = report.unit.scale * report.use;
  }
  if (!life.state.trusted) report.not_trusted.push_back(a.of);
  if (!other.state.trusted) report.not_trusted.push_back(b.of);
  report.found = lives_against({a.life, life.state.posterior}, {b.life, other.state.posterior},
                               confidence, use);
  return report;
}

std::string lives_against_text(const LivesAgainstReport& report) {
  std::string text;
  for (const std::string& of : report.not_trusted) text += distrust(of) + "\n";
  text += fmt::format("Life of {}\nagainst {}\n\n{}", report.of, report.against,
                      present::text(against_table(report)));
  for (const std::string& note : notes_of(report)) text += "  " + note + "\n";
  return text + sentence_of(report) + "\n";
}

std::vector<present::Section> lives_against_sections(const LivesAgainstReport& report) {
  present::Section section{"against", "Comparison of lives"};
  for (const std::string& of : report.not_trusted)
    section.add(present::Callout{"fail", "Not trusted", distrust(of)});
  section.add(present::Prose{sentence_of(report), true});
  section.add(present::Prose{fmt::format("Life of {}, against {}.", report.of, report.against)});
  section.add(against_table(report));
  for (const std::string& note : notes_of(report)) section.add(present::Prose{note});
  return {section};
}

ordered_json lives_against_json(const LivesAgainstReport& report) {
  const LivesAgainst& found = report.found;
  ordered_json json = {{"of", report.of},
                       {"against", report.against},
                       {"trusted", report.not_trusted.empty()},
                       {"confidence", found.confidence},
                       {"outlives", value_json(found.outlives)},
                       {"ratios", ordered_json::array()},
                       {"without_ratio", found.without_ratio}};
  for (const auto& each : found.ratios) {
    ordered_json ratio = value_json(each.of);
    ratio["percent"] = each.percent;
    json["ratios"].push_back(std::move(ratio));
  }
  if (found.survival) {
    json["survival_difference"] = value_json(*found.survival);
    json["survival_difference"]["at"] = report.use;
    json["survival_difference"]["unit"] = report.unit.text;
  }
  return json;
}

}  // namespace wearwell::prognosis
