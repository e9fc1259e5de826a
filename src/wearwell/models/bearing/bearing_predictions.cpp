#include "wearwell/models/bearing/bearing_predictions.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/models/bearing/bearing_ahead.h"
#include "wearwell/models/bearing/seen_bearing.h"
#include "wearwell/models/bearing/wear_number.h"
#include "wearwell/study/life_levels.h"

// Longer than others: all predictions of a bearing share its description.

namespace wearwell {
namespace {

using bearing::Contact;
using bearing::Duty;

// The depth of one duty as a function of the wear rate; a bearing worn beyond its geometry keeps
// its last depth.
std::function<double(double k)> depth_function(const Duty& duty, double k) {
  const bearing::DepthFunction curve = bearing::depth_functions({duty}, k).front();
  return [curve](double rate) { return curve.depth(std::min(std::log(rate), curve.limit())); };
}

std::string description(const Quantity& quantity) {
  return fmt::format("{:.6g} {}", quantity.value, quantity.unit.text);
}

// Reads [predict]: a bearing as in [conditions], or as given here.
class Predictions {
 public:
  Predictions(const TomlReader& predict, const bearing::WearModel& model, const BearingData& data,
              double k, PosteriorStudy& study)
      : predict_(predict), model_(model), data_(data), k_(k), study_(study) {
    const BearingAhead ahead = read_bearing_ahead(predict, data);
    contact_ = ahead.contact.value_or(Contact::stationary);
    has_contact_ = ahead.contact.has_value();
    radius_ = ahead.radius;
    clearance_ = ahead.clearance;
    speed_ = ahead.speed;
    force_ = ahead.force;
    pressure_ = ahead.pressure;
    mean_life_ = predict.boolean("mean_life").value_or(false);
  }

  PredictedBearing read() {
    const auto revolutions = predict_.quantities("revolutions", "rev");
    const auto times = predict_.quantities("time", "s");
    for (const Quantity& n : revolutions) {
      depth("revolutions", n.si(), fmt::format("after {:.6g} revolutions", n.si()));
    }
    for (const Quantity& time : times) {
      depth("time", time.si() * need(speed_, "speed", "time").si(), "after " + description(time));
    }
    const auto limit = positive_quantity(predict_, "limit", "m");
    const auto required = required_revolutions();
    if (required && !limit) {
      predict_.fail(required_key_, "needs predict.limit: the allowable depth then");
    }
    if (limit) reach(*limit, required);
    if (const auto name = predict_.text("life_of")) {
      if (!limit)
        predict_.fail("life_of", "needs predict.limit: the failure threshold of the depth");
      life_of_seen(*name, *limit);
    }
    for (const char* key : {"b_lives", "mean_life", "level", "credible_level", "sides"}) {
      if (!predict_.has(key) || study_.life) continue;
      predict_.fail(key,
                    "needs predict.limit and predict.pressure: B-lives and mean lives are lives to "
                    "the failure threshold");
    }
    if (mean_life_ && !pressure_)
      predict_.fail("mean_life", "is of a new bearing, whose load predict.pressure states");
    if (predict_.has("risk") && !study_.life) {
      predict_.fail("risk",
                    "needs predict.limit and predict.pressure: it is the risk of reaching the "
                    "threshold before the next inspection");
    }
    if (force_ && !required) {
      predict_.fail("force",
                    "needs predict.required_revolutions (or required_time) for the required "
                    "length, or predict.length for the pressure");
    }
    return drawn(limit);
  }

 private:
  const Quantity& need(const std::optional<Quantity>& quantity, const char* name,
                       const char* key) const {
    if (!quantity) {
      predict_.fail(key, fmt::format("needs predict.{}: the data have more than one", name));
    }
    return *quantity;
  }

  Duty duty(const char* key, double revolutions, double pressure) const {
    if (!has_contact_) {
      predict_.fail(key, "needs predict.contact: the data have more than one");
    }
    return {contact_, need(radius_, "radius", key).si(), need(clearance_, "clearance", key).si(),
            pressure, revolutions};
  }

  // Missing values are those of the last inspection.
  PredictedBearing drawn(const std::optional<Quantity>& limit) const {
    PredictedBearing bearing{data_.inspections.duty.back(), {}};
    Duty& duty = bearing.duty;
    if (has_contact_) duty.contact = contact_;
    if (radius_) duty.radius = radius_->si();
    if (clearance_) duty.clearance = clearance_->si();
    if (pressure_) duty.pressure = pressure_->si();
    duty.revolutions = std::max(duty.revolutions, most_revolutions_);
    if (limit) bearing.limit = limit->si();
    return bearing;
  }

  // The two ways to state a life: a number of revolutions, or a time at a speed.
  std::optional<double> required_revolutions() {
    const auto turns = positive_quantity(predict_, "required_revolutions", "rev");
    const auto time = positive_quantity(predict_, "required_time", "s");
    if (turns && time) {
      predict_.fail("required_time",
                    "is given, and so is required_revolutions; keep one of the two");
    }
    if (turns) {
      required_key_ = "required_revolutions";
      required_words_ = fmt::format("{:.6g} revolutions", turns->si());
      return turns->si();
    }
    if (!time) return {};
    required_key_ = "required_time";
    required_words_ = description(*time);
    time_unit_ = time->unit;
    return time->si() * need(speed_, "speed", "required_time").si();
  }

  // A quantity of the median bearing, and of a new one if bearings vary.
  void add(QuantityRequest request, bool headline = false) {
    request.headline = headline && !model_.has_scatter;
    request.driver = [](const double* x) { return x[0]; };
    // A higher wear rate increases the depth and shortens the life.
    request.safe_end = request.increasing ? 0.95 : 0.05;
    request.of = model_.has_scatter ? "median bearing" : "bearing";
    study_.quantities.push_back(request);
    if (!model_.has_scatter) return;
    request.scatter = [model = model_](const double* x) { return model.scatter(x); };
    request.of = "new bearing";
    request.headline = headline;
    study_.quantities.push_back(request);
  }

  // For the bearing of the last requested life: the mean over bearings, whose rates are lognormal, so that a life, in
  // proportion to 1/rate, has the mean of its median times exp(s^2/2). Without a predictive value: over the
  // posterior a mean of means need not exist.
  void mean_life(const LifeLevels& levels) {
    if (!mean_life_) return;
    const QuantityRequest& life = study_.quantities.back();
    QuantityGroup group;
    group.requests.push_back({"mean life", "bearing", life.at, life.unit, true, false, {}, {}, {}});
    ask_bounds(levels, group.requests.back());
    group.requests.back().safe_end = 0.05;
    group.from_draws = [levels, life](const WeightedDraws& draws) {
      const QuantityDistribution mean(draws, [&](const double* x) {
        const double s = life.scatter ? life.scatter(x) : 0;
        return life.value(life.driver(x)) * std::exp(0.5 * s * s);
      });
      QuantityQuantiles q{mean.quantile(0.05), mean.quantile(0.5), mean.quantile(0.95), 0, 0, 0};
      add_bounds(mean, levels, q);
      return std::vector<QuantityQuantiles>{q};
    };
    study_.quantity_groups.push_back(std::move(group));
  }

  // For the bearing of the last requested life.
  void b_lives(const LifeLevels& levels) {
    mean_life(levels);
    if (levels.percents.empty()) return;
    study_.quantity_groups.push_back(b_lives_of_items(study_.quantities.back(), "bearing", levels));
  }

  // The life of a bearing like these, and its time of inspection.
  void life(const Quantity& limit, double wear_per_pressure) {
    Unit unit{"1", 1, 0};
    std::string name = "revolutions";
    double constant = wear_per_pressure;  // revolutions times wear rate
    if (speed_) {
      unit = time_unit_;
      name = unit.text;
      constant /= speed_->si() * unit.scale;
    }
    const auto risk = predict_.quantity("risk", "1");
    if (risk && !(risk->si() > 0 && risk->si() < 1))
      predict_.fail("risk", "must lie between 0 and 1");
    LifeRequest request{unit, name, limit, 0, risk ? risk->si() : 0.01, {}};
    const Function rate = [](const double* x) { return x[0]; };
    if (model_.has_scatter) {
      request.of = "new bearing";
      request.distribution = [=, model = model_](const WeightedDraws& draws) {
        return life_distribution(draws, constant, rate,
                                 [=](const double* x) { return model.scatter(x); });
      };
    } else {
      request.distribution = [=](const WeightedDraws& draws) {
        return life_distribution(draws, [=](const double* x) { return constant / x[0]; });
      };
    }
    study_.life = std::move(request);
  }

  std::size_t bearing_named(const std::string& name) const {
    const auto at = std::find(data_.names.begin(), data_.names.end(), name);
    if (at == data_.names.end())
      predict_.fail("life_of", fmt::format("the data have no bearing '{}'{}", name,
                                           did_you_mean(name, data_.names)));
    return static_cast<std::size_t>(at - data_.names.begin());
  }

  // For an inspected bearing: it keeps its geometry, and has the given load, or that of its last
  // inspection.
  void life_of_seen(const std::string& name, const Quantity& limit) {
    const std::size_t number = bearing_named(name);
    const std::size_t last = bearing::last_inspection(data_.inspections, number);
    bearing::GoingOn going{data_.inspections.duty[last], 0, 0, 0, 1};
    const Duty& now = going.now;
    const Unit& of_pressure = data_.pressure_unit;
    const Quantity pressure =
        pressure_.value_or(Quantity{from_si(of_pressure, now.pressure), of_pressure});
    going.pressure = pressure.si();
    try {
      going.wear_number =
          bearing::wear_number(now.contact, now.clearance / now.radius, limit.si() / now.radius);
    } catch (const InputError& error) {
      predict_.fail("limit", fmt::format("of bearing {}: {}", name, error.what()));
    }
    const std::optional<double> speed = speed_                ? std::optional(speed_->si())
                                        : data_.speed.empty() ? std::nullopt
                                                              : std::optional(data_.speed[last]);
    Unit unit{"1", 1, 0};
    going.begin = now.revolutions;
    if (speed) {
      unit = time_unit_;
      going.per_turn = 1 / (*speed * unit.scale);
      going.begin = data_.speed.empty() ? now.revolutions * going.per_turn
                                        : now.revolutions / data_.speed[last] / unit.scale;
    }
    const double risk = study_.life ? study_.life->risk : 0.01;
    study_.life = LifeRequest{
        unit,
        speed ? unit.text : "revolutions",
        limit,
        going.begin,
        risk,
        [going, model = model_, k = k_,
         own = bearing::inspections_of(data_.inspections, number)](const WeightedDraws& draws) {
          return bearing::formula_life(going, bearing::bearing_rate(model, own, k, draws));
        },
        fmt::format("bearing {} at {}", name, description(pressure))};
  }

  void depth(const char* key, double revolutions, const std::string& when) {
    if (!(revolutions > 0)) predict_.fail(key, "must be positive");
    most_revolutions_ = std::max(most_revolutions_, revolutions);
    const Quantity& pressure = need(pressure_, "pressure", key);
    const Duty at = duty(key, revolutions, pressure.si());
    study_.predictions.push_back(depth_request(model_, data_, at, k_, {}));
    double most = 0;  // p_a n of the inspections
    for (const Duty& seen : data_.inspections.duty) {
      most = std::max(most, seen.pressure * seen.revolutions);
    }
    study_.reaches.push_back(
        {fmt::format("the depth {} at {}", when, description(pressure)),
         fmt::format("the largest pressure times revolutions of an inspection is {:.4g} {}",
                     from_si(data_.pressure_unit, most), data_.pressure_unit.text),
         pressure.si() * revolutions, most});
    add({"depth",
         "",
         fmt::format("{} at {}", when, description(pressure)),
         data_.depth_unit,
         true,
         false,
         depth_function(at, k_),
         {},
         {}});
  }

  void reach(const Quantity& limit, std::optional<double> required) {
    const Duty at = duty("limit", 0, 0);
    double wear = 0;
    try {
      wear = bearing::wear_number(at.contact, at.clearance / at.radius, limit.si() / at.radius);
    } catch (const InputError& error) {
      predict_.fail("limit", error.what());
    }
    const std::string to = "to " + description(limit);
    const auto& depths = data_.inspections.depth;
    const double deepest = *std::max_element(depths.begin(), depths.end());
    study_.reaches.push_back(
        {"the limit of " + description(limit),
         fmt::format("the deepest measured is {:.4g} {}", from_si(data_.depth_unit, deepest),
                     data_.depth_unit.text),
         limit.si(), deepest});
    if (!pressure_ && !required && !predict_.has("life_of")) {
      predict_.fail("limit",
                    "needs predict.pressure to give a life, or required_revolutions (or "
                    "required_time) to give the allowable pressure");
    }
    if (pressure_) {
      life(limit, wear / pressure_->si());
      const std::string where = fmt::format("{} at {}", to, description(*pressure_));
      const double rate = pressure_->si();
      const LifeLevels levels = read_life_levels(predict_);
      add({"life",
           "",
           where,
           Unit{"revolutions", 1, 0},
           false,
           true,
           [=](double k) { return wear / (k * rate); },
           {},
           {}});
      b_lives(levels);
      if (speed_) {
        const double turns = speed_->si();
        add({"life",
             "",
             fmt::format("{}, {}", where, description(*speed_)),
             time_unit_,
             false,
             true,
             [=](double k) { return wear / (k * rate * turns); },
             {},
             {}});
        b_lives(levels);
      }
    }
    if (!required) return;
    const double n = *required;
    add({"pressure",
         "",
         fmt::format("{} in {}", to, required_words_),
         data_.pressure_unit,
         false,
         false,
         [=](double k) { return wear / (k * n); },
         {},
         {}},
        true);
    if (!force_) return;
    const double per_rate = force_->si() * n / (2 * at.radius * wear);
    add({"length",
         "",
         fmt::format("{} in {} under {}", to, required_words_, description(*force_)),
         read_unit("mm", "m"),
         true,
         false,
         [=](double k) { return k * per_rate; },
         {},
         {}},
        true);
  }

  const TomlReader& predict_;
  const bearing::WearModel& model_;
  const BearingData& data_;
  double k_;
  PosteriorStudy& study_;
  Contact contact_;
  bool has_contact_ = false, mean_life_ = false;
  std::optional<Quantity> radius_, clearance_, pressure_, speed_, force_;
  std::string required_key_, required_words_;
  Unit time_unit_ = read_unit("h", "s");
  double most_revolutions_ = 0;
};

}  // namespace

PredictionRequest depth_request(const bearing::WearModel& model, const BearingData& data,
                                const Duty& duty, double k, std::optional<double> measured) {
  const auto depth = depth_function(duty, k);
  PredictionRequest request{"revolutions",
                            duty.revolutions,
                            "depth",
                            data.depth_unit,
                            [depth](const double* x) { return depth(x[0]); },
                            [model](const double* x) { return model.sigma(x); },
                            model.family,
                            measured,
                            {}};
  if (model.has_scatter) {
    request.mean_of = "median bearing";
    request.measured_of = "new bearing";
    request.item = [model, depth](const double* x, double z) {
      return depth(x[0] * std::exp(model.scatter(x) * z));
    };
  }
  return request;
}

PredictedBearing read_bearing_predictions(const TomlReader& predict,
                                          const bearing::WearModel& model, const BearingData& data,
                                          double k, PosteriorStudy& study) {
  return Predictions(predict, model, data, k, study).read();
}

}  // namespace wearwell
