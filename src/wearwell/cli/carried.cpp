#include "wearwell/cli/carried.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/option_rules.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/prognosis/asked_life.h"
#include "wearwell/prognosis/update.h"

namespace wearwell {
namespace {

// summary.json of a folder; empty where the folder has none.
std::optional<nlohmann::ordered_json> summary_of(const std::filesystem::path& result) {
  const std::filesystem::path file = result / "summary.json";
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) return {};
  return read_json(file);
}

}  // namespace

prognosis::CarriedState read_carried_data(const std::filesystem::path& result) {
  std::error_code error;
  if (std::filesystem::is_directory(result, error) &&
      !std::filesystem::exists(result / "state.bin", error)) {
    const auto summary = summary_of(result);
    if (summary && summary->value("model", "") == "clutch-wear")
      throw InputError(fmt::format(
          "{}: the result does not hold the data of this clutch campaign: the campaign was "
          "simulated, an sql query reads one of its tables, two of its tables are one file, or an "
          "earlier version fitted it. Add the rows to its files and fit it again",
          valid_utf8(result.string())));
  }
  return prognosis::read_state(result);
}

prognosis::CarriedState read_carried(const std::filesystem::path& result) {
  prognosis::CarriedState state = read_carried_data(result);
  prognosis::require_posterior(state, valid_utf8(result.string()));
  return state;
}

SamplerChoice sampler_of(const std::filesystem::path& result) {
  const auto summary = summary_of(result);
  return summary ? prognosis::sampler_of_summary(*summary, result / "summary.json")
                 : SamplerChoice{};
}

}  // namespace wearwell
