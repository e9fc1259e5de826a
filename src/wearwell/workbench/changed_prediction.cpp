#include "wearwell/workbench/changed_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/workbench/study_form.h"

namespace wearwell::workbench {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t most_varied = 12;

constexpr std::string_view varied_keys[] = {
    "limit",  "given", "stress",    "accelerated",    "force",       "pressure",    "length",
    "radius", "speed", "clearance", "work_per_cycle", "mean_stress", "stress_ratio"};

// "predict.limit.wear" -> "limit"
bool is_varied(std::string_view path) {
  constexpr std::string_view section = "predict.";
  if (!path.starts_with(section)) return false;
  path.remove_prefix(section.size());
  const std::string_view key = path.substr(0, path.find('.'));
  return std::find(std::begin(varied_keys), std::end(varied_keys), key) != std::end(varied_keys);
}

// "60 um"; nothing for any other text.
std::optional<ordered_json> number_and_unit(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || number == 0) return {};
  std::string unit(end, text.data() + text.size());
  unit.erase(0, unit.find_first_not_of(' '));
  // "60 um +- 2 um", "20 x/ 1.2"
  if (unit.find_first_of("+=,x~") != unit.npos || unit.starts_with("to ")) return {};
  return ordered_json{{"number", number}, {"unit", printable(unit)}};
}

}  // namespace

ordered_json varied_predictions(const std::string& study, Models models) {
  ordered_json json = ordered_json::array();
  const ordered_json form = study_form("study.toml", study, models);
  for (const ordered_json& key : form.at("keys")) {
    const std::string path = key.at("path");
    if (!is_varied(path) || json.size() == most_varied) continue;
    if (auto value = number_and_unit(key.at("value").get<std::string>())) {
      ordered_json varied = {{"path", path}};
      varied.update(*value);
      json.push_back(std::move(varied));
    }
  }
  return json;
}

std::string with_predictions(const std::string& study, const nlohmann::json& changes,
                             Models models) {
  const ordered_json known = varied_predictions(study, models);
  std::string text = study;
  for (const auto& [path, value] : changes.items()) {
    const bool allowed = std::any_of(known.begin(), known.end(), [&](const ordered_json& each) {
      return each.at("path").get<std::string>() == path;
    });
    if (!allowed || !value.is_string())
      throw InputError(fmt::format(
          "{}: only numbers of [predict] that do not enter the posterior can be varied here",
          printable(shortened(path))));
    text = with_value(text, path, value.get<std::string>());
  }
  return text;
}

}  // namespace wearwell::workbench
