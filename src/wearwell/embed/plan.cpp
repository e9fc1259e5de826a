#include "wearwell/embed/readers.h"

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/embed/fitted.h"
#include "wearwell/input/option_value.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/next_point.h"
#include "wearwell/models/registry.h"
#include "wearwell/plan/accelerate.h"
#include "wearwell/plan/demonstrate.h"
#include "wearwell/plan/inspect.h"
#include "wearwell/plan/next_question.h"
#include "wearwell/plan/size.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/decision_request.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/life_text.h"
#include "wearwell/prognosis/lives_against_report.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/prognosis/next_reading.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/study/model.h"

namespace wearwell::embed {
namespace {

std::unique_ptr<const Study> read_any(const Source& source) {
  return read_study(source, all_models());
}

prognosis::CarriedState carried_posterior(const Subject& subject) {
  prognosis::CarriedState state = state_of({subject.run, subject.path});
  if (state.parameters.empty())
    throw InputError("the fit has no posterior to plan with: a clutch campaign has none");
  return state;
}

Source source_for(const Subject& subject) {
  return subject.study ? *subject.study->source : source_of(subject.path);
}

Work size(PlanArguments& arguments, const Subject& subject, const Monitor& monitor) {
  plan::SizeQuestion question;
  arguments.text("goal", question.goal);
  arguments.text("width", question.width);
  arguments.table("tests");
  arguments.text("assurance", question.assurance);
  arguments.text("level", question.level);
  arguments.text("measure", question.measure);
  arguments.whole("most", question.most, 1, 100'000);
  arguments.whole("simulations", question.simulations, 20, 100'000);
  arguments.seed("seed", question.seed);
  const Table* const tests = table_of(subject, "tests");
  if (!tests) throw InputError("tests is missing: a table with a row for each test");
  return [question, tests, &subject, monitor] {
    return plan::size(question, source_for(subject), *tests, &read_any, monitor);
  };
}

Work demonstrate(PlanArguments& arguments, const Subject&, const Monitor&) {
  plan::DemonstrateQuestion question;
  arguments.text("goal", question.goal);
  arguments.text("confidence", question.confidence);
  arguments.text("failures", question.failures);
  arguments.text("distribution", question.distribution);
  arguments.text("shape", question.shape);
  arguments.text("sigma", question.sigma);
  arguments.whole("specimens", question.specimens);
  arguments.text("time", question.time);
  arguments.texts("truth", question.truth);
  arguments.whole("sudden_death", question.sudden_death);
  arguments.call_option("GOAL", "goal");
  arguments.call_option("--true", "truth");
  return [question] { return plan::demonstrate(question); };
}

// The lives that inspections and replacements are planned for, and the units that they are of.
struct Lives {
  std::unique_ptr<const prognosis::Tracker> tracker;
  prognosis::KnownLives lives;
  prognosis::FollowedUnits followed;
};

Lives lives_of(const Subject& subject, const std::string& point) {
  Lives result;
  const Table* table = table_of(subject, "lives");
  const bool is_result = !table && (subject.run || std::filesystem::is_directory(subject.path));
  if (!point.empty() && !is_result)
    throw InputError("at names a life of a study; only a fit or its folder has one");
  const Table* const in_service = table_of(subject, "in_service");
  if (in_service && !is_result)
    throw InputError("in_service: a table of lives has its running units in rows with `unit`");
  if (table) {
    result.lives = prognosis::lives_of_table(*table);
    return result;
  }
  if (!subject.run && std::filesystem::path(subject.path).extension() == ".toml")
    throw InputError(
        fmt::format("{}: questions about the units of a monitor are for the command line (wearwell "
                    "plan inspect, "
                    "wearwell decide)",
                    printable(subject.path)));
  if (!is_result) {
    result.lives = prognosis::lives_of_table(read_table(subject.path));
    return result;
  }
  const std::string title = subject.run ? subject.run->result->header.title : subject.path;
  prognosis::ResultLives found =
      prognosis::lives_of_result(carried_posterior(subject), all_models(), title, point);
  if (in_service) prognosis::add_units_in_service(found, *in_service);
  result.tracker = std::move(found.tracker);
  result.lives = std::move(found.lives);
  if (result.tracker) result.followed = prognosis::units_of_study(*result.tracker);
  return result;
}

Work inspect(PlanArguments& arguments, const Subject& subject, const Monitor& monitor) {
  plan::InspectQuestion question;
  std::string point;
  arguments.text("at", point);
  arguments.text("risk", question.risk);
  arguments.text("total_risk", question.total_risk);
  arguments.text("warning", question.warning);
  arguments.text("until", question.until);
  arguments.text("step", question.step);
  arguments.text("unit", question.unit);
  arguments.truth("new", question.fresh);
  arguments.text("inspection_cost", question.inspection_cost);
  arguments.text("failure_cost", question.failure_cost);
  arguments.text("replacement_cost", question.replacement_cost);
  arguments.text("downtime_cost", question.downtime_cost);
  arguments.text("visit_cost", question.visit_cost);
  arguments.texts("given", question.given);
  arguments.table("in_service");
  return [question, point, &subject, monitor] {
    const Lives lives = lives_of(subject, point);
    return plan::inspect(question, lives.lives, lives.followed, monitor);
  };
}

Work decide(PlanArguments& arguments, const Subject& subject, const Monitor&) {
  prognosis::DecisionRequest request;
  std::string point, service;
  std::size_t months = 12;
  arguments.text("at", point);
  arguments.text("failure_cost", request.failure_cost);
  arguments.text("replacement_cost", request.replacement_cost);
  arguments.text("inspection_cost", request.inspection_cost);
  arguments.text("downtime_cost", request.downtime_cost);
  arguments.text("month", request.month);
  arguments.whole("months", months, 1, 600);
  arguments.text("service_level", service);
  arguments.text("claims", request.claims);
  arguments.text("unit", request.unit);
  arguments.text("inspect_after", request.inspect_after);
  arguments.texts("given", request.given);
  arguments.table("in_service");
  request.months = static_cast<int>(months);
  if (!service.empty()) {
    request.service = option_value("service_level", service, "1", Allowed::positive);
    if (!(request.service < 1))
      throw InputError("service_level is " + service + "; it is a share below 1");
  }
  return [request, point, &subject] {
    Lives lives = lives_of(subject, point);
    const prognosis::DecisionsReport report =
        prognosis::decide(request, std::move(lives.lives), lives.followed);
    return plan::Answer{report.lives.title, decisions_text(report), decisions_sections(report),
                        decisions_json(report), report.lives.trusted};
  };
}

// `wearwell life` without readings: that of a new unit or of one of the data.
Work unit_life(PlanArguments& arguments, const Subject& subject, const Monitor&) {
  prognosis::LifeRequest request;
  arguments.text("unit", request.unit);
  arguments.text("survived", request.survived);
  arguments.text("horizon", request.horizon);
  arguments.text("risk", request.risk);
  arguments.text("level", request.level);
  arguments.text("sides", request.sides);
  return [=, &subject] {
    const auto [question, bounds] = prognosis::read_life_request(request);
    const Fitted fit{subject.run, subject.path};
    const prognosis::CarriedState state = state_of(fit);
    prognosis::require_posterior(state, fit.name());
    const prognosis::UnitLife life =
        prognosis::asked_life(state, fit.name(), all_models(), question);
    const std::string text = prognosis::life_text(life, bounds, {}, state.trusted);
    present::Section section{"life", "Life"};
    section.add(present::Verbatim{text});
    section.add(prognosis::survival_table(life));
    return plan::Answer{fit.name(),
                        text,
                        {section},
                        prognosis::life_json(life, bounds, {}, state.trusted),
                        state.trusted};
  };
}

Work against(PlanArguments& arguments, const Subject& subject, const Monitor&) {
  prognosis::LivesAgainstRequest request;
  std::string path;
  arguments.text("other", path);
  arguments.text("at", request.unit);
  arguments.text("horizon", request.horizon);
  arguments.text("confidence", request.confidence);
  arguments.call_option("--unit", "at");
  arguments.call_option("--against", "other");
  return [request, path, &subject] {
    const Fitted fit{subject.run, subject.path}, other{subject.other, path};
    const prognosis::LivesAgainstReport report = prognosis::lives_against_report(
        request, {state_of(fit), fit.name()},
        {state_of(other), subject.other ? std::string("other") : path}, all_models());
    return plan::Answer{report.of + " against " + report.against, lives_against_text(report),
                        lives_against_sections(report), lives_against_json(report),
                        report.not_trusted.empty()};
  };
}

bool is_clutch(const Subject& subject) {
  return subject.run ? subject.run->result->header.model == "clutch-wear"
                     : clutch::is_clutch_result(subject.path);
}

plan::Answer next_point_of(const Subject& subject, const plan::NextQuestion& question) {
  if (!subject.run) return clutch::next_point(subject.path, question);
  const Result& result = *subject.run->result;
  for (const auto& [name, content] : result.files)
    if (name == "model.json")
      return clutch::next_point(clutch::read_model_text(content, "model.json"),
                                result.header.trusted, question);
  throw InputError("the fit holds no model.json to plan with");
}

Work next(PlanArguments& arguments, const Subject& subject, const Monitor&) {
  plan::NextQuestion question;
  arguments.text("goal", question.goal);
  arguments.clauses("grid", question.grid);
  arguments.list("specimens", question.specimens);
  arguments.text("cost", question.cost);
  arguments.number("specimen_cost", question.specimen_cost);
  arguments.number("use_cost", question.use_cost);
  arguments.text("measure", question.measure);
  arguments.text("by", question.by);
  arguments.text("failure_cost", question.failure_cost);
  arguments.text("replacement_cost", question.replacement_cost);
  arguments.text("fleet_use", question.fleet_use);
  arguments.number("value", question.value);
  arguments.number("budget", question.budget);
  arguments.whole("batch", question.batch);
  arguments.text("until", question.until);
  arguments.whole("samples", question.samples);
  arguments.whole("nodes", question.nodes);
  arguments.seed("seed", question.seed);
  arguments.table("candidates");
  std::vector<std::string> files;
  arguments.texts("tests", files);
  if (const Table* candidates = table_of(subject, "candidates")) question.candidates = *candidates;
  question.tests = tables_of(subject, "tests");
  return [question, files, &subject]() mutable {
    if (is_clutch(subject)) {
      for (const std::string& file : files) question.tests.push_back(read_table(file));
      return next_point_of(subject, question);
    }
    prognosis::CarriedState state = carried_posterior(subject);
    for (const std::string& file : files)
      question.tests.push_back(prognosis::read_new_data(state.source, file));
    const std::string result = subject.run ? "fit" : subject.path;
    return plan::next_test(std::move(state), result, &read_any, question);
  };
}

Work accelerate(PlanArguments& arguments, const Subject&, const Monitor&) {
  plan::AccelerateQuestion question;
  arguments.text("goal", question.goal);
  arguments.text("use", question.use);
  arguments.text("highest", question.highest);
  arguments.text("until", question.until);
  arguments.list("stop", question.stop);
  arguments.whole("specimens", question.specimens);
  arguments.text("family", question.family);
  arguments.text("relation", question.relation);
  arguments.text("lowest", question.lowest);
  arguments.text("low", question.low);
  arguments.text("shape", question.shape);
  arguments.text("sigma", question.sigma);
  arguments.text("failing_at_use", question.failing_at_use);
  arguments.text("failing_at_highest", question.failing_at_highest);
  arguments.text("life_at_highest", question.life_at_highest);
  arguments.text("activation_energy", question.activation_energy);
  arguments.text("exponent", question.exponent);
  arguments.text("slope", question.slope);
  arguments.text("middle_share", question.middle_share);
  arguments.whole("least_failures", question.least_failures);
  return [question] { return plan::accelerate(question); };
}

}  // namespace

Reader plan_reader(const std::string& kind) {
  if (kind == "next") return &next;
  if (kind == "size") return &size;
  if (kind == "demonstrate") return &demonstrate;
  if (kind == "accelerate") return &accelerate;
  if (kind == "inspect") return &inspect;
  if (kind == "decide") return &decide;
  if (kind == "against") return &against;
  if (kind == "life") return &unit_life;
  return nullptr;
}

}  // namespace wearwell::embed
