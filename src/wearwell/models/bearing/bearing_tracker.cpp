#include "wearwell/models/bearing/bearing_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>

#include "wearwell/base/error.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/bearing/bearing_ahead.h"
#include "wearwell/models/bearing/bearing_data.h"
#include "wearwell/models/bearing/bearing_study.h"
#include "wearwell/models/bearing/rate_grid.h"
#include "wearwell/models/bearing/reading_rows.h"
#include "wearwell/models/bearing/seen_bearing.h"
#include "wearwell/models/bearing/wear_number.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/node_tracker.h"

namespace wearwell::bearing {
namespace {

using prognosis::Reading;

constexpr std::size_t thinned_posterior = 1000, many_points = 4000, points_alone = 2000;
// of the initial effective number of the few points: below it many points are used
constexpr double least_few = 0.3;

// Curves of one clearance over radius, within a memory limit. Which of them are cached does not
// change results.
class Curves {
 public:
  DepthFunction curve(const Duty& duty) const {
    const std::lock_guard lock(lock_);
    const std::pair key(duty.contact, duty.clearance / duty.radius);
    auto at = curves_.find(key);
    if (at == curves_.end()) {
      if (curves_.size() >= most) curves_.clear();
      at = curves_.emplace(key, std::make_shared<const DepthCurve>(key.first, key.second, from, to))
               .first;
    }
    return {at->second, duty.radius, std::log(duty.pressure * duty.revolutions)};
  }

 private:
  static constexpr std::size_t most = 200;
  // logarithms of wear numbers; beyond them it solves directly
  static constexpr double from = -14, to = 2;
  mutable std::mutex lock_;
  mutable std::map<std::pair<Contact, double>, std::shared_ptr<const DepthCurve>> curves_;
};

// The future conditions and the threshold.
struct Ahead : BearingAhead {
  Quantity limit;
};

Ahead read_ahead(const TomlReader& root, const BearingData& data) {
  const auto predict = root.table("predict");
  const auto limit = predict ? positive_quantity(*predict, "limit", "m") : std::nullopt;
  if (!limit)
    root.fail(
        "predict",
        "needs limit: the failure threshold of the depth, towards which bearings are tracked");
  return {read_bearing_ahead(*predict, data), *limit};
}

struct Population {
  WearModel model;
  BearingData data;
  ReadingRows rows;
  Ahead ahead;
  ThinnedPosterior few, many;
  Curves curves;

  Population(const TomlReader& root, const prognosis::CarriedState& state)
      : model(read_wear_model(root)),
        data(read_bearing_data(root, state.source, model.family)),
        rows(root, data, model.family),
        ahead(read_ahead(root, data)),
        few(state.posterior, model.has_scatter ? thinned_posterior : points_alone),
        many(state.posterior, many_points) {}

  std::optional<std::size_t> number(const std::string& unit) const {
    const auto at = std::find(data.names.begin(), data.names.end(), unit);
    if (at == data.names.end()) return {};
    return static_cast<std::size_t>(at - data.names.begin());
  }

  Inspections seen(const std::string& unit) const {
    const auto at = number(unit);
    return at ? inspections_of(data.inspections, *at) : Inspections{};
  }

  // Its farthest row in the study.
  std::optional<ReadingRow> last_seen(const std::string& unit) const {
    const auto at = number(unit);
    if (!at) return {};
    const std::size_t i = last_inspection(data.inspections, *at);
    const Duty& duty = data.inspections.duty[i];
    ReadingRow last{duty, data.inspections.depth[i], duty.revolutions, {}};
    if (!data.speed.empty()) {
      last.speed = data.speed[i];
      if (rows.in_time()) last.place = duty.revolutions / data.speed[i];
    }
    return last;
  }
};

using Shared = std::shared_ptr<const Population>;

double effective_of(const ThinnedPosterior& points) {
  double square = 0;
  for (const double each : points.weights) square += each * each;
  return 1 / square;
}

std::optional<Inspected> inspected(const Population& population, const Inspections& rows) {
  if (rows.depth.empty()) return {};
  std::vector<DepthFunction> curves;
  for (const Duty& each : rows.duty) curves.push_back(population.curves.curve(each));
  return Inspected(population.model.family, std::move(curves), rows.duty, rows.depth);
}

prognosis::NodeCloud rebuild(const Population& population, const std::string& unit,
                             std::span<const Reading> readings) {
  Inspections rows = population.seen(unit);
  BearingRows own;
  own.seen = inspected(population, rows);
  for (const Reading& each : readings) {
    ReadingRow row;
    if (!population.rows.read(each, row).empty()) continue;
    rows.duty.push_back(row.duty);
    rows.depth.push_back(row.depth);
  }
  own.all = readings.empty() ? own.seen : inspected(population, rows);
  RateGrid grid = rate_grid(population.model, population.few, own);
  if (grid.effective < least_few * effective_of(population.few))
    grid = rate_grid(population.model, population.many, own);
  return std::move(grid.nodes);
}

prognosis::NodeReading reading_distribution(const Population& population, const Reading& reading) {
  ReadingRow row;
  population.rows.read(reading, row);
  const DepthFunction curve = population.curves.curve(row.duty);
  const ObservationFamily family = population.model.family;
  const auto sigma = [model = population.model](const double* node) { return model.sigma(node); };
  const double at = family == ObservationFamily::normal ? row.depth : std::log(row.depth);
  return {[=](const double* node) {
            if (!(node[0] <= curve.limit())) return -infinity;
            return log_density(family, at, curve.depth(node[0]), sigma(node));
          },
          [=](const double* node) {
            if (!(node[0] <= curve.limit())) return 0.0;
            return ObservationDistribution(family, curve.depth(node[0]), sigma(node)).cdf(at);
          }};
}

std::optional<prognosis::DegradationPath> degradation_path(const Shared& population,
                                                           const std::string& unit,
                                                           const Reading* reading) {
  const Ahead& ahead = population->ahead;
  std::optional<ReadingRow> last = population->last_seen(unit);
  ReadingRow row;
  if (reading && population->rows.read(*reading, row).empty() &&
      (!last || row.place >= last->place))
    last = row;
  GoingOn going;
  const double own_speed = last ? last->speed.value_or(0) : 0;
  const double speed = ahead.speed ? ahead.speed->si() : own_speed;
  if (last) {
    going.now = last->duty;
    going.begin = last->place;
  } else {
    if (!ahead.contact || !ahead.radius || !ahead.clearance || !ahead.pressure) return {};
    going.now = {*ahead.contact, ahead.radius->si(), ahead.clearance->si(), ahead.pressure->si(),
                 0};
  }
  if (population->rows.in_time()) {
    if (!(speed > 0)) return {};
    going.per_turn = 1 / speed;
  }
  going.pressure = ahead.pressure ? ahead.pressure->si() : going.now.pressure;
  const Duty& duty = going.now;
  try {
    going.wear_number =
        wear_number(duty.contact, duty.clearance / duty.radius, ahead.limit.si() / duty.radius);
  } catch (const InputError&) {
    return {};  // it is worn through before
  }
  Duty one = duty;
  one.pressure = one.revolutions = 1;
  const DepthFunction curve = population->curves.curve(one);
  return prognosis::DegradationPath{
      going.begin, [going](const double* node) { return life_at(going, node[0]); },
      [going, curve](const double* node, double at) {
        const double loading = going.now.pressure * going.now.revolutions +
                               going.pressure * (at - going.begin) / going.per_turn;
        if (!(loading > 0)) return 0.0;
        return curve.depth(std::min(node[0] + std::log(loading), curve.limit()));
      }};
}

}  // namespace

std::unique_ptr<const prognosis::Tracker> track_bearings(const prognosis::CarriedState& state) {
  const TomlReader root = TomlReader::parse(state.source.study);
  const auto population = std::make_shared<const Population>(root, state);
  std::vector<std::string> names = {"k"};
  if (!population->model.depth_error) names.emplace_back("sigma");
  if (population->model.has_scatter) names.emplace_back("k_scatter");
  prognosis::require_parameters(state, names);
  prognosis::NodeModel model;
  model.columns = population->rows.columns();
  model.labels = population->rows.labels();
  model.axis = population->rows.axis();
  model.limited = "depth";
  model.noun = "bearing";
  model.limit = population->ahead.limit;
  model.seen = population->data.names;
  model.fingerprint = prognosis::population_fingerprint(state);
  model.refusal = [](const std::string&) { return std::string(); };
  model.problem = [population](const Reading& reading) {
    ReadingRow row;
    return population->rows.read(reading, row);
  };
  model.reading = [population](const Reading& reading) {
    return reading_distribution(*population, reading);
  };
  model.rebuild = [population](const std::string& unit, std::span<const Reading> readings) {
    return rebuild(*population, unit, readings);
  };
  model.degradation_path = [population](const std::string& unit, const Reading* last) {
    return degradation_path(population, unit, last);
  };
  return prognosis::node_tracker(std::move(model));
}

}  // namespace wearwell::bearing
