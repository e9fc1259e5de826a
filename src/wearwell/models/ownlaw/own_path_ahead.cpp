#include "wearwell/models/ownlaw/own_path_ahead.h"

#include <fmt/format.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>

#include "wearwell/models/ownlaw/own_limit.h"
#include "wearwell/models/ownlaw/own_process_spread.h"
#include "wearwell/models/ownlaw/own_spread.h"

namespace wearwell::ownlaw {
namespace {

constexpr std::size_t most_points = 500;

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

void add_measurement(const Asked& asked, const Measured& measured, std::shared_ptr<const Path> path,
                     double place, PosteriorStudy& study) {
  const ResponseFamily family = measured.form->family;
  const bool normal = family == ResponseFamily::normal;
  const auto shared = std::make_shared<const SharedPath>(std::move(path));
  // The mean and standard deviation of the column itself.
  const auto moments = [=](const double* x, double z) {
    PathAt& mine = shared->mine();
    mine.move_to(x);
    mine.evaluate(1, &z, &place);
    double mean = mine.output(0, 0), sd = mine.output(1, 0);
    if (family == ResponseFamily::lognormal) {
      mean *= std::exp(0.5 * sd * sd);
      sd = mean * std::sqrt(std::expm1(sd * sd));
    }
    return std::pair(mean, sd);
  };
  PredictionRequest prediction{*asked.law->along,
                               from_si(asked.axis().unit.unit, place),
                               measured.column,
                               measured.unit,
                               [=](const double* x) { return moments(x, 0).first; },
                               [=](const double* x) { return moments(x, 0).second; },
                               normal ? ObservationFamily::normal : ObservationFamily::lognormal,
                               {}};
  const std::string& unit = asked.axis().unit.unit.text;
  if (unit != "1" && unit != prediction.at_name) prediction.at_unit = unit;
  if (asked.law->varies()) {
    prediction.item = [=](const double* x, double z) { return moments(x, z).first; };
    prediction.mean_of = "median " + asked.noun;
    prediction.measured_of = "new " + asked.noun;
  }
  study.predictions.push_back(std::move(prediction));
}

// What is true of each unit, without the scatter of one measurement.
void request_paths(const Asked& asked, const Measured& measured,
                   const std::vector<Quantity>& places, const LimitedPath& axis, bool of_new,
                   PosteriorStudy& study) {
  auto paths = std::make_shared<std::vector<SpreadPath>>();
  QuantityGroup group;
  const auto add = [&](SpreadPath path, const std::string& of) {
    for (const Quantity& each : places) {
      if (path.unit && each.si() <= path.path.now) continue;
      path.places.push_back(each.si());
      group.requests.push_back(request(
          measured.column, of,
          joined(fmt::format("at {} = {}", *asked.law->along, in_words(each)), asked.given.words),
          measured.unit));
    }
    path.rising = axis.rising;
    path.begin = axis.begin;
    path.scale = axis.scale;
    if (!path.places.empty()) paths->push_back(std::move(path));
  };
  const std::vector<law::Wanted> wanted(measured.wanted.begin(),
                                        measured.wanted.begin() + (measured.process ? 2 : 1));
  if (of_new) add({{axis.next, {}, 0}, {}, {}}, "new " + asked.noun);
  if (asked.law->label || axis.next->goes_on() || measured.process) {
    for (std::size_t u = 0; u < asked.law->units.size(); ++u) {
      add({seen_unit(asked, asked.predict, "at", wanted, u), u, {}}, asked.unit(u));
    }
  }
  if (paths->empty()) return;
  std::shared_ptr<const ProcessLimit> process;
  if (measured.process) {
    const auto column = static_cast<std::size_t>(&measured - asked.law->measured.data());
    process = std::make_shared<const ProcessLimit>(ProcessLimit{column, axis});
  }
  group.from_draws = [rows = asked.rows, paths, process](const WeightedDraws& draws) {
    std::vector<QuantityQuantiles> all;
    const bool dear =
        paths->front().path.ahead->goes_on() && paths->front().path.ahead->running->running.solved;
    const std::vector<Spread> known = process
                                          ? process_spreads(*rows, *process, *paths, draws)
                                          : spreads(*rows, *paths, draws, dear ? 200 : most_points);
    for (const Spread& spread : known) {
      for (const CellMixture& each : spread.ahead) {
        const double middle = each.quantile(0.5);
        all.push_back({each.quantile(0.05), middle, each.quantile(0.95), 0, 0, middle});
      }
    }
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
  const std::vector<Quantity> places = predict.quantities("at", law::si_text(axis.unit.powers));
  for (const Quantity& at : places) {
    study.reaches.push_back({fmt::format("the prediction at {} of {}", in_words(at), axis.name),
                             fmt::format("the largest {} of the data is {:.4g} {}", axis.name,
                                         from_si(axis.unit.unit, most), axis.unit.unit.text),
                             at.si(), most});
  }
  for (const Measured& measured : asked.law->measured) {
    if (!has_path(measured) && !measured.process) {
      predict.fail("at", fmt::format("measurements to come are predicted of the normal and the "
                                     "lognormal family, not of {}",
                                     measured.form->name));
    }
    LimitedPath path;
    path.next = make_path(asked.law, predict, "at", measured.wanted, true, asked.common);
    if (path.next->goes_on()) {
      for (const Quantity& at : places) {
        if (at.si() >= path.next->running->begin) continue;
        predict.fail(
            "at",
            fmt::format("{} lies before {:.6g} {}, where a path begins", in_words(at),
                        from_si(axis.unit.unit, path.next->running->begin), axis.unit.unit.text));
      }
    }
    // Of a process, and of two effects, there is no one number that tells a new unit from the median one.
    const bool plain = asked.law->effects.size() < 2 && !measured.process;
    for (const Quantity& at : places) {
      if (plain) add_measurement(asked, measured, path.next, at.si(), study);
    }
    set_reach(asked, path);
    request_paths(asked, measured, places, path, !plain, study);
  }
}

}  // namespace wearwell::ownlaw
