#include "fuzz/state_targets.h"

#include <zlib.h>

#include <cmath>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>

#include "calibration/own_design.h"
#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"
#include "wearwell/models/registry.h"
#include "wearwell/prognosis/bytes.h"
#include "wearwell/prognosis/carried_state.h"
#include "wearwell/prognosis/tracker.h"

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
    demand(std::abs(state.posterior.weights.sum() - 1) < 1e-3, "weights sum to 1");
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
b = { law = "lognormal", median = "1 um/h", log_sd = 0.5 }
s = { law = "half-normal", scale = "0.3 um" }
e = { law = "half-normal", scale = "0.2 um" }
scatter = { law = "half-normal", scale = 0.5 }
[varies.unit]
b = { law = "lognormal", log_sd = "scatter" }
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
[law]
wear = "b * q[material] * cum(step)"
[likelihood.depth]
family = "normal"
mean = "wear"
sd = "e"
[prior]
b = { law = "lognormal", median = "1 um/h", log_sd = 0.5 }
q = { law = "lognormal", median = "1", log_sd = 0.5 }
e = { law = "half-normal", scale = "0.2 um" }
[predict]
along = "time"
limit = { wear = "12 um" }
[varies.unit]
b = { law = "lognormal", log_sd = "0.3" }
)toml";

std::vector<Column> data() {
  using ownlaw::numbers, ownlaw::texts;
  return {texts("unit", {"u0", "u0", "u0", "u1", "u1", "u1"}),
          texts("material", {"PTFE", "PTFE", "PTFE", "PEEK", "PEEK", "PEEK"}),
          numbers("time", {1, 2, 3, 1, 2, 3}), numbers("step", {1, 1, 1, 1, 1, 1}),
          numbers("depth", {0.9, 2.2, 3.1, 1.3, 2.4, 3.9})};
}

// What follows units of a population of a few points, and how the bytes of any of them begin.
struct Population {
  std::unique_ptr<const prognosis::Tracker> tracker;
  std::string begin;

  Population(const char* study, const std::map<std::string, double>& middle) {
    const ownlaw::OwnDesign design(study, data());
    CarriedState state;
    state.model = "law";
    state.source = design.source;
    for (const Parameter& each : design.law->parameters) state.parameters.push_back(each.name);
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
    constexpr std::size_t mark = 16, length = 8, fingerprint = 40;
    begin = tracker->begin("new")->save().substr(0, mark + length + fingerprint);
  }
};

}  // namespace

void carried(std::string_view bytes) {
  read_carried(bytes);
  read_carried(signed_state(bytes));
}

// The first byte says of which population.
void tracked(std::string_view bytes) {
  static const Population of[] = {
      {hidden, {{"b", 3e-10}, {"s", 2e-7}, {"e", 1e-7}, {"scatter", 0.3}}},
      {summed, {{"b", 3e-10}, {"q[PEEK]", 1}, {"q[PTFE]", 1.1}, {"e", 2e-7}}}};
  if (bytes.empty()) return;
  const Population& population = of[bytes.front() == '1'];
  const std::string all = population.begin + std::string(bytes.substr(1));
  constexpr std::size_t check = 16;
  try {
    const auto unit = population.tracker->restore(all + sha1_of(all).substr(0, check));
    const std::string again = unit->save();
    demand(population.tracker->restore(again)->save() == again, "a unit goes on as it was saved");
    const prognosis::Forecast forecast = unit->forecast();
    demand(!(forecast.passed < 0 || forecast.passed > 1), "a probability is one");
    unit->ahead(prognosis::places_ahead(forecast));
    prognosis::Reading reading{
        {}, std::vector<std::string>(population.tracker->labels().size(), "PTFE")};
    for (const prognosis::ReadingColumn& each : population.tracker->columns())
      reading.numbers.push_back(each.name == "time"   ? 4 * 3600.0
                                : each.name == "step" ? 3600.0
                                                      : 4e-6);
    unit->take(reading, [](const auto&) {});
  } catch (const InputError& refused) {
    demand(*refused.what() != '\0', "a refusal says why");
  }
}

}  // namespace wearwell::fuzz
