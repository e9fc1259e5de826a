#include "wearwell/workbench/priors.h"

#include <memory>

#include "wearwell/base/printable.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/prior_view.h"
#include "wearwell/workbench/prior_handles.h"
#include "wearwell/workbench/study_form.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

// `specification` is what a later move of a handle needs beside the text.
ordered_json picture_json(const PriorPicture& each, const TomlReader& study,
                          const Parameter& parameter) {
  ordered_json json = {{"name", printable(each.name)},
                       {"meaning", printable(each.meaning)},
                       {"unit", each.unit},
                       {"proper", each.proper},
                       {"q05", each.q05},
                       {"q50", each.q50},
                       {"q95", each.q95},
                       {"log", each.log},
                       {"x", each.curve.x},
                       {"y", each.curve.y},
                       {"handles", ordered_json::array()},
                       {"specification",
                        {{"name", parameter.name},
                         {"si", parameter.si},
                         {"lower", parameter.natural_lower},
                         {"upper", parameter.natural_upper}}}};
  for (const PriorHandle& handle : prior_handles(study, parameter))
    json["handles"].push_back({{"name", std::string(handle.name)}, {"at", handle.at}});
  return json;
}

ParameterSpec specification_of(const nlohmann::json& json) {
  ParameterSpec spec{json.at("name").get<std::string>(), json.at("si").get<std::string>()};
  if (json.at("lower").is_number()) spec.natural_lower = json.at("lower").get<double>();
  if (json.at("upper").is_number()) spec.natural_upper = json.at("upper").get<double>();
  return spec;
}

}  // namespace

ordered_json priors_json(const std::filesystem::path& file, const std::string& text,
                         Models models) {
  ordered_json json = {{"priors", ordered_json::array()}, {"quantities", ordered_json::array()}};
  const TextFile source{file, text};
  const std::unique_ptr<const Study> study = read_study({source}, models);
  const auto* const posterior = dynamic_cast<const PosteriorStudy*>(study.get());
  if (!posterior) {
    json["obstacle"] = "This study has no priors.";
    return json;
  }
  const PriorView view = prior_view(*posterior);
  const TomlReader root = TomlReader::parse(source);
  auto picture = view.priors.begin();
  for (const Parameter& each : posterior->parameters)
    if (!each.of_model) json["priors"].push_back(picture_json(*picture++, root, each));
  for (const QuantitySummary& each : view.quantities)
    json["quantities"].push_back({{"name", printable(life_label(each))},
                                  {"unit", each.unit},
                                  {"q05", each.best().q05},
                                  {"q50", each.best().q50},
                                  {"q95", each.best().q95}});
  if (!view.obstacle.empty()) json["obstacle"] = printable_lines(view.obstacle);
  return json;
}

ordered_json moved_prior_json(const std::string& text, const nlohmann::json& wish) {
  const MovedPrior moved =
      moved_prior(text, specification_of(wish.at("specification")),
                  wish.at("handle").get<std::string>(), wish.at("at").get<double>());
  const std::string meaning = wish.value("meaning", "");
  ordered_json json = {{"text", moved.text}, {"values", ordered_json::array()}};
  const TomlReader study = TomlReader::parse({"the study", moved.text});
  json["prior"] = picture_json(prior_picture(moved.parameter, meaning), study, moved.parameter);
  for (const std::string& path : moved.paths)
    json["values"].push_back({{"path", path}, {"value", value_of(moved.text, path)}});
  return json;
}

}  // namespace wearwell::workbench
