#include "wearwell/in_service/lives_fleet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stoppable.h"
#include "wearwell/in_service/conditions.h"
#include "wearwell/in_service/horizons.h"
#include "wearwell/in_service/lives_fleet_report.h"
#include "wearwell/in_service/readings_fleet.h"
#include "wearwell/in_service/unit_rows.h"
#include "wearwell/input/option_value.h"
#include "wearwell/prognosis/named_life.h"
#include "wearwell/prognosis/quantity_like.h"
#include "wearwell/prognosis/required_lives.h"
#include "wearwell/prognosis/result_lives.h"
#include "wearwell/prognosis/study_lives.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::in_service {
namespace {

// A study without lives, with what works for it.
std::vector<prognosis::NamedLife> lives_named(const PosteriorStudy& study,
                                              const std::string& result) {
  try {
    return prognosis::required_lives(study, result);
  } catch (const InputError& error) {
    if (study.model != "formula") throw;
    throw InputError(
        fmt::format("{}; or compute a value of the formula for every row of a table of readings: "
                    "wearwell export sql {}",
                    error.what(), result));
  }
}

// The message of a study that was read with other conditions, without its place in the text.
std::string first_line(const std::string& message) {
  return message.substr(0, message.find('\n'));
}

// The lives of each set of conditions.
struct SetLives {
  std::vector<prognosis::PopulationLives> each;
  std::string noun;
};

SetLives lives_of_sets(const prognosis::CarriedState& state, const PosteriorStudy& study,
                       const std::string& result, Models models, const std::string& point,
                       const std::vector<ConditionSet>& sets, const std::string& source) {
  SetLives lives;
  for (const ConditionSet& set : sets) {
    std::unique_ptr<const Study> other;
    try {
      if (!set.given.empty()) {
        Source asked = state.source;
        asked.study = with_conditions(state.source.study, set.given);
        other = read_study(asked, models);
      }
      prognosis::KnownLives known = prognosis::lives_of_study(
          other ? require_posterior_study(*other) : study, state.posterior, result, state.trusted,
          set.life.empty() ? point : set.life);
      lives.noun = sets.size() == 1 || lives.noun == known.noun || lives.noun.empty()
                       ? known.noun
                       : std::string("unit");
      lives.each.push_back(std::move(known.fresh));
    } catch (const InputError& error) {
      if (set.description.empty()) throw;
      throw InputError(fmt::format("{}: unit {}, {}: {}", source, set.first, set.description,
                                   first_line(error.what())));
    }
  }
  return lives;
}

// Units that the study follows by readings of their own have better forecasts.
void refuse_followed(const prognosis::Tracker& tracker, const UnitRows& rows,
                     const std::string& result, const std::string& source) {
  const auto seen = tracker.seen();
  const std::set<std::string> known(seen.begin(), seen.end());
  for (const std::string& each : rows.names)
    if (known.count(each))
      throw InputError(fmt::format(
          "{}: unit {} has readings in the study, which its age alone leaves out: wearwell life {} "
          "--unit '{}' uses them, and so does a table of readings. Give the units without "
          "readings, or "
          "rename it if it is another",
          source, each, result, each));
}

void refuse_too_old(const UnitRows& rows, const std::vector<prognosis::PopulationLives>& lives,
                    const UnitColumns& columns, const std::string& source) {
  std::vector<double> oldest(lives.size(), 0);
  for (std::size_t u = 0; u < rows.units.count(); ++u) {
    const std::size_t group = rows.units.group[u];
    const double age = rows.units.age[u];
    if (age <= oldest[group]) continue;
    oldest[group] = age;
    if (!prognosis::some_survive(lives[group], age))
      throw InputError(fmt::format("{}: unit {}: by this study no unit survives to age {:.6g} {}",
                                   source, rows.names[u], from_si(columns.age.unit, age),
                                   columns.age.unit.text));
  }
}

// Work deep in the library, on so many threads and until a stop is requested.
void on_threads(const Monitor& monitor, const std::function<void()>& work) {
  tbb::task_arena arena(monitor.threads > 0 ? monitor.threads : tbb::task_arena::automatic);
  arena.execute([&] { stoppable(monitor.stop, work); });
}

}  // namespace

Result fleet_of_lives(const prognosis::CarriedState& state, const std::string& result,
                      Models models, const std::vector<fleet::Engine*>& engines,
                      const LivesRequest& request, const Monitor& monitor) {
  const std::shared_ptr<const prognosis::Tracker> tracker =
      prognosis::tracker_where_possible(state, models);
  if (tracker && state.model == "formula" && hold_readings(*tracker, engines, request.columns))
    return fleet_of_readings(state, tracker, models, engines, request, monitor);
  const std::unique_ptr<const Study> read = read_study(state.source, models);
  const PosteriorStudy& study = require_posterior_study(*read);
  LivesFindings found;
  found.axis = lives_named(study, result).front().request->unit;
  found.horizons = read_horizons(request.horizons, found.axis);
  const std::vector<Condition> conditions = conditions_of(state.source, study);
  for (fleet::Engine* engine : engines) {
    const UnitColumns columns = read_unit_columns(request.columns, engine->columns(), conditions,
                                                  found.axis, engine->source());
    add_units(
        *engine, columns,
        {.skip_bad = request.skip_bad, .all_in_study = request.in_study, .stop = monitor.stop},
        found.rows);
    found.columns = columns;
    found.engine += (found.engine.empty() ? "" : ", ") + engine->description();
    if (found.layout.empty()) found.layout = engine->layout();
    found.files.push_back(engine->source());
  }
  const std::string source = fmt::format("{}", fmt::join(found.files, ", "));
  if (!request.files.empty()) found.files = request.files;
  if (found.rows.units.count() == 0)
    throw InputError(
        fmt::format("{}: {}", source,
                    found.rows.left_out > 0
                        ? fmt::format("all {:.0f} rows would be left out (the first: {})",
                                      found.rows.left_out, found.rows.first_left_out.front().reason)
                        : "has no rows"));
  refuse_repeated_units(found.rows, source);
  if (tracker) refuse_followed(*tracker, found.rows, result, source);
  SetLives lives;
  on_threads(monitor, [&] {
    lives = lives_of_sets(state, study, result, models, request.point, found.rows.sets, source);
  });
  refuse_too_old(found.rows, lives.each, found.columns, source);
  found.noun = lives.noun;
  found.title = study.title;
  found.fingerprint = prognosis::fingerprint_of(state);
  found.trusted_fit = state.trusted;
  found.longest_seen = longest_seen(state.source, study);
  found.points = lives.each.front().weight.size();
  if (found.horizons.empty()) found.horizons = usual_horizons(lives.each.front(), found.axis);
  on_threads(monitor, [&] {
    found.outlook = prognosis::fleet_outlook(lives.each, found.rows.units, found.horizons);
  });
  return lives_fleet_result(found, request.skip_bad);
}

}  // namespace wearwell::in_service
