#include "wearwell/in_service/readings_fleet.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/base/workers.h"
#include "wearwell/in_service/conditions.h"
#include "wearwell/in_service/horizons.h"
#include "wearwell/in_service/reading_rows.h"
#include "wearwell/in_service/readings_fleet_report.h"
#include "wearwell/prognosis/known_lives.h"
#include "wearwell/prognosis/unit_tracker.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::in_service {
namespace {

using prognosis::FailureTotals;
using prognosis::Tracker;
using prognosis::TrackerUnits;

/// A unit's failure probabilities by horizon and population, and the evidence of its readings.
struct UnitApart {
  std::vector<std::vector<double>> failing;
  std::vector<double> log_likelihood;
};

struct UnitOutlook {
  FollowedUnit unit;
  std::optional<UnitApart> apart = {};  ///< empty: there is only the mixture
};

UnitApart apart_of(const prognosis::InPopulations& in, std::span<const double> horizons) {
  UnitApart apart{{}, in.log_likelihood};
  for (const double horizon : horizons) {
    std::vector<double>& failing = apart.failing.emplace_back();
    for (std::size_t k = 0; k < in.passed.size(); ++k) {
      const bool certain = in.passed[k] >= 1 || in.remaining[k].points().empty();
      failing.push_back(
          certain ? 1
                  : std::clamp(in.passed[k] + (1 - in.passed[k]) * in.remaining[k].cdf(horizon),
                               0.0, 1.0));
    }
  }
  return apart;
}

UnitOutlook followed(const std::shared_ptr<const Tracker>& tracker, UnitReadings&& readings,
                     std::span<const double> horizons) {
  prognosis::UnitTracker unit(tracker, readings.unit, !readings.of_study);
  UnitOutlook outlook;
  FollowedUnit& found = outlook.unit;
  for (const prognosis::RowOutcome& each : unit.update(std::move(readings.readings))) {
    if (each.repeated) continue;
    ++found.readings;
    found.contradicting += each.result.counted && each.result.contradicts;
    found.refused += !each.result.counted;
    if (!each.result.counted) found.problem = each.result.problem;
  }
  const TrackerUnits reported(*tracker);
  const prognosis::Forecast now = unit.forecast();
  found.name = printable(readings.unit);
  found.of_study = readings.of_study;
  found.known = !std::isnan(now.passed);
  found.doubt = unit.watch().reason();
  found.beyond = unit.watch().is_beyond();
  if (!found.known) return outlook;
  found.at = reported.at(now.now);
  found.level = reported.level(now);
  found.remaining = reported.remaining(now);
  found.b10 = reported.b10(now);
  found.passed = std::clamp(now.passed, 0.0, 1.0);
  for (const double each : horizons) found.failing.push_back(prognosis::risk_within(now, each));
  if (const auto in = unit.in_populations()) outlook.apart = apart_of(*in, horizons);
  return outlook;
}

/// Follows units on all threads, some hundred at a time, and sums up their failures in their order.
class Followed {
 public:
  Followed(std::shared_ptr<const Tracker> tracker, std::vector<double> horizons,
           const Monitor& monitor)
      : tracker_(std::move(tracker)),
        horizons_(std::move(horizons)),
        monitor_(monitor),
        prior_(tracker_->populations()),
        shared_(horizons_.size(), prior_.size()),
        alone_(horizons_.size(), 1),
        log_likelihood_(prior_.size(), 0) {}

  void add(UnitReadings&& unit) {
    constexpr std::size_t at_once = 512;
    waiting_.push_back(std::move(unit));
    if (waiting_.size() == at_once) follow();
  }

  void finish(ReadingsFindings& found) {
    follow();
    found.units = std::move(units_);
    found.points = prior_.size();
    if (prior_.size() < 2) {
      found.why = "these lives do not separate what units have in common";
    } else if (!not_apart_.empty()) {
      found.why = fmt::format("there is no forecast by population for {} '{}'", tracker_->noun(),
                              not_apart_);
    } else {
      found.population = prognosis::weights_given(prior_, log_likelihood_);
      if (!found.population.resolved)
        found.why = fmt::format(
            "the readings are more evidence on the population than its {} points resolve "
            "(effective "
            "number {:.1f})",
            prior_.size(), found.population.effective);
    }
    const std::vector<double> one = {1};
    for (std::size_t h = 0; h < horizons_.size(); ++h)
      found.failures.push_back(found.why.empty() ? shared_.failures(h, found.population.weight)
                                                 : alone_.failures(h, one));
  }

 private:
  void follow() {
    std::vector<UnitOutlook> outlooks(waiting_.size());
    const auto signal = std::make_shared<StopSignal>();
    signal->requested = monitor_.stop;
    run_tasks(static_cast<int>(waiting_.size()), threads_or_all(monitor_.threads), [&](int i) {
      const StopScope scope(signal);
      check_stop();
      const auto place = static_cast<std::size_t>(i);
      outlooks[place] = followed(tracker_, std::move(waiting_[place]), horizons_);
    });
    waiting_.clear();
    for (UnitOutlook& each : outlooks) count(std::move(each));
  }

  void count(UnitOutlook&& outlook) {
    if (outlook.unit.known) {
      std::vector<std::vector<double>> alone;
      for (const double each : outlook.unit.failing) alone.push_back({each});
      alone_.add(alone, 1);
      alone_.keep(alone);
      if (!outlook.apart && not_apart_.empty()) not_apart_ = outlook.unit.name;
      if (outlook.apart && prior_.size() > 1) {
        shared_.add(outlook.apart->failing, 1);
        shared_.keep(outlook.apart->failing);
        for (std::size_t k = 0; k < prior_.size(); ++k)
          log_likelihood_[k] += outlook.apart->log_likelihood[k];
      }
    }
    units_.push_back(std::move(outlook.unit));
  }

  const std::shared_ptr<const Tracker> tracker_;
  const std::vector<double> horizons_;
  const Monitor& monitor_;
  const std::vector<double> prior_;
  FailureTotals shared_, alone_;
  std::vector<double> log_likelihood_;
  std::string not_apart_;
  std::vector<UnitReadings> waiting_;
  std::vector<FollowedUnit> units_;
};

void refuse_options_of_ages(const LivesRequest& request) {
  if (request.in_study)
    throw InputError(
        "--in-study: is for ages; in a table of readings, rows of the study are recognized");
  if (!request.point.empty())
    throw InputError("--at: is for ages; readings lead to the threshold of the study");
}

}  // namespace

bool hold_readings(const Tracker& tracker, const std::vector<fleet::Engine*>& engines,
                   const std::vector<std::string>& columns) {
  std::vector<std::string> with, without;
  for (fleet::Engine* engine : engines)
    (has_readings(columns, engine->columns(), tracker) ? with : without)
        .push_back(engine->source());
  if (!with.empty() && !without.empty())
    throw InputError(fmt::format("{} has readings, and {} has not: give tables of one kind",
                                 with.front(), without.front()));
  return !with.empty();
}

Result fleet_of_readings(const prognosis::CarriedState& state,
                         std::shared_ptr<const Tracker> tracker, Models models,
                         const std::vector<fleet::Engine*>& engines, const LivesRequest& request,
                         const Monitor& monitor) {
  refuse_options_of_ages(request);
  ReadingsFindings found;
  found.axis = tracker->axis().unit;
  found.level = tracker->limit().unit;
  found.horizons = read_horizons(request.horizons, found.axis);
  if (found.horizons.empty())
    found.horizons =
        usual_horizons(prognosis::lives_of_new(*tracker, "", state.trusted).fresh, found.axis);
  const StudyReadings study(*tracker, state.source);
  Followed units(tracker, found.horizons, monitor);
  ReadingRows rows;
  for (fleet::Engine* engine : engines) {
    const ReadingColumns columns =
        read_reading_columns(request.columns, engine->columns(), *tracker, engine->source());
    for_each_unit(*engine, columns, *tracker, study,
                  {.skip_bad = request.skip_bad, .stop = monitor.stop}, rows,
                  [&](UnitReadings&& unit) { units.add(std::move(unit)); });
    found.engine += (found.engine.empty() ? "" : ", ") + engine->description();
    if (found.layout.empty()) found.layout = engine->layout();
    found.files.push_back(engine->source());
  }
  units.finish(found);
  const std::string source = fmt::format("{}", fmt::join(found.files, ", "));
  if (!request.files.empty()) found.files = request.files;
  if (found.units.empty())
    throw InputError(fmt::format(
        "{}: {}", source,
        rows.left_out > 0 ? fmt::format("all {:.0f} rows would be left out (the first: {})",
                                        rows.left_out, rows.first_left_out.front().reason)
                          : "has no rows"));
  const std::unique_ptr<const Study> read = read_study(state.source, models);
  const PosteriorStudy& posterior_study = require_posterior_study(*read);
  found.title = posterior_study.title;
  found.longest_seen = longest_seen(state.source, posterior_study);
  found.noun = tracker->noun().empty() ? "unit" : tracker->noun();
  found.axis_name = tracker->axis().name;
  found.limited = tracker->limited();
  found.limit = tracker->limit().value;
  found.fingerprint = prognosis::fingerprint_of(state);
  found.trusted_fit = state.trusted;
  found.in_study = rows.in_study;
  found.rows = std::move(rows);
  return readings_fleet_result(found, request.skip_bad);
}

}  // namespace wearwell::in_service
