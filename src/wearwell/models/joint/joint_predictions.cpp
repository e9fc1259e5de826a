#include "wearwell/models/joint/joint_predictions.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/models/joint/work_history.h"
#include "wearwell/study/life_levels.h"

namespace wearwell::joint {
namespace {

double largest(const std::vector<double>& values) {
  return *std::max_element(values.begin(), values.end());
}

// Friction work against cycles. If the work per cycle is constant, it applies to the past and the
// future.
struct CycleWork {
  std::optional<double> rate;  // J per future cycle
  WorkHistory history;
};

CycleWork read_cycle_work(const std::optional<TomlReader>& predict, const JointData& data) {
  std::optional<double> rate = data.work_per_cycle;
  if (predict && !rate) {
    if (const auto future = predict->quantity("work_per_cycle", "N m/cycle")) {
      if (!(future->si() > 0)) predict->fail("work_per_cycle", "must be positive");
      rate = future->si();
    }
  }
  return {rate, data.work_per_cycle ? WorkHistory({}, {}, rate)
                                    : WorkHistory(data.cycles, data.inspections.work, rate)};
}

struct Volumes {
  Archard law;
  ObservationFamily family;
  Unit unit;

  PredictionRequest at(double cycles, double work, std::optional<double> measured) const {
    return {"cycles",
            cycles,
            "volume",
            unit,
            [law = law, work](const double* x) { return law.mean_volume(x, work); },
            [](const double* x) { return x[1]; },
            family,
            measured};
  }
};

void need_rate(const TomlReader& predict, const CycleWork& cycle_work, const char* key) {
  if (!cycle_work.rate)
    predict.fail(key, "needs the work of future cycles; give predict.work_per_cycle");
}

// The curve ends after the last inspection or prediction, or somewhat after the threshold.
void add_curve(const std::optional<TomlReader>& predict, const CycleWork& cycle_work,
               const Volumes& volumes, const JointData& data, PosteriorStudy& study) {
  constexpr int points = 32;
  double end = largest(data.cycles);
  if (predict && cycle_work.rate) {
    for (const Quantity& cycles : predict->quantities("cycles", "cycle")) {
      end = std::max(end, cycles.si());
    }
    if (const auto limit = predict->quantity("limit", "m^3")) {
      const double k = least_squares(data.inspections).k;
      const double reached = cycle_work.history.cycles_at(limit->si() / k);
      if (reached > 0) end = std::max(end, std::min(reached, 3 * end));
    }
    end *= 1.1;
  }
  for (int i = 0; i <= points; ++i) {
    const double cycles = end * std::max<double>(i, 1e-3) / points;
    study.history.push_back(volumes.at(cycles, cycle_work.history.work_at(cycles), {}));
  }
}

void add_volumes(const TomlReader& predict, const CycleWork& cycle_work, const Volumes& volumes,
                 const JointData& data, PosteriorStudy& study) {
  const double seen = largest(data.cycles);
  for (const Quantity& cycles : predict.quantities("cycles", "cycle")) {
    need_rate(predict, cycle_work, "cycles");
    if (!(cycles.si() >= 0)) predict.fail("cycles", "must be 0 or more");
    std::optional<double> measured;
    for (std::size_t i = 0; i < data.cycles.size(); ++i) {
      if (data.cycles[i] == cycles.si()) measured = data.inspections.volume[i];
    }
    study.predictions.push_back(
        volumes.at(cycles.si(), cycle_work.history.work_at(cycles.si()), measured));
    study.reaches.push_back({fmt::format("the prediction at {:.6g} cycles", cycles.si()),
                             fmt::format("the last inspection was after {:.6g} cycles", seen),
                             cycles.si(), seen});
  }
}

void add_life(const TomlReader& predict, const CycleWork& cycle_work, const Archard& law,
              const JointData& data, PosteriorStudy& study) {
  const auto risk = predict.quantity("risk", "1");
  if (risk && !(risk->si() > 0 && risk->si() < 1))
    predict.fail("risk", "must lie between 0 and 1, like 0.05 or \"5 %\"");
  const auto limit = predict.quantity("limit", "m^3");
  if (!limit) {
    for (const char* key : {"risk", "b_lives", "level", "credible_level", "sides"}) {
      if (predict.has(key)) predict.fail(key, "needs predict.limit");
    }
    return;
  }
  need_rate(predict, cycle_work, "limit");
  const LifeLevels levels = read_life_levels(predict);
  if (!(limit->si() > 0)) predict.fail("limit", "must be positive");
  const double most = largest(data.inspections.volume);
  if (most > 0) {
    study.reaches.push_back({fmt::format("the limit of {:.6g} {}", limit->value, limit->unit.text),
                             fmt::format("the largest volume measured is {:.4g} {}",
                                         from_si(data.volume_unit, most), data.volume_unit.text),
                             limit->si(), most});
  }
  study.life = LifeRequest{
      Unit{"1", 1, 0},
      "cycles",
      *limit,
      largest(data.cycles),
      risk ? risk->si() : 0.01,
      [law, history = cycle_work.history, limit = limit->si()](const WeightedDraws& draws) {
        return life_distribution(
            draws, [&](const double* x) { return history.cycles_at(law.work_at(x, limit)); });
      }};
  if (levels.percents.empty()) return;
  study.quantity_groups.push_back(b_lives_of_one(
      *study.life, "joint", fmt::format("to {:.6g} {}", limit->value, limit->unit.text), levels));
}

}  // namespace

void add_predictions(const TomlReader& root, const Archard& law, ObservationFamily family,
                     const JointData& data, PosteriorStudy& study) {
  const auto predict = root.table("predict");
  const CycleWork cycle_work = read_cycle_work(predict, data);
  const Volumes volumes{law, family, data.volume_unit};
  study.stage_predictions = [volumes, cycles = data.cycles,
                             inspections = data.inspections](std::size_t rows) {
    std::vector<PredictionRequest> requests;
    for (std::size_t i = rows - 1; i < std::min(rows + 1, cycles.size()); ++i) {
      requests.push_back(volumes.at(cycles[i], inspections.work[i], inspections.volume[i]));
    }
    return requests;
  };
  add_curve(predict, cycle_work, volumes, data, study);
  if (!predict) return;
  add_volumes(*predict, cycle_work, volumes, data, study);
  add_life(*predict, cycle_work, law, data, study);
}

}  // namespace wearwell::joint
