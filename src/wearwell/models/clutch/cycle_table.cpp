#include "wearwell/models/clutch/cycle_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/labelled.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

Eigen::ArrayXd checked(const Table& table, const char* name, const char* si, bool positive) {
  const ColumnChoice column = find_labelled(table, name, si);
  const std::vector<double> values = si_numbers(table, column.column, column.unit);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (positive ? values[i] > 0 : values[i] >= 0) continue;
    throw InputError(
        fmt::format("{}: {} {}", place(table, column.column, i), from_si(column.unit, values[i]),
                    positive ? "must be a positive number" : "is below absolute zero"));
  }
  return Eigen::Map<const Eigen::ArrayXd>(values.data(), std::ssize(values));
}

std::vector<double> whole(const Table& table, const char* name, const char* si, double most) {
  const ColumnChoice column = find_labelled(table, name, si);
  std::vector<double> values = si_numbers(table, column.column, column.unit);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i] >= 1 && values[i] <= most && values[i] == std::trunc(values[i])) continue;
    throw InputError(fmt::format("{}: {} must be a whole number of at least 1",
                                 place(table, column.column, i), values[i]));
  }
  return values;
}

}  // namespace

CycleColumns cycle_columns(const Table& table, std::vector<std::string>& names) {
  constexpr double most_plates = 2e9, most_cycles = 9e15;
  CycleColumns cycles;
  const Column& plates = table.column("plate");
  if (plates.is_number) {
    cycles.plate = whole(table, "plate", "1", most_plates);
  } else {
    for (std::size_t i = 0; i < table.rows; ++i) {
      const std::string name = cell_word(plates, i);
      if (name.empty()) throw InputError(place(table, plates.name, i) + ": no value");
      const auto known = std::find(names.begin(), names.end(), name);
      cycles.plate.push_back(static_cast<double>(known - names.begin() + 1));
      if (known == names.end()) names.push_back(name);
    }
  }
  cycles.number = whole(table, "cycle", "cycle", most_cycles);
  cycles.slip_speed = checked(table, "slip_speed", "rad/s", true);
  cycles.torque = checked(table, "torque", "N m", true);
  cycles.temperature = checked(table, "temperature", "K", false) - celsius_zero;
  cycles.closing_time = checked(table, "closing_time", "s", true);
  cycles.energy = checked(table, "energy", "J", true);
  return cycles;
}

std::vector<std::string> energy_problems(const CycleSum& sum) {
  std::vector<std::string> problems;
  for (const PlateWear& p : sum.plates()) {
    if (!p.balance().is_plausible())
      problems.push_back(fmt::format("the energy of plate {} is {}. {}", printable(p.description()),
                                     p.balance().description(), energy_advice));
    if (const EnergyOutliers& far = p.outliers; far.count > 0)
      problems.push_back(fmt::format(
          "plate {}: {} with more than {:g} times the energy of a closing, 1/2 x torque x slip "
          "speed x closing time; the largest is cycle {}, {:.4g} J, {:.3g} times that. {}",
          printable(p.description()),
          far.count == 1 ? "1 cycle" : fmt::format("{} cycles", far.count), EnergyOutliers::most,
          far.worst_cycle, far.worst_energy, far.worst_ratio, energy_advice));
  }
  return problems;
}

nlohmann::ordered_json wear_json(const WearModel& model, const CycleSum& sum, bool full) {
  nlohmann::ordered_json plates = nlohmann::ordered_json::array();
  for (const PlateWear& p : sum.plates()) {
    nlohmann::ordered_json each = {{"plate", p.name.empty() ? nlohmann::ordered_json(p.plate)
                                                            : nlohmann::ordered_json(p.name)},
                                   {"cycles", p.cycles},
                                   {"last_cycle", p.last_number},
                                   {"energy", p.energy},
                                   {"energy_of_closings", p.closings},
                                   {"energy_outliers", p.outliers.count},
                                   {"volume", p.volume / mm3},
                                   {"sd_scatter", p.sd() / mm3}};
    if (full) each["sd_full"] = p.full_sd(model.plate_sd) / mm3;
    each["worn"] = p.volume / model.worn_out;
    nlohmann::ordered_json outside;
    for (std::size_t i = 0; i < inputs.size(); ++i) outside[inputs[i].name] = p.outside[i];
    each["outside"] = outside;
    each["outside_any"] = p.outside_any;
    each["clamped"] = p.clamped;
    each["skipped"] = p.skipped;
    plates.push_back(std::move(each));
  }
  const std::vector<std::string> problems = energy_problems(sum);
  return {{"units", {{"energy", "J"}, {"volume", "mm^3"}}},
          {"trusted", problems.empty()},
          {"problems", problems},
          {"plates", std::move(plates)}};
}

}  // namespace wearwell::clutch
