#include "wearwell/models/fatigue/part_reading.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace wearwell::fatigue {

const std::vector<std::string>& stress_names() {
  static const std::vector<std::string> names = {
      "alternating_stress",     "mean_stress",      "stress_ratio", "max_stress", "min_stress",
      "displacement_amplitude", "displacement_mean"};
  return names;
}

PartReading::PartReading(const TomlReader& root, const SnData& data, MeanStress correction)
    : spring_(data.spring),
      tension_(correction == MeanStress::swt || correction == MeanStress::walker) {
  const TomlReader columns = root.required_table("data").required_table("columns");
  const auto conditions = root.table("conditions");
  columns_.push_back({"life", data.life_unit, true});
  for (const std::string& name : stress_names()) {
    const auto read = std::find_if(data.columns.begin(), data.columns.end(),
                                   [&](const DataColumn& each) { return each.name == name; });
    if (columns.has(name)) {
      if (read != data.columns.end()) columns_.push_back({name, read->unit, false, true});
    } else if (conditions && conditions->has(name)) {
      const bool length = name.starts_with("displacement");
      const std::string si = length ? "m" : name == "stress_ratio" ? "1" : data.stress_si;
      if (const auto value = conditions->quantity(name, si))
        constants_.emplace_back(name, value->si());
    }
  }
  Stress stress;
  if (columns_.size() == 1 && stress_of({}, stress).empty()) only_ = stress;
}

// A plain function of the names: each is in a column or is the same for all.
std::optional<double> PartReading::given(const std::string& name,
                                         const std::vector<double>& numbers) const {
  for (const auto& [constant, value] : constants_)
    if (constant == name) return value;
  for (std::size_t c = 1; c < columns_.size() && c < numbers.size(); ++c)
    if (columns_[c].name == name) return numbers[c];
  return {};
}

std::string PartReading::stress_of(const std::vector<double>& numbers, Stress& stress) const {
  const auto amplitude = given("displacement_amplitude", numbers);
  const auto high = given("max_stress", numbers), low = given("min_stress", numbers);
  if (amplitude && spring_) {
    if (!(*amplitude > 0)) return "displacement_amplitude must be positive";
    const double mean = given("displacement_mean", numbers).value_or(0);
    stress = {shear_stress(*spring_, *amplitude), shear_stress(*spring_, mean)};
  } else if (high && low) {
    if (!(*high > *low)) return "max_stress must be larger than min_stress";
    stress = {0.5 * (*high - *low), 0.5 * (*high + *low)};
  } else {
    const auto alternating = given("alternating_stress", numbers);
    const auto ratio = given("stress_ratio", numbers);
    if (!alternating || !(*alternating > 0)) return "alternating_stress must be positive";
    if (ratio && !(*ratio < 1))
      return "stress_ratio must be less than 1 (smallest over largest stress)";
    stress = {*alternating, ratio ? *alternating * (1 + *ratio) / (1 - *ratio)
                                  : given("mean_stress", numbers).value_or(0)};
  }
  if (tension_ && !(stress.mean + stress.alternating > 0))
    return "the largest stress is not tensile, so this mean-stress correction counts no damage";
  return {};
}

std::string PartReading::read(const std::vector<double>& numbers, double& cycles,
                              std::optional<Stress>& stress) const {
  stress.reset();
  cycles = numbers.at(0);
  if (std::isnan(cycles)) return "life is missing";
  if (!(cycles >= 0 && std::isfinite(cycles))) return "life must be 0 or more, and finite";
  std::size_t missing = 0;
  const std::string* first = nullptr;
  for (std::size_t c = 1; c < columns_.size(); ++c) {
    if (std::isnan(numbers.at(c))) {
      ++missing;
      if (!first) first = &columns_[c].name;
    } else if (!std::isfinite(numbers[c])) {
      return fmt::format("{} is not finite", columns_[c].name);
    }
  }
  if (missing + 1 == columns_.size()) {
    stress = only_;
    return {};
  }
  if (first)
    return fmt::format(
        "{} is missing: give all columns of the stress, or none where it is that of the reading "
        "before",
        *first);
  Stress read;
  const std::string problem = stress_of(numbers, read);
  if (problem.empty()) stress = read;
  return problem;
}

}  // namespace wearwell::fatigue
