#include "wearwell/report/read_result.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/report/csv_reader.h"
#include "wearwell/report/json_reader.h"
#include "wearwell/report/plots_json.h"
#include "wearwell/report/read_summary.h"

namespace wearwell {
namespace {

// The parameters stand in the last columns, in their order.
std::size_t first_parameter(const CsvReader& csv, const std::filesystem::path& file,
                            const std::vector<ParameterSummary>& parameters) {
  const std::vector<std::string>& names = csv.heading();
  const bool fit = names.size() > parameters.size() &&
                   std::equal(parameters.rbegin(), parameters.rend(), names.rbegin(),
                              [](const auto& p, const auto& name) { return p.name == name; });
  if (!fit) {
    throw InputError(fmt::format("{}: its last columns are not the {} parameters of summary.json",
                                 file.string(), parameters.size()));
  }
  return names.size() - parameters.size();
}

// One chain: a line of names, lines of numbers, comments anywhere.
Chain read_chain(const std::filesystem::path& file,
                 const std::vector<ParameterSummary>& parameters) {
  CsvReader csv(file, "draw", "numbers");
  const std::vector<std::string>& names = csv.heading();
  const std::size_t first = first_parameter(csv, file, parameters);
  const auto found = std::find(names.begin(), names.end(), "divergent__");
  const auto divergent = static_cast<std::size_t>(found - names.begin());
  Chain chain;
  std::vector<double> values;
  while (csv.next()) {
    for (std::size_t c = first; c < names.size(); ++c) values.push_back(csv.number(c));
    if (found == names.end()) continue;
    NutsStep step{};
    step.divergent = csv.flag(divergent);
    chain.nuts.push_back(step);
  }
  if (values.empty()) throw InputError(fmt::format("{} holds no draws", file.string()));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const auto columns = static_cast<Eigen::Index>(parameters.size());
  chain.values = Eigen::Map<const RowMajor>(values.data(), std::ssize(values) / columns, columns);
  return chain;
}

}  // namespace

StudyResult read_result(const std::filesystem::path& folder) {
  const std::filesystem::path summary = folder / "summary.json", drawn = folder / "plots.json";
  StudyResult result;
  {
    const auto json = read_json(summary);
    result = read_summary(JsonReader(json, summary), folder);
  }
  if (std::filesystem::exists(drawn)) {
    const auto json = read_json(drawn);
    result.plots = plots_from_json(JsonReader(json, drawn));
    require_consistent(*result.plots, result, drawn);
  }
  for (int c = 1; c <= result.chains; ++c) {
    result.posterior_draws.push_back(
        read_chain(folder / fmt::format("draws_{}.csv", c), result.parameters));
  }
  return result;
}

}  // namespace wearwell
