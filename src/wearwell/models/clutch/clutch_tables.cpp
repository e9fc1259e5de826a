#include "wearwell/models/clutch/clutch_tables.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <set>

#include "wearwell/base/error.h"

namespace wearwell::clutch {
namespace {

/// A column in SI, temperatures in degrees Celsius.
std::vector<double> column(const Table& table, const Input& input) {
  std::vector<double> values = labelled_numbers(table, input.name, input.si);
  if (input.value == &OperatingPoint::temperature) {
    for (double& value : values) value -= celsius_zero;
  }
  return values;
}

std::vector<OperatingPoint> operating_points(const Table& table) {
  std::vector<OperatingPoint> points(table.rows);
  for (const Input& input : inputs) {
    const std::vector<double> values = column(table, input);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (input.value != &OperatingPoint::temperature && !(values[i] > 0))
        throw InputError(
            fmt::format("{}: must be positive",
                        place(table, find_labelled(table, input.name, input.si).heading, i)));
      points[i].*input.value = values[i];
    }
  }
  return points;
}

/// What an int holds, and what a double tells apart.
constexpr double most_plates = 2e9, most_cycles = 9e15;

std::vector<long long> whole_numbers(const Table& table, std::string_view name, long long least,
                                     double most) {
  std::vector<long long> whole;
  const std::vector<double> values = labelled_numbers(table, name, name == "cycle" ? "cycle" : "1");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto refuse = [&](const std::string& reason) {
      const std::string heading = find_labelled(table, name, "1").heading;
      throw InputError(fmt::format("{}: {} {}", place(table, heading, i), values[i], reason));
    };
    if (values[i] != std::round(values[i]) || values[i] < static_cast<double>(least))
      refuse(fmt::format("must be a whole number of at least {}", least));
    if (values[i] > most) refuse(fmt::format("is too large; at most {:.0f} is possible", most));
    whole.push_back(static_cast<long long>(values[i]));
  }
  return whole;
}

const std::vector<std::string>& texts(const Table& table, std::string_view name) {
  const Column& found = table.column(name);
  if (found.is_number)
    throw InputError(fmt::format("{}, column '{}' holds numbers, not words", table.source, name));
  return found.text;
}

/// What "point 17" says.
void read_block(const std::string& text, Weighing& weighing) {
  if (text == "start") {
    weighing.block = Block::start;
  } else if (text == "run-in") {
    weighing.block = Block::run_in;
  } else if (text == "run-out") {
    weighing.block = Block::run_out;
  } else if (text.starts_with("point ")) {
    weighing.block = Block::point;
    const auto [rest, failure] =
        std::from_chars(text.data() + 6, text.data() + text.size(), weighing.point);
    if (failure != std::errc{} || rest != text.data() + text.size() || weighing.point < 1)
      throw InputError(fmt::format("'{}' is no block", text));
  } else if (text.starts_with("sequence ") && text.size() > 9) {
    weighing.block = Block::sequence;
    weighing.sequence = text.substr(9);
  } else {
    throw InputError(fmt::format(
        "'{}' is no block: 'start', 'run-in', 'point 17', 'run-out', 'sequence NAME'", text));
  }
}

std::string name_of_block(const Weighing& weighing) {
  switch (weighing.block) {
    case Block::start:
      return "start";
    case Block::run_in:
      return "run-in";
    case Block::point:
      return fmt::format("point {}", weighing.point);
    case Block::run_out:
      return "run-out";
    case Block::sequence:
      break;
  }
  return "sequence " + weighing.sequence;
}

using Out = std::back_insert_iterator<std::string>;

void write_point(Out out, const OperatingPoint& at) {
  fmt::format_to(out, "{:.9g},{:.9g},{:.9g},{:.9g}", at.slip_speed / rpm, at.torque, at.temperature,
                 at.closing_time);
}

constexpr const char* point_headings =
    "slip_speed [rpm],torque [N m],temperature [degC],closing_time [s]";

}  // namespace

std::vector<DesignPoint> read_design(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const std::vector<long long> numbers = whole_numbers(table, "point", 1, most_plates);
  const std::vector<std::string>& roles = texts(table, "role");
  const std::vector<OperatingPoint> at = operating_points(table);
  std::vector<DesignPoint> design;
  std::set<long long> seen;
  for (std::size_t i = 0; i < table.rows; ++i) {
    if (!seen.insert(numbers[i]).second)
      throw InputError(
          fmt::format("{}: point {} is planned twice", place(table, "point", i), numbers[i]));
    try {
      design.push_back({static_cast<int>(numbers[i]), read_role(roles[i]), at[i]});
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", place(table, "role", i), error.what()));
    }
  }
  return design;
}

std::vector<Cycle> read_cycles(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const std::vector<long long> plates = whole_numbers(table, "plate", 1, most_plates);
  const std::vector<long long> numbers = whole_numbers(table, "cycle", 1, most_cycles);
  const std::vector<OperatingPoint> at = operating_points(table);
  const std::vector<double> energy = labelled_numbers(table, "energy", "J");
  std::vector<Cycle> cycles;
  for (std::size_t i = 0; i < table.rows; ++i)
    cycles.push_back({static_cast<int>(plates[i]), numbers[i], at[i], energy[i]});
  return cycles;
}

std::vector<Weighing> read_weighings(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const std::vector<long long> plates = whole_numbers(table, "plate", 1, most_plates);
  const std::vector<long long> numbers = whole_numbers(table, "cycle", 0, most_cycles);
  const std::vector<double> mass = labelled_numbers(table, "mass", "kg");
  const std::vector<std::string>& blocks = texts(table, "block");
  std::vector<Weighing> weighings;
  for (std::size_t i = 0; i < table.rows; ++i) {
    Weighing weighing{static_cast<int>(plates[i]), numbers[i], mass[i], Block::start, 0, {}};
    if (!(mass[i] > 0))
      throw InputError(fmt::format("{}: a mass must be positive",
                                   place(table, find_labelled(table, "mass", "kg").heading, i)));
    try {
      read_block(blocks[i], weighing);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: {}", place(table, "block", i), error.what()));
    }
    weighings.push_back(std::move(weighing));
  }
  return weighings;
}

std::vector<Sample> read_traces(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const std::vector<long long> plates = whole_numbers(table, "plate", 1, most_plates);
  const std::vector<double> time = labelled_numbers(table, "time", "s");
  const std::vector<double> speed = column(table, inputs[0]), torque = column(table, inputs[1]),
                            temperature = column(table, inputs[2]);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < table.rows; ++i)
    samples.push_back({static_cast<int>(plates[i]), time[i], speed[i], torque[i], temperature[i]});
  return samples;
}

std::string design_csv(const std::vector<DesignPoint>& design) {
  std::string csv = fmt::format("point,role,{}\n", point_headings);
  const Out out(csv);
  for (const DesignPoint& point : design) {
    fmt::format_to(out, "{},{},", point.number, name_of(point.role));
    write_point(out, point.at);
    csv += '\n';
  }
  return csv;
}

std::string cycles_csv(const std::vector<Cycle>& cycles) {
  std::string csv = fmt::format("plate,cycle,{},energy [J]\n", point_headings);
  const Out out(csv);
  for (const Cycle& cycle : cycles) {
    fmt::format_to(out, "{},{},", cycle.plate, cycle.number);
    write_point(out, cycle.at);
    fmt::format_to(out, ",{:.9g}\n", cycle.energy);
  }
  return csv;
}

std::string weighings_csv(const std::vector<Weighing>& weighings) {
  std::string csv = "plate,cycle,block,mass [g]\n";
  for (const Weighing& weighing : weighings)
    fmt::format_to(Out(csv), "{},{},{},{:.9g}\n", weighing.plate, weighing.cycle,
                   name_of_block(weighing), weighing.mass * 1e3);
  return csv;
}

std::string traces_csv(const std::vector<Sample>& samples) {
  std::string csv = "plate,time [s],slip_speed [rad/s],torque [N m],temperature [degC]\n";
  for (const Sample& s : samples)
    fmt::format_to(Out(csv), "{},{:.9g},{:.9g},{:.9g},{:.9g}\n", s.plate, s.time, s.slip_speed,
                   s.torque, s.temperature);
  return csv;
}

std::string closings_csv(const std::vector<Closing>& closings) {
  std::string csv = fmt::format("plate,cycle,{},energy [J],start [s],flag\n", point_headings);
  const Out out(csv);
  for (const Closing& closing : closings) {
    fmt::format_to(out, "{},{},", closing.cycle.plate, closing.cycle.number);
    write_point(out, closing.cycle.at);
    fmt::format_to(out, ",{:.9g},{:.9g},{}\n", closing.cycle.energy, closing.start, closing.flag);
  }
  return csv;
}

std::string realized_csv(const std::vector<Realized>& realized) {
  std::string csv = "plate,cycle,volume [mm^3]\n";
  for (const Realized& each : realized)
    fmt::format_to(Out(csv), "{},{},{:.9g}\n", each.plate, each.cycle, each.volume / mm3);
  return csv;
}

}  // namespace wearwell::clutch
