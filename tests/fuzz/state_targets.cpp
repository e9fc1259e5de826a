#include "fuzz/state_targets.h"

#include <zlib.h>

#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "calibration/formula_design.h"
#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"
#include "wearwell/study/inference_data.h"

// States are signed, so that bytes which were mutated by chance never come farther than the checksum. Here they are signed again.
namespace wearwell::fuzz {
namespace {

using prognosis::CarriedState;

void demand(bool kept, const char* promise) {
  if (!kept) throw std::logic_error(promise);
}

std::string signed_state(std::string_view body) {
  prognosis::ByteWriter head;
  for (const char each : std::string_view("wearwell state\r\n"))
    head.byte(static_cast<std::uint8_t>(each));
  head.u32(1);
  head.u64(body.size());
  uLongf size = compressBound(body.size());
  std::string packed(size, '\0');
  compress2(reinterpret_cast<Bytef*>(packed.data()), &size,
            reinterpret_cast<const Bytef*>(body.data()), body.size(), 1);
  packed.resize(size);
  const std::string all = head.take() + packed;
  return all + sha1_of(all);
}

// What was read is whole: it is written as it was read.
void read_carried(std::string_view bytes) {
  try {
    const CarriedState state = prognosis::state_of_bytes(bytes, "a state");
    const std::string again = prognosis::state_bytes(state);
    const CarriedState other = prognosis::state_of_bytes(again, "a state");
    demand(prognosis::state_bytes(other) == again, "a state that was read is written again");
    demand(state.parameters.empty() || std::abs(state.posterior.weights.sum() - 1) < 1e-3,
           "weights sum to 1");
  } catch (const InputError& refused) {
    demand(*refused.what() != '\0', "a refusal says why");
  }
}

// Random steps about a straight mean, read with an error: a path that is hidden.
const char* hidden = R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
unit = "unit"
[likelihood.depth]
family = "wiener-process"
mean = "b * time"
scale = "s"
noise = "e"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
s = { distribution = "half-normal", scale = "0.3 um" }
e = { distribution = "half-normal", scale = "0.2 um" }
scatter = { distribution = "half-normal", scale = 0.5 }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "scatter" }
[predict]
along = "time"
limit = { depth = "12 um" }
)toml";

// A sum along the path, another factor for each material.
const char* summed = R"toml(
[data.columns]
depth = { column = "depth", unit = "um" }
time = { column = "time", unit = "h" }
step = { column = "step", unit = "h" }
material = "material"
unit = "unit"
[formula]
wear = "b * q[material] * cum(step)"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "e"
[prior]
b = { distribution = "lognormal", median = "1 um/h", log_sd = 0.5 }
q = { distribution = "lognormal", median = "1", log_sd = 0.5 }
e = { distribution = "half-normal", scale = "0.2 um" }
[predict]
along = "time"
limit = { wear = "12 um" }
given = { material = "PTFE", step = "1 h" }
[random_effects.unit]
b = { distribution = "lognormal", log_sd = "0.3" }
)toml";

std::vector<Column> data() {
  using formula_model::numbers, formula_model::texts;
  return {texts("unit", {"u0", "u0", "u0", "u1", "u1", "u1"}),
          texts("material", {"PTFE", "PTFE", "PTFE", "PEEK", "PEEK", "PEEK"}),
          numbers("time", {1, 2, 3, 1, 2, 3}), numbers("step", {1, 1, 1, 1, 1, 1}),
          numbers("depth", {0.9, 2.2, 3.1, 1.3, 2.4, 3.9})};
}

// One joint, whose inspections are few; its units are points that the engine weighs.
const char* joint = R"toml(model = "archard-joint"
[data]
file = "data.csv"
[data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
[conditions]
work_per_cycle = "6 N m"
[likelihood]
family = "normal"
[prior]
k = { distribution = "lognormal", median = "1e-3 mm^3/(N m)", log_sd = 1.5 }
sigma = { distribution = "half-normal", scale = "8 mm^3" }
[predict]
limit = "100 mm^3"
)toml";

Source study_of_joint() {
  Table table;
  table.source = "data.csv";
  table.rows = 3;
  table.columns = {formula_model::numbers("cycles", {100, 1000, 5000}),
                   formula_model::numbers("volume", {5.1, 8.8, 24.2})};
  return {{"study.toml", joint}, {{"data.csv", table}}};
}

// What follows units of a population of a few points, and how the bytes of any of them begin.
struct Population {
  std::unique_ptr<const prognosis::Tracker> tracker;
  std::string begin;
  bool sum_before = false;  ///< the checksum stands before what it is of; else behind

  Population(const std::string& model_key, const Source& source, const std::string& unit,
             const std::map<std::string, double>& middle) {
    CarriedState state;
    state.model = model_key;
    state.source = source;
    const auto study = read_study(source, all_models());
    for (const Parameter& each : require_posterior_study(*study).parameters)
      state.parameters.push_back(each.name);
    constexpr Eigen::Index points = 4;
    const auto width = static_cast<Eigen::Index>(state.parameters.size());
    state.posterior.values.resize(points, width);
    for (Eigen::Index i = 0; i < points; ++i) {
      for (Eigen::Index j = 0; j < width; ++j) {
        const double phase = 3.0 * static_cast<double>(i) + 2.0 * static_cast<double>(j);
        state.posterior.values(i, j) =
            middle.at(state.parameters[static_cast<std::size_t>(j)]) * (1 + 0.1 * std::sin(phase));
      }
    }
    state.posterior.weights = Eigen::VectorXd::Constant(points, 1.0 / points);
    for (const Model& model : all_models()) {
      if (model.key == state.model) tracker = model.track(state);
    }
    constexpr std::size_t length = 8, digest = 40;
    const std::string saved = tracker->begin(unit)->save();
    sum_before = state.model != "formula";
    const std::size_t mark = sum_before ? length + std::string_view("wearwell nodes 1").size() : 16;
    begin = saved.substr(sum_before ? digest : 0, mark + length + digest);
  }

  std::string whole(std::string_view rest) const {
    const std::string all = begin + std::string(rest);
    constexpr std::size_t check = 16;
    return sum_before ? sha1_of(all) + all : all + sha1_of(all).substr(0, check);
  }
};

const Population& population_of(char which) {
  static const Population of[] = {
      {"formula",
       formula_model::FormulaDesign(hidden, data()).source,
       "new",
       {{"b", 3e-10}, {"s", 2e-7}, {"e", 1e-7}, {"scatter", 0.3}}},
      {"formula",
       formula_model::FormulaDesign(summed, data()).source,
       "new",
       {{"b", 3e-10}, {"q[PEEK]", 1}, {"q[PTFE]", 1.1}, {"e", 2e-7}}},
      {"archard-joint", study_of_joint(), "joint", {{"k", 8e-13}, {"sigma", 3e-9}}}};
  return of[which == '1' ? 1 : which == '2' ? 2 : 0];
}

}  // namespace

void carried(std::string_view bytes) {
  read_carried(bytes);
  read_carried(signed_state(bytes));
}

// The first byte says of which population.
void tracked(std::string_view bytes) {
  if (bytes.empty()) return;
  const Population& population = population_of(bytes.front());
  try {
    const auto unit = population.tracker->restore(population.whole(bytes.substr(1)));
    const std::string again = unit->save();
    demand(population.tracker->restore(again)->save() == again, "a unit goes on as it was saved");
    const prognosis::Forecast forecast = unit->forecast();
    demand(!(forecast.passed < 0 || forecast.passed > 1), "a probability is one");
    unit->ahead(prognosis::places_ahead(forecast));
    prognosis::Reading reading{
        {}, std::vector<std::string>(population.tracker->labels().size(), "PTFE")};
    for (const prognosis::ReadingColumn& each : population.tracker->columns())
      reading.numbers.push_back(each.name == "time"     ? 4 * 3600.0
                                : each.name == "step"   ? 3600.0
                                : each.name == "cycles" ? 6000.0
                                : each.name == "volume" ? 2.8e-8
                                                        : 4e-6);
    unit->update(reading, [](const auto&) {});
  } catch (const InputError& refused) {
    demand(*refused.what() != '\0', "a refusal says why");
  }
}

}  // namespace wearwell::fuzz
