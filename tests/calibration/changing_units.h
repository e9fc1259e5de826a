#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "calibration/formula_design.h"
#include "wearwell/base/rng.h"
#include "wearwell/models/formula_model/formula_tracker.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::formula_model {

/// Guides that wear in proportion to their use, as in examples/fleet: readings good to 2 um, a failure threshold of 100 um.
struct Guides {
  std::unique_ptr<const prognosis::Tracker> tracker;
  /// The same population, whose rates may change: once in 5,000 h, by a factor of 1 x/ 2.
  std::unique_ptr<const prognosis::Tracker> with_change;
  prognosis::WatchedColumns columns;

  static constexpr double um = 1e-6, h = 3600, limit = 100, noise = 2, rate = 0.02, scatter = 0.35;

  static double drawn_rate(Rng& rng) { return rate * std::exp(scatter * rng.normal()); }

  /// Learned from machines with eight readings each.
  Guides(int machines, Rng& rng) {
    std::vector<double> wear, use;
    std::vector<std::string> names;
    for (int m = 0; m < machines; ++m) {
      const double own = drawn_rate(rng);
      for (int i = 1; i <= 8; ++i) {
        use.push_back(450.0 * i);
        wear.push_back(own * use.back() + noise * rng.normal());
        names.push_back("L" + std::to_string(m));
      }
    }
    learn(wear, use, names);
  }
  Guides(const std::vector<double>& wear, const std::vector<double>& use,
         const std::vector<std::string>& names) {
    learn(wear, use, names);
  }

 private:
  void learn(const std::vector<double>& wear, const std::vector<double>& use,
             const std::vector<std::string>& names) {
    const std::string study = R"(
[data.columns]
wear = { column = "wear", unit = "um" }
use = { column = "use", unit = "h" }
machine = "machine"
[formula]
worn = "rate * use"
[likelihood.wear]
family = "normal"
mean = "worn"
sd = "error"
[prior]
rate = { distribution = "lognormal", median = "0.02 um/h", log_sd = 1.5 }
error = { distribution = "half-normal", scale = "5 um" }
scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.machine]
rate = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "use"
limit = { worn = "100 um" }
)";
    const FormulaDesign design(
        study, {numbers("wear", wear), numbers("use", use), texts("machine", names)});
    const ExactPosterior exact = exact_posterior(
        std::make_shared<const FormulaRows>(design.model, design.model->data.table.rows), 3e-3);
    if (!exact.failure.empty()) return;
    prognosis::CarriedState state;
    state.source = design.source;
    for (const Parameter& each : design.model->parameters) state.parameters.push_back(each.name);
    state.posterior = exact.nodes;
    tracker = track_units(state);
    const FormulaDesign changing(
        study + "rate_change = { every = \"5000 h\", factor = \"1 x/ 2\" }\n",
        {numbers("wear", wear), numbers("use", use), texts("machine", names)});
    state.source = changing.source;
    with_change = track_units(state);
    columns = prognosis::watched_columns(*tracker);
  }
};

/// One of these guides on line, under watch.
struct WatchedGuide {
  const Guides& guides;
  std::string name;
  const prognosis::Tracker& tracker;
  std::unique_ptr<prognosis::TrackedUnit> unit = {};
  prognosis::ChangeWatch watch = {};
  std::vector<prognosis::Reading> taken = {};

  WatchedGuide(const Guides& of, const std::string& unit_name, bool may_change = false)
      : guides(of), name(unit_name), tracker(may_change ? *of.with_change : *of.tracker) {
    unit = tracker.begin(unit_name);
  }

  /// h, um.
  prognosis::UpdateResult read(double use, double wear) {
    const prognosis::Reading reading{{wear * Guides::um, use * Guides::h}, {}};
    const prognosis::UpdateResult result =
        watch.update({tracker, guides.columns, name, *unit}, reading, false,
                     [&](const std::function<void(const prognosis::Reading&)>& visit) {
                       for (const prognosis::Reading& each : taken) visit(each);
                     });
    taken.push_back(reading);
    return result;
  }
};

/// What a unit shows at a use, and what remains of its life.
struct Shown {
  double use = 0, wear = 0;  ///< as read, h and um
  double remaining = 0;      ///< true, h; before a change that of a unit that goes on
};

/// How a unit changes after its reading `changes`: readings every 150 h.
struct Change {
  const char* name;
  const char* named;  ///< a part of the right reason; "" if nothing is to be found
  std::function<std::vector<Shown>(Rng&)> readings;
  bool from_start = false;  ///< from the first reading on
};

inline constexpr int changes_after = 10, most_readings = 25;
inline constexpr double between_readings = 150;

namespace changing {

inline double round_to(double x, double step) {
  return step * std::round(x / step);
}

/// Wear grows at `rate(use)` from `wear` on; as_read distorts the reading i of the true wear.
inline std::vector<Shown> grown(Rng& rng, double own, const std::function<double(int)>& factor,
                                const std::function<double(int, double)>& as_read,
                                const std::function<double()>& noise) {
  std::vector<Shown> all;
  double wear = 0;
  static_cast<void>(rng);
  for (int i = 1; i <= most_readings; ++i) {
    wear += own * factor(i) * between_readings;
    if (wear >= Guides::limit) break;
    double left = 0, at = wear;  // the true end
    for (int j = i + 1; at < Guides::limit && j < 10000; ++j) {
      const double step = own * (i <= changes_after ? 1 : factor(j)) * between_readings;
      left += between_readings * std::min(1.0, (Guides::limit - at) / step);
      at += step;
    }
    all.push_back({between_readings * i, round_to(as_read(i, wear + noise()), 0.01), left});
  }
  return all;
}

}  // namespace changing

/// The fleets of the study of changes.
inline std::vector<Change> changes() {
  using changing::grown;
  const auto same = [](int) { return 1.0; };
  const auto true_reading = [](int, double wear) { return wear; };
  const auto normal = [](Rng& rng) { return [&rng] { return Guides::noise * rng.normal(); }; };
  const auto after = [](int i) { return i > changes_after; };
  const auto of_rate = [=](const std::function<double(int)>& factor) {
    return [=](Rng& rng) {
      return grown(rng, Guides::drawn_rate(rng), factor, true_reading, normal(rng));
    };
  };
  const auto of_sensor = [=](const std::function<double(int, double)>& as_read) {
    return
        [=](Rng& rng) { return grown(rng, Guides::drawn_rate(rng), same, as_read, normal(rng)); };
  };
  return {
      {"right model", "", of_rate(same)},
      {"rate 3 times", "rate has changed", of_rate([=](int i) { return after(i) ? 3.0 : 1.0; })},
      {"rate 1.5 times", "rate has changed", of_rate([=](int i) { return after(i) ? 1.5 : 1.0; })},
      {"rate grows 5 % a reading", "rate has changed",
       of_rate([=](int i) { return after(i) ? std::pow(1.05, i - changes_after) : 1.0; })},
      {"step of 12 um", "a step",
       of_sensor([=](int i, double wear) { return after(i) ? wear + 12 : wear; })},
      {"step of -12 um", "a step",
       of_sensor([=](int i, double wear) { return after(i) ? wear - 12 : wear; })},
      {"reset of the sensor", "reset to zero",
       [=](Rng& rng) {
         const double own = Guides::drawn_rate(rng);
         const double zero = own * between_readings * changes_after;
         return grown(
             rng, own, same, [=](int i, double wear) { return after(i) ? wear - zero : wear; },
             normal(rng));
       }},
      {"replaced part", "replaced",
       [=](Rng& rng) {
         const double own = Guides::drawn_rate(rng), next = Guides::drawn_rate(rng);
         std::vector<Shown> all = grown(rng, own, same, true_reading, normal(rng));
         std::vector<Shown> fresh = grown(rng, next, same, true_reading, normal(rng));
         all.resize(std::min<std::size_t>(all.size(), changes_after));
         for (Shown& each : fresh) {
           each.use += between_readings * changes_after;
           if (all.size() >= changes_after && all.size() < most_readings) all.push_back(each);
         }
         return all;
       }},
      {"stuck sensor", "stuck",
       [=](Rng& rng) {
         double last = 0;
         return grown(
             rng, Guides::drawn_rate(rng), same,
             [=](int i, double wear) mutable {
               if (!after(i)) last = wear;
               return last;
             },
             normal(rng));
       }},
      {"mm in place of um", "mm in place of um", of_sensor([=](int i, double wear) {
         return after(i) ? changing::round_to(wear / 1000, 1e-4) : wear;
       })},
      {"sensor drifts 1 um a reading", "sensor has",
       of_sensor([=](int i, double wear) { return after(i) ? wear + i - changes_after : wear; })},
      {"heavy tails (t, 3)", "scatter",
       [=](Rng& rng) {
         const auto heavy = [&rng] {
           double square = 0;
           for (int k = 0; k < 3; ++k) square += std::pow(rng.normal(), 2);
           return Guides::noise * rng.normal() / std::sqrt(square / 3);
         };
         return grown(rng, Guides::drawn_rate(rng), same, true_reading, heavy);
       },
       true},
      {"mm from the start", "mm in place of um",
       of_sensor([=](int, double wear) { return changing::round_to(wear / 1000, 1e-4); }), true},
      {"tenths of um from the start", "the unit is not",
       of_sensor([=](int, double wear) { return changing::round_to(10 * wear, 0.1); }), true},
      {"use counter reset", "goes back",
       [=](Rng& rng) {
         std::vector<Shown> all =
             grown(rng, Guides::drawn_rate(rng), same, true_reading, normal(rng));
         for (std::size_t i = changes_after; i < all.size(); ++i)
           all[i].use -= between_readings * changes_after;
         return all;
       }},
  };
}

}  // namespace wearwell::formula_model
