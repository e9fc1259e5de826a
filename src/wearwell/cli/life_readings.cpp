#include "wearwell/cli/life_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/carried.h"
#include "wearwell/prognosis/new_data.h"
#include "wearwell/prognosis/reading_table.h"
#include "wearwell/prognosis/reweighted.h"
#include "wearwell/prognosis/updated_study.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/run_study.h"

namespace wearwell {

prognosis::LifeReadings take_readings(const std::filesystem::path& result,
                                      const std::filesystem::path& readings, Models models,
                                      prognosis::CarriedState& state) {
  const Table table = prognosis::read_new_data(state.source, readings);
  prognosis::JoinedData joined =
      prognosis::joined_data(state.source, {table}, prognosis::Repeated::ask);
  const auto before = read_study(state.source, models), after = read_study(joined.source, models);
  const auto posterior_of = [](const Study& read) {
    const PosteriorStudy& study = require_posterior_study(read);
    return Posterior(study.parameters, study.likelihood(study.data_rows));
  };
  const Posterior of_all = posterior_of(*after);
  const prognosis::Reweighted moved =
      prognosis::reweighted(state.posterior, posterior_of(*before), of_all);
  const PosteriorStudy& study = require_posterior_study(*after);
  prognosis::judge_new_data(study, state.posterior, joined);
  prognosis::LifeReadings done{"", joined.counted, joined.repeated, joined.contradictions};
  state.source = std::move(joined.source);
  if (prognosis::resolves(moved)) {
    done.how = fmt::format("nodes reweighted, effective sample size {:.0f}", moved.effective);
    state.posterior = moved.draws;
    return done;
  }
  const SamplerChoice choice = sampler_of(result);
  const Fit fitted = fit(of_all, fit_settings(study, choice));
  if (!proper(fitted))
    throw InputError(
        "with these readings the posterior has no lives; run wearwell update for the reason");
  state.posterior = fitted.exact ? fitted.exact->nodes : fitted.pooled;
  done.how = "nodes rebuilt";
  return done;
}

prognosis::LifeReadings take_part_readings(const std::filesystem::path& readings,
                                           const prognosis::Tracker& tracker,
                                           const std::string& part, const Source& source,
                                           prognosis::TrackedUnit& unit) {
  const Table table = prognosis::in_study_names(prognosis::read_new_data(source, readings),
                                                tracker.columns(), source);
  std::vector<prognosis::Reading> taken;
  const prognosis::History history = [&](const auto& visit) {
    for (const prognosis::Reading& each : taken) visit(each);
  };
  std::size_t axis = 0;
  while (tracker.columns()[axis].name != tracker.axis().name) ++axis;
  prognosis::LifeReadings since{
      "posterior weighted by its survival; it continues under its last stress"};
  for (prognosis::Reading& each : prognosis::readings_of_unit(tracker, part, table)) {
    const std::size_t row = since.counted + since.repeated;
    const std::string place = fmt::format("{}, {}", table.source, row_name(row + 1, 0));
    if (!taken.empty() && each.numbers[axis] < taken.back().numbers[axis])
      throw InputError(fmt::format(
          "{0}: {1} is {2:.6g} {4}, less than the {3:.6g} {4} of the row before: sort the rows if "
          "{1} counts from the beginning; add them up if it counts from the row before",
          place, tracker.axis().name, from_si(tracker.axis().unit, each.numbers[axis]),
          from_si(tracker.axis().unit, taken.back().numbers[axis]), tracker.axis().unit.text));
    const auto same = [&](const prognosis::Reading& other) {
      return other.numbers == each.numbers && other.labels == each.labels;
    };
    if (std::any_of(taken.begin(), taken.end(), same)) {
      ++since.repeated;
      continue;
    }
    const prognosis::UpdateResult result = unit.update(each, history);
    if (!result.counted) throw InputError(fmt::format("{}: {}", place, printable(result.problem)));
    if (result.contradicts)
      since.contradictions.push_back(
          {row, place,
           fmt::format("survival until then had a probability of {:.2g}", result.p_value)});
    ++since.counted;
    taken.push_back(std::move(each));
  }
  return since;
}

}  // namespace wearwell
