#include "wearwell/workbench/priors.h"

#include <memory>

#include "wearwell/base/printable.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/prior_view.h"

namespace wearwell::workbench {

nlohmann::ordered_json priors_json(const std::filesystem::path& file, const std::string& text,
                                   Models models) {
  using nlohmann::ordered_json;
  ordered_json json = {{"priors", ordered_json::array()}, {"quantities", ordered_json::array()}};
  const std::unique_ptr<const Study> study = read_study({TextFile{file, text}}, models);
  const auto* const posterior = dynamic_cast<const PosteriorStudy*>(study.get());
  if (!posterior) {
    json["obstacle"] = "This study has no priors.";
    return json;
  }
  const PriorView view = prior_view(*posterior);
  for (const PriorPicture& each : view.priors)
    json["priors"].push_back({{"name", printable(each.name)},
                              {"meaning", printable(each.meaning)},
                              {"unit", each.unit},
                              {"proper", each.proper},
                              {"q05", each.q05},
                              {"q50", each.q50},
                              {"q95", each.q95},
                              {"log", each.log},
                              {"x", each.curve.x},
                              {"y", each.curve.y}});
  for (const QuantitySummary& each : view.quantities)
    json["quantities"].push_back({{"name", printable(life_label(each))},
                                  {"unit", each.unit},
                                  {"q05", each.best().q05},
                                  {"q50", each.best().q50},
                                  {"q95", each.best().q95}});
  if (!view.obstacle.empty()) json["obstacle"] = printable_lines(view.obstacle);
  return json;
}

}  // namespace wearwell::workbench
