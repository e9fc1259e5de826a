#include "wearwell/models/fatigue/sn_fit_data.h"

#include <cmath>
#include <map>

#include "wearwell/models/fatigue/sn_scores.h"

namespace wearwell {

using fatigue::LifeTest;
using fatigue::MeanStress;
using fatigue::SnLaw;

FitData sn_fit_data(const SnLaw& law, const SnData& data,
                    const std::vector<Parameter>& parameters) {
  std::vector<double> start;
  for (const Parameter& parameter : parameters) start.push_back(parameter.start);
  FitData result{fatigue::sn_scores(law, data.tests),
                 {},
                 {{"stress", {}}},
                 Rise{},
                 "row",
                 true,
                 !law.integrated()};
  std::vector<double> mean;
  Rise& rise = *result.rise;
  rise.expected = "life increases as stress decreases";
  for (const LifeTest& test : data.tests) {
    const double stress = law.log10_reversed(start.data(), test.stress);
    result.counts.push_back(test.count);
    result.drivers[0].value.push_back(stress);
    mean.push_back(test.stress.mean);
    if (test.outcome != fatigue::Outcome::failure) continue;
    rise.driver.push_back(-stress);
    rise.value.push_back(std::log10(test.life));
  }
  if (law.correction != MeanStress::none) result.drivers.push_back({"mean stress", mean});
  if (!data.labels.empty()) {
    std::map<std::string, std::size_t> levels;
    Label label{"the type of specimen", {}};
    for (const std::string& each : data.labels)
      label.level.push_back(levels.emplace(each, levels.size()).first->second);
    result.labels = {label};
  }
  for (const LifeTest& test : data.tests) {
    const bool exact = test.outcome == fatigue::Outcome::failure;
    result.measured.value.push_back(exact ? from_si(data.life_unit, test.life) : NAN);
    result.measured.unit.push_back(data.life_unit.scale);
  }
  result.remedies.life = true;
  result.remedies.scatter = law.scatter_grows
                                ? "Scatter already grows with life: look for a second failure mode "
                                  "at the stresses with the largest scatter."
                                : "Long lives often scatter more: try [law] scatter = \"grows\"; "
                                  "or look for a second failure mode.";
  return result;
}

}  // namespace wearwell
