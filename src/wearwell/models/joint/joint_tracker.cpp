#include "wearwell/models/joint/joint_tracker.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <span>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/infer/fit.h"
#include "wearwell/math/constants.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/models/joint/joint_study.h"
#include "wearwell/predict/thinned_posterior.h"
#include "wearwell/prognosis/node_tracker.h"
#include "wearwell/study/inference_data.h"

namespace wearwell::joint {
namespace {

using prognosis::NodeCloud;
using prognosis::Reading;

constexpr std::size_t points = 2000;

// One inspection, in SI.
struct Inspection {
  double cycles = 0, work = 0, volume = 0;
};

// What readings have besides cycles and volume, and the known future cycles.
struct Followed {
  Archard law;
  ObservationFamily family;
  JointData data;
  std::vector<Parameter> parameters;
  ThinnedPosterior few;
  Quantity limit;
  double rate = 0;  // J per future cycle
  std::vector<prognosis::ReadingColumn> columns;
  std::size_t cycles = 0, volume = 0;
  std::optional<std::size_t> work, force, slip;  // of columns

  Followed(const TomlReader& root, const prognosis::CarriedState& state)
      : family(read_family(root)),
        data(read_joint_data(root, state.source, family)),
        few(state.posterior, points) {
    law = read_law(root, data);
    const auto study = read_posterior_study(root, state.source, read_joint_study);
    parameters = require_posterior_study(*study).parameters;
    read_limit(root);
    for (const DataColumn& each : data.columns) {
      if (each.name == "dx" || each.name == "dy")
        root.required_table("data").required_table("columns").fail(
            each.name,
            "has many rows per inspection, which cannot be tracked one by one: add them with "
            "wearwell update, or give data.columns.volume");
      if (each.name == "cycles") cycles = columns.size();
      if (each.name == "volume") volume = columns.size();
      if (each.name == "work") work = columns.size();
      if (each.name == "force") force = columns.size();
      if (each.name == "slip") slip = columns.size();
      columns.push_back({each.name, each.unit, each.name == "volume"});
      // A counted axis needs its name beside the unit, even for plain numbers.
      if (each.name == "cycles" && each.unit.text == "1") columns.back().unit.text = "cycles";
    }
  }

  void read_limit(const TomlReader& root) {
    const auto predict = root.table("predict");
    const auto wanted = predict ? predict->quantity("limit", "m^3") : std::nullopt;
    if (!wanted)
      root.fail(
          "predict",
          "needs limit: the failure threshold of the volume, towards which a joint is tracked");
    limit = *wanted;
    const auto to_come = predict->quantity("work_per_cycle", "N m/cycle");
    rate = data.work_per_cycle ? *data.work_per_cycle : to_come ? to_come->si() : 0;
  }

  // Why this is not an inspection; empty if it is one.
  std::string read(const Reading& reading, Inspection& inspection) const {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double x = reading.numbers[c];
      if (std::isnan(x)) return fmt::format("{} is missing", columns[c].name);
      if (!std::isfinite(x)) return fmt::format("{} is not finite", columns[c].name);
      if (c != volume && x < 0) return fmt::format("{} must be 0 or more", columns[c].name);
    }
    inspection.cycles = reading.numbers[cycles];
    inspection.volume = reading.numbers[volume];
    inspection.work = work    ? reading.numbers[*work]
                      : force ? reading.numbers[*force] * reading.numbers[*slip]
                              : inspection.cycles * *data.work_per_cycle;
    if (family == ObservationFamily::lognormal && !(inspection.volume > 0 && inspection.work > 0))
      return "work and volume must be positive for the lognormal likelihood";
    return {};
  }

  // The farthest inspection of the study and of `reading`.
  Inspection last(const Reading* reading) const {
    Inspection farthest;
    for (std::size_t i = 0; i < data.cycles.size(); ++i) {
      if (data.cycles[i] >= farthest.cycles)
        farthest = {data.cycles[i], data.inspections.work[i], data.inspections.volume[i]};
    }
    Inspection own;
    if (reading && read(*reading, own).empty() && own.cycles >= farthest.cycles) farthest = own;
    return farthest;
  }
};

NodeCloud cloud(const ThinnedPosterior& few) {
  NodeCloud cloud{few.values, {}};
  for (const double each : few.weights) cloud.log_weight.push_back(std::log(each));
  return cloud;
}

// Without readings the saved posterior; otherwise that of all inspections, integrated again.
NodeCloud rebuild(const Followed& joint, std::span<const Reading> readings) {
  if (readings.empty()) return cloud(joint.few);
  Inspections all = joint.data.inspections;
  for (const Reading& each : readings) {
    Inspection inspection;
    if (!joint.read(each, inspection).empty()) continue;
    all.work.push_back(inspection.work);
    all.volume.push_back(inspection.volume);
  }
  const Posterior posterior(joint.parameters,
                            archard_likelihood(joint.law, joint.family, all, all.work.size()));
  FitSettings settings;
  settings.method = Method::exact;
  const Fit fitted = fit(posterior, settings);
  if (!proper(fitted)) return {};
  return cloud(ThinnedPosterior(fitted.exact ? fitted.exact->nodes : fitted.pooled, points));
}

prognosis::NodeReading reading_distribution(const Followed& joint, const Reading& reading) {
  Inspection inspection;
  joint.read(reading, inspection);
  const bool normal = joint.family == ObservationFamily::normal;
  const double at = normal ? inspection.volume : std::log(inspection.volume);
  return {
      [=, law = joint.law, family = joint.family](const double* x) {
        return log_density(family, at, law.mean_volume(x, inspection.work), x[1]);
      },
      [=, law = joint.law, family = joint.family](const double* x) {
        return ObservationDistribution(family, law.mean_volume(x, inspection.work), x[1]).cdf(at);
      }};
}

prognosis::DegradationPath degradation_path(const Followed& joint, const Reading* last) {
  const Inspection now = joint.last(last);
  return {now.cycles,
          [now, law = joint.law, rate = joint.rate, limit = joint.limit.si()](const double* x) {
            const double work = law.work_at(x, limit);
            return work <= now.work ? now.cycles : now.cycles + (work - now.work) / rate;
          },
          [now, law = joint.law, rate = joint.rate](const double* x, double at) {
            return law.mean_volume(x, now.work + (at - now.cycles) * rate);
          }};
}

}  // namespace

std::unique_ptr<const prognosis::Tracker> track_joint(const prognosis::CarriedState& state) {
  const TomlReader root = TomlReader::parse(state.source.study);
  const auto joint = std::make_shared<const Followed>(root, state);
  std::vector<std::string> names;
  for (const Parameter& each : joint->parameters) names.push_back(each.name);
  prognosis::require_parameters(state, names);
  prognosis::NodeModel model;
  model.columns = joint->columns;
  model.axis = joint->cycles;
  model.limited = "volume";
  model.noun = "joint";
  model.limit = joint->limit;
  model.seen = {joint->data.name};
  model.fingerprint = prognosis::population_fingerprint(state);
  model.refusal = [only = joint->data.name](const std::string& unit) {
    return unit == only
               ? std::string()
               : fmt::format(
                     "the study is of one joint, called '{}' (data.joint), and has no '{}': joints "
                     "with different wear rates need a study of model \"formula\" with "
                     "[random_effects.UNIT]",
                     printable(only), printable(unit));
  };
  model.problem = [joint](const Reading& reading) {
    Inspection inspection;
    return joint->read(reading, inspection);
  };
  model.reading = [joint](const Reading& reading) { return reading_distribution(*joint, reading); };
  model.rebuild = [joint](const std::string&, std::span<const Reading> readings) {
    return rebuild(*joint, readings);
  };
  model.degradation_path = [joint](const std::string&, const Reading* last) {
    return std::optional(degradation_path(*joint, last));
  };
  return prognosis::node_tracker(std::move(model));
}

}  // namespace wearwell::joint
