#include "wearwell/models/formula_model/formula_path_ahead.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/formula_limit.h"
#include "wearwell/models/formula_model/formula_process_spread.h"
#include "wearwell/models/formula_model/formula_spread.h"
#include "wearwell/models/formula_model/formula_unit_draws.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::formula_model {
namespace {

constexpr std::size_t most_points = 500, most_points_solved = 200;

// A path for any thread.
class SharedPath {
 public:
  explicit SharedPath(std::shared_ptr<const Path> path) : path_(std::move(path)) {}
  PathAt& mine() const {
    std::unique_ptr<PathAt>& own = own_.local();
    if (!own) own = std::make_unique<PathAt>(*path_);
    return *own;
  }

 private:
  std::shared_ptr<const Path> path_;
  mutable tbb::enumerable_thread_specific<std::unique_ptr<PathAt>> own_;
};

// Location and scatter of a family at a point of the posterior.
using Outputs = std::function<std::pair<double, double>(const double* x, double z)>;

PredictionRequest measurement(const Asked& asked, const Measured& measured, double place,
                              const Outputs& outputs) {
  const ResponseFamily family = measured.form->family;
  // The mean and standard deviation of the column itself.
  const auto moments = [=](const double* x, double z) {
    auto [mean, sd] = outputs(x, z);
    if (family == ResponseFamily::lognormal) {
      mean *= std::exp(0.5 * sd * sd);
      sd = mean * std::sqrt(std::expm1(sd * sd));
    }
    return std::pair(mean, sd);
  };
  PredictionRequest prediction{
      *asked.model->along,
      from_si(asked.axis().unit.unit, place),
      measured.column,
      measured.unit,
      [=](const double* x) { return moments(x, 0).first; },
      [=](const double* x) { return moments(x, 0).second; },
      family == ResponseFamily::normal ? ObservationFamily::normal : ObservationFamily::lognormal,
      {}};
  const std::string& unit = asked.axis().unit.unit.text;
  if (unit != "1" && unit != prediction.at_name) prediction.at_unit = unit;
  if (asked.model->has_random_effects()) {
    prediction.item = [=](const double* x, double z) { return moments(x, z).first; };
    prediction.mean_of = "median " + asked.noun;
    prediction.measured_of = "new " + asked.noun;
  }
  return prediction;
}

void add_measurement(const Asked& asked, const Measured& measured, std::shared_ptr<const Path> path,
                     double place, PosteriorStudy& study) {
  const auto shared = std::make_shared<const SharedPath>(std::move(path));
  study.predictions.push_back(measurement(asked, measured, place, [=](const double* x, double z) {
    PathAt& mine = shared->mine();
    mine.move_to(x);
    mine.evaluate(1, &z, &place);
    return std::pair(mine.output(0, 0), mine.output(1, 0));
  }));
}

// One thread's forecast of a unit of the study. Up to its last row the distribution is that of the
// likelihood; beyond, if conditions change, its path continues from its present value.
class UnitAt {
 public:
  UnitAt(const LimitedPath& axis, const LimitedPath::SeenUnit& seen)
      : seen_(seen), ahead_(*seen.ahead, axis.rising, axis.begin, axis.scale) {
    if (seen.behind) behind_.emplace(*seen.behind);
  }

  std::pair<double, double> outputs(const double* x, const double* z, double place) {
    PathAt& at = ahead_.at();
    at.move_to(x);
    if (behind_ && place > seen_.now) {
      behind_->move_to(x);
      behind_->evaluate(1, z, &seen_.now);
      const double level = behind_->output(0, 0);
      double there = 0;
      ahead_.solve(1, z, &level, &there);
      place += there - seen_.now;
    }
    if (seen_.ahead->goes_on()) at.stand(1, z);
    at.evaluate(1, z, &place);
    return {at.output(0, 0), at.output(1, 0)};
  }

 private:
  const LimitedPath::SeenUnit& seen_;
  Crossing ahead_;
  std::optional<PathAt> behind_;
};

// Future measurements of the units of predict.units.
void add_units(const Asked& asked, const Measured& measured, const std::vector<Quantity>& places,
               const LimitedPath& axis, PosteriorStudy& study) {
  const std::vector<std::string>& known = asked.model->units;
  for (const std::string& name : asked.predict.texts("units")) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (!asked.model->has_random_effects() || !asked.model->label) {
      asked.predict.fail("units", "needs a study with random effects (varies)");
    }
    if (found == known.end()) {
      asked.predict.fail("units", fmt::format("the data have no {} '{}' ({})", asked.noun, name,
                                              fmt::join(known, ", ")));
    }
    if (measured.process) {
      asked.predict.fail(
          "units", fmt::format("{} is a process: its continuation in each {} is among the "
                               "quantities at predict.at; its future readings are not predicted",
                               measured.column, asked.noun));
    }
    const auto unit = static_cast<std::size_t>(found - known.begin());
    const auto seen = std::make_shared<const LimitedPath::SeenUnit>(
        seen_unit(asked, asked.predict, "at", measured.wanted, unit));
    using Own = tbb::enumerable_thread_specific<std::unique_ptr<UnitAt>>;
    const auto own = std::make_shared<Own>();
    const std::size_t parameters = asked.model->parameters.size();
    const auto with_item =
        std::make_shared<const std::function<WeightedDraws(const WeightedDraws&)>>(
            [rows = asked.rows, unit](const WeightedDraws& draws) {
              return with_unit(*rows, unit, draws);
            });
    for (const Quantity& each : places) {
      const double place = each.si();
      if (seen->ahead->goes_on() && !(place > seen->now)) {
        asked.predict.fail(
            "at",
            fmt::format("{} is not beyond {:.6g} {}, the last row of {}, where its path continues",
                        description(each), from_si(asked.axis().unit.unit, seen->now),
                        asked.axis().unit.unit.text, asked.unit(unit)));
      }
      PredictionRequest prediction =
          measurement(asked, measured, place, [=](const double* x, double) {
            std::unique_ptr<UnitAt>& mine = own->local();
            if (!mine) mine = std::make_unique<UnitAt>(axis, *seen);
            return mine->outputs(x, x + parameters, place);
          });
      prediction.item = {};
      prediction.mean_of = prediction.measured_of = asked.unit(unit);
      prediction.with_item = with_item;
      study.predictions.push_back(std::move(prediction));
    }
  }
}

// Paths of all units are computed together, each in about 4 MB.
constexpr std::size_t most_paths = 2000;

// The value of each unit, without measurement scatter.
void request_paths(const Asked& asked, const Measured& measured,
                   const std::vector<Quantity>& places, const LimitedPath& axis, bool of_new,
                   PosteriorStudy& study) {
  auto paths = std::make_shared<std::vector<SpreadPath>>();
  QuantityGroup group;
  const auto add = [&](SpreadPath path, const std::string& of) {
    for (const Quantity& each : places) {
      if (path.unit && each.si() <= path.path.now) continue;
      path.places.push_back(each.si());
      group.requests.push_back(
          request(measured.column, of,
                  joined(fmt::format("at {} = {}", *asked.model->along, description(each)),
                         asked.given.words),
                  measured.unit));
    }
    path.rising = axis.rising;
    path.begin = axis.begin;
    path.scale = axis.scale;
    if (!path.places.empty()) paths->push_back(std::move(path));
  };
  const std::vector<formula::Wanted> wanted(measured.wanted.begin(),
                                            measured.wanted.begin() + (measured.process ? 2 : 1));
  if (of_new) add({{axis.next, {}, 0}, {}, {}}, "new " + asked.noun);
  if (const auto refusal = too_many_units(asked, "at", "units", "path", "4 MB", most_paths)) {
    if (!study.refusal) study.refusal = refusal;
  } else if (asked.model->label || axis.next->goes_on() || measured.process) {
    const std::vector<std::string> only = asked.predict.texts("units");
    for (std::size_t u = 0; u < asked.model->units.size(); ++u) {
      const bool reported =
          std::find(only.begin(), only.end(), asked.model->units[u]) != only.end();
      if (asked.predict.has("units") && !reported) continue;
      add({seen_unit(asked, asked.predict, "at", wanted, u), u, {}}, asked.unit(u));
    }
  }
  if (paths->empty()) return;
  std::shared_ptr<const ProcessLimit> process;
  if (measured.process) {
    const auto column = static_cast<std::size_t>(&measured - asked.model->measured.data());
    process = std::make_shared<const ProcessLimit>(ProcessLimit{column, axis});
  }
  group.from_draws = [rows = asked.rows, paths, process](const WeightedDraws& draws) {
    const Path& any = *paths->front().path.ahead;
    const bool solved = any.goes_on() && any.running->running.solved;
    const std::size_t most = solved ? most_points_solved : most_points;
    const auto answers = [&](std::size_t finer) {
      const std::vector<Spread> known = process
                                            ? process_spreads(*rows, *process, *paths, draws, finer)
                                            : spreads(*rows, *paths, draws, finer * most);
      std::vector<QuantityQuantiles> all;
      for (const Spread& spread : known) {
        for (const CellMixture& each : spread.ahead) {
          const double middle = each.quantile(0.5);
          all.push_back({each.quantile(0.05), middle, each.quantile(0.95), 0, 0, middle});
        }
      }
      return all;
    };
    constexpr auto finer = static_cast<std::size_t>(1 / fewer_points);
    std::vector<QuantityQuantiles> all = answers(finer);
    estimate_numerical_errors(all, answers(1));
    return all;
  };
  study.quantity_groups.push_back(std::move(group));
}

}  // namespace

bool has_path(const Measured& measured) {
  if (measured.process) return false;
  switch (measured.form->family) {
    case ResponseFamily::normal:
    case ResponseFamily::lognormal:
    case ResponseFamily::lognormal_by_moments:
      return true;
    default:
      return false;
  }
}

void read_path(const Asked& asked, PosteriorStudy& study) {
  const TomlReader& predict = asked.predict;
  const NumberColumn& axis = asked.axis();
  const double most = *std::max_element(axis.values.begin(), axis.values.end());
  const std::vector<Quantity> places = predict.quantities("at", formula::si_text(axis.unit.powers));
  for (const Quantity& at : places) {
    study.reaches.push_back({fmt::format("the prediction at {} of {}", description(at), axis.name),
                             fmt::format("the largest {} of the data is {:.4g} {}", axis.name,
                                         from_si(axis.unit.unit, most), axis.unit.unit.text),
                             at.si(), most});
  }
  for (const Measured& measured : asked.model->measured) {
    if (!has_path(measured) && !measured.process) {
      predict.fail("at", fmt::format("future measurements are predicted for the normal and the "
                                     "lognormal family, not for {}",
                                     measured.form->name));
    }
    LimitedPath path;
    path.next = make_path(asked.model, predict, "at", measured.wanted, true, asked.common);
    if (path.next->goes_on()) {
      for (const Quantity& at : places) {
        if (at.si() >= path.next->running->begin) continue;
        predict.fail(
            "at",
            fmt::format("{} lies before {:.6g} {}, the start of a path", description(at),
                        from_si(axis.unit.unit, path.next->running->begin), axis.unit.unit.text));
      }
    }
    // For a process, and for two effects, no single number relates a new unit to the median one.
    const bool plain = asked.model->effects.size() < 2 && !measured.process;
    for (const Quantity& at : places) {
      if (plain) add_measurement(asked, measured, path.next, at.si(), study);
    }
    set_reach(asked, path);
    add_units(asked, measured, places, path, study);
    request_paths(asked, measured, places, path, !plain, study);
  }
}

}  // namespace wearwell::formula_model
