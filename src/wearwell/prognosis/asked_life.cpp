#include "wearwell/prognosis/asked_life.h"

#include <fmt/format.h>

#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/option_value.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/prognosis/tracked_life.h"

namespace wearwell::prognosis {
namespace {

// The name of a part may also be that of a stress.
void refuse_two_meanings(const CarriedState& state, const std::string& name,
                         const std::string& asked) {
  if (name != asked) return;  // "part shaft"
  const auto predict = TomlReader::parse(state.source.study).table("predict");
  const auto stresses = predict ? predict->table("stress") : std::nullopt;
  if (stresses && stresses->has(name))
    throw InputError(
        fmt::format("--unit: '{0}' is both a part of the data and a stress of [predict.stress]: "
                    "write 'part {0}' for the part, or rename the stress",
                    printable(name)));
}

double tolerated_risk(const std::string& text) {
  const double risk = option_value("--risk", text, "1", Allowed::positive);
  if (!(risk < 1)) throw InputError(fmt::format("--risk: {} must lie between 0 and 1", text));
  return risk;
}

}  // namespace

void require_posterior(const CarriedState& state, const std::string& result) {
  if (state.parameters.empty())
    throw InputError(
        fmt::format("{}: a clutch campaign has no posterior to carry on. For new data use wearwell "
                    "update; for the life of a plate wearwell clutch life; to continue its wear "
                    "wearwell clutch predict --state",
                    result));
}

ReadLifeRequest read_life_request(const LifeRequest& request) {
  ReadLifeRequest read;
  LifeQuestion& question = read.question;
  question.unit = printable(request.unit);  // read as tables are
  if (!request.survived.empty()) question.survived = request.survived;
  if (!request.horizon.empty()) question.horizon = request.horizon;
  if (!request.risk.empty()) question.risk = tolerated_risk(request.risk);
  read.bounds = read_life_bounds(request.level, request.sides);
  const double below = read.bounds.levels.below();
  if (read.bounds.asked) question.shares = {below, 1 - below};
  return read;
}

std::optional<AskedPart> asked_part(const CarriedState& state, const std::string& result,
                                    Models models, const std::string& unit) {
  if (state.model != "sn" || unit.empty()) return {};
  auto tracker = required_tracker(state, models, result);
  const auto name = tracked_name(*tracker, unit);
  if (!name) return {};
  refuse_two_meanings(state, *name, unit);
  return AskedPart{std::move(tracker), *name};
}

UnitLife asked_life(const CarriedState& state, const std::string& result, Models models,
                    const LifeQuestion& question) {
  if (const auto part = asked_part(state, result, models, question.unit))
    return tracked_life(*part->tracker, part->name, question);
  const ReadAsked read = [&](const Source& source) { return read_study(source, models); };
  return unit_life(state.source, read, state.posterior, question);
}

}  // namespace wearwell::prognosis
