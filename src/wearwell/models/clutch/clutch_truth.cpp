#include "wearwell/models/clutch/clutch_truth.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_tables.h"

namespace wearwell::clutch {
namespace {

double positive(const TomlReader& table, const char* key, const char* si) {
  const double value = table.required_quantity(key, si).si();
  if (!(value > 0)) table.fail(key, "must be positive");
  return value;
}

double not_negative(const TomlReader& table, const char* key, const char* si) {
  const double value = table.required_quantity(key, si).si();
  if (!(value >= 0)) table.fail(key, "must not be negative");
  return value;
}

/// "ds*ds*Td" into powers; "1" is the constant.
Truth::Term read_term(const TomlReader& terms, const std::string& name) {
  Truth::Term term{0, 0, 0, terms.required_quantity(name, "m^3/J").si()};
  if (name == "1") return term;
  for (std::size_t from = 0; from <= name.size();) {
    const std::size_t end = std::min(name.find('*', from), name.size());
    const std::string factor = name.substr(from, end - from);
    if (factor == "ds") {
      ++term.ds;
    } else if (factor == "Td") {
      ++term.temperature;
    } else if (factor == "Mz") {
      ++term.torque;
    } else {
      terms.fail(name, "is not a product of ds, Td and Mz");
    }
    from = end + 1;
  }
  return term;
}

ScatterLaw read_scatter(const TomlReader& table) {
  const auto kind = table.choice("kind", {"exponential", "linear", "quadratic", "conditions"});
  if (!kind) table.fail("kind", "is missing");
  ScatterLaw law{read_scatter_kind(*kind), {}};
  // Units of the parameters: see wear_law.h.
  static constexpr const char* units[][5] = {
      {"m^3/J", "J/m^3", "", "", ""},
      {"m^3/J", "1", "", "", ""},
      {"m^3/J", "1", "J/m^3", "", ""},
      {"m^3/J", "m^3/(J K)", "m^3 s/(J rad)", "m^3/(J N m)", "m^3/(J s)"}};
  for (int i = 0; i < size_of(law.kind); ++i) {
    const std::string key = fmt::format("p{}", i + 1);
    const Quantity p = table.required_quantity(key, units[static_cast<int>(law.kind)][i]);
    law.p.push_back(p.value * p.unit.scale);  // not a temperature, but a slope by temperature
  }
  return law;
}

}  // namespace

double read_celsius(const TomlReader& table, const char* key) {
  return table.required_quantity(key, "K").si() - celsius_zero;
}

OperatingPoint read_operating_point(const TomlReader& table) {
  return {positive(table, "slip_speed", "rad/s"), positive(table, "torque", "N m"),
          read_celsius(table, "temperature"), positive(table, "closing_time", "s")};
}

Lining read_lining(const TomlReader& root) {
  const TomlReader lining = root.required_table("lining");
  const TomlReader balance = root.required_table("balance");
  return {positive(lining, "density", "kg/m^3"),
          positive(lining, "depth", "m") * positive(lining, "area", "m^2"),
          not_negative(balance, "sd", "kg")};
}

Truth read_truth(const std::filesystem::path& file) {
  const TomlReader root = TomlReader::parse_file(file);
  Truth truth;
  const TomlReader map = root.required_table("map");
  truth.r = positive(map, "r", "1");
  truth.q = positive(map, "q", "1");
  truth.reference = read_operating_point(map.required_table("reference"));
  const TomlReader terms = map.required_table("terms");
  for (const std::string& name : terms.keys()) truth.terms.push_back(read_term(terms, name));
  if (truth.terms.empty()) map.fail("terms", "is empty");

  const TomlReader run_in = root.required_table("run_in");
  truth.run_in = {not_negative(run_in, "slow", "1"), not_negative(run_in, "fast", "1"),
                  positive(run_in, "slow_energy", "J"), positive(run_in, "fast_energy", "J")};
  truth.run_in_point = read_operating_point(run_in);
  for (const Quantity& each : run_in.quantities("weighings", "cycle")) {
    const double cycles = each.si();
    const bool ascends = truth.run_in_weighings.empty() ||
                         cycles > static_cast<double>(truth.run_in_weighings.back());
    if (!(cycles >= 1 && cycles <= 1e6) || cycles != std::round(cycles) || !ascends)
      run_in.fail("weighings", "must be integers in ascending order");
    truth.run_in_weighings.push_back(static_cast<long long>(cycles));
  }
  constexpr long long most = 1'000'000;
  truth.run_out_cycles = run_in.integer("run_out_cycles", 1, most).value_or(750);

  truth.scatter = read_scatter(root.required_table("scatter"));
  const TomlReader plates = root.required_table("plates");
  truth.plates = static_cast<int>(plates.integer("count", 1, 1000).value_or(13));
  truth.plate_sd = not_negative(plates, "sd", "1");
  truth.least_cycles = plates.integer("least_cycles", 1, most).value_or(750);
  truth.least_mass = not_negative(plates, "least_mass", "kg");
  const Lining lining = read_lining(root);
  truth.density = lining.density;
  truth.balance_sd = lining.balance_sd;
  truth.worn_out = lining.worn_out;
  truth.sequence_weighings =
      static_cast<int>(plates.integer("sequence_weighings", 1, 10'000).value_or(12));
  root.finish();
  return truth;
}

}  // namespace wearwell::clutch
