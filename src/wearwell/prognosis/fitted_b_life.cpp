#include "wearwell/prognosis/fitted_b_life.h"

#include <fmt/format.h>

#include <utility>
#include <vector>

#include "wearwell/input/toml_edit.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/prognosis/named_life.h"
#include "wearwell/prognosis/required_lives.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/life_levels.h"

namespace wearwell::prognosis {
namespace {

// The study with this B-life and its lower bound, without answers that cost time.
Source with_b_life(const Source& source, double share, double level) {
  const auto predict = TomlReader::parse(source.study).table("predict");
  const auto has = [&](const char* key) { return predict && predict->has(key); };
  std::vector<std::pair<std::string, std::string>> keys = {
      {"b_lives", fmt::format("[{}]", 100 * share)},
      {has("credible_level") ? "credible_level" : "level", fmt::format("{}", level)},
      {"sides", "\"lower\""}};
  if (has("mean_life")) keys.emplace_back("mean_life", "false");
  Source asked = source;
  asked.study = with_predict(source.study, keys);
  return asked;
}

}  // namespace

std::optional<FittedBLife> fitted_b_life(const CarriedState& state, Models models,
                                         const std::string& title, const std::string& point,
                                         double share, double level) {
  const auto study = read_study(with_b_life(state.source, share, level), models);
  const std::vector<NamedLife> lives = required_lives(require_posterior_study(*study), title);
  const NamedLife life = life_named(lives, point, "--at");
  const std::string name = b_life_name(100 * share, life.request->name);
  const auto& requests = life.group->requests;
  for (std::size_t i = 0; i < requests.size(); ++i) {
    const QuantityRequest& each = requests[i];
    const bool same_units = each.of == life.request->of || each.of == without_new(life.request->of);
    if (each.name != name || each.at != life.request->at || !same_units) continue;
    const QuantityQuantiles found = life.group->from_draws(state.posterior)[i];
    if (!found.bound || !found.predictive) return {};
    return FittedBLife{*found.predictive, *found.bound, found.numerical_error};
  }
  return {};
}

}  // namespace wearwell::prognosis
