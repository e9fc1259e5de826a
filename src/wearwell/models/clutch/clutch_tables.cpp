#include "wearwell/models/clutch/clutch_tables.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iterator>
#include <set>
#include <unordered_map>
#include <unordered_set>

#include "wearwell/base/error.h"
#include "wearwell/input/labelled.h"

namespace wearwell::clutch {
namespace {

/// A column in SI, temperatures in degrees Celsius.
std::vector<double> column(const CampaignTable& from, const Input& input) {
  const ColumnChoice choice = from.numbers(input.name, input.si);
  if (input.value != &OperatingPoint::temperature) return si_numbers(from.table, choice);
  std::vector<double> values = kelvins(from.table, choice);
  for (double& value : values) value -= celsius_zero;
  return values;
}

std::vector<OperatingPoint> operating_points(const CampaignTable& from) {
  std::vector<OperatingPoint> points(from.table.rows);
  for (const Input& input : inputs) {
    const std::vector<double> values = column(from, input);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (input.value != &OperatingPoint::temperature && !(values[i] > 0))
        throw InputError(
            fmt::format("{}: must be positive",
                        place(from.table, from.numbers(input.name, input.si).column, i)));
      points[i].*input.value = values[i];
    }
  }
  return points;
}

/// Limits of int, and of integers in a double.
constexpr double most_plates = 2e9, most_cycles = 9e15;

std::vector<long long> whole_numbers(const CampaignTable& from, const std::string& name,
                                     long long least, double most) {
  std::vector<long long> whole;
  const ColumnChoice choice = from.numbers(name, name == "cycle" ? "cycle" : "1");
  const std::vector<double> values = si_numbers(from.table, choice);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto refuse = [&](const std::string& reason) {
      throw InputError(
          fmt::format("{}: {} {}", place(from.table, choice.column, i), values[i], reason));
    };
    if (values[i] != std::round(values[i]) || values[i] < static_cast<double>(least))
      refuse(fmt::format("must be a whole number of at least {}", least));
    if (values[i] > most) refuse(fmt::format("is too large; at most {:.0f} is possible", most));
    whole.push_back(static_cast<long long>(values[i]));
  }
  return whole;
}

/// Numbers of plates, or their places among `names`, from 1.
std::vector<long long> plates_of(const CampaignTable& from, const std::vector<std::string>& names) {
  if (names.empty()) return whole_numbers(from, "plate", 1, most_plates);
  std::unordered_map<std::string_view, long long> places;
  for (const std::string& name : names) places.emplace(name, std::ssize(places) + 1);
  const Column& words = from.words("plate");
  std::vector<long long> plates;
  for (std::size_t i = 0; i < from.table.rows; ++i)
    plates.push_back(places.at(cell_word(words, i)));
  return plates;
}

const std::vector<std::string>& texts(const CampaignTable& from, const std::string& name) {
  const Column& found = from.words(name);
  if (found.is_number)
    throw InputError(
        fmt::format("{}, column '{}' has numbers, but needs text", from.table.source, found.name));
  return found.text;
}

/// The block named by a text such as "point 17".
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
      throw InputError(fmt::format("'{}' is not a block", text));
  } else if (text.starts_with("sequence ") && text.size() > 9) {
    weighing.block = Block::sequence;
    weighing.sequence = text.substr(9);
  } else {
    throw InputError(fmt::format(
        "'{}' is not a block: use 'start', 'run-in', 'point 17', 'run-out', 'sequence NAME'",
        text));
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

ColumnChoice CampaignTable::numbers(const std::string& name, const std::string& si) const {
  if (columns) {
    if (const auto choice = read_column(*columns, name, si, table)) return *choice;
  }
  return find_labelled(table, name, si);
}

const Column& CampaignTable::words(const std::string& name) const {
  if (columns) {
    if (const auto choice = read_word_column(*columns, name, table))
      return table.column(choice->column);
  }
  return table.column(name);
}

std::vector<std::string> plate_names(const std::vector<const CampaignTable*>& tables) {
  bool numbers = true;
  for (const CampaignTable* each : tables) numbers = numbers && each->words("plate").is_number;
  if (numbers) return {};
  std::vector<std::string> names;
  std::unordered_set<std::string> seen;
  for (const CampaignTable* each : tables) {
    const Column& column = each->words("plate");
    for (std::size_t i = 0; i < each->table.rows; ++i) {
      const std::string name = label_word(each->table, column, i);
      if (seen.insert(name).second) names.push_back(name);
    }
  }
  return names;
}

std::vector<DesignPoint> read_design(const CampaignTable& from) {
  const std::vector<long long> numbers = whole_numbers(from, "point", 1, most_plates);
  const std::vector<std::string>& roles = texts(from, "role");
  const std::vector<OperatingPoint> at = operating_points(from);
  std::vector<DesignPoint> design;
  std::set<long long> seen;
  for (std::size_t i = 0; i < from.table.rows; ++i) {
    if (!seen.insert(numbers[i]).second)
      throw InputError(fmt::format("{}: point {} occurs twice",
                                   place(from.table, from.numbers("point", "1").column, i),
                                   numbers[i]));
    try {
      design.push_back({static_cast<int>(numbers[i]), read_role(roles[i]), at[i]});
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: {}", place(from.table, from.words("role").name, i), error.what()));
    }
  }
  return design;
}

std::vector<Cycle> read_cycles(const CampaignTable& from, const std::vector<std::string>& names) {
  const std::vector<long long> plates = plates_of(from, names);
  const std::vector<long long> numbers = whole_numbers(from, "cycle", 1, most_cycles);
  const std::vector<OperatingPoint> at = operating_points(from);
  const std::vector<double> energy = si_numbers(from.table, from.numbers("energy", "J"));
  std::vector<Cycle> cycles;
  for (std::size_t i = 0; i < from.table.rows; ++i)
    cycles.push_back({static_cast<int>(plates[i]), numbers[i], at[i], energy[i]});
  return cycles;
}

std::vector<Weighing> read_weighings(const CampaignTable& from,
                                     const std::vector<std::string>& names) {
  const std::vector<long long> plates = plates_of(from, names);
  const std::vector<long long> numbers = whole_numbers(from, "cycle", 0, most_cycles);
  const ColumnChoice mass_column = from.numbers("mass", "kg");
  const std::vector<double> mass = si_numbers(from.table, mass_column);
  const std::vector<std::string>& blocks = texts(from, "block");
  std::vector<Weighing> weighings;
  for (std::size_t i = 0; i < from.table.rows; ++i) {
    Weighing weighing{static_cast<int>(plates[i]), numbers[i], mass[i], Block::start, 0, {}};
    if (!(mass[i] > 0))
      throw InputError(
          fmt::format("{}: a mass must be positive", place(from.table, mass_column.column, i)));
    try {
      read_block(blocks[i], weighing);
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}: {}", place(from.table, from.words("block").name, i), error.what()));
    }
    weighings.push_back(std::move(weighing));
  }
  return weighings;
}

std::vector<Sample> read_traces(const CampaignTable& from, const std::vector<std::string>& names) {
  const std::vector<long long> plates = plates_of(from, names);
  const std::vector<double> time = si_numbers(from.table, from.numbers("time", "s"));
  const std::vector<double> speed = column(from, inputs[0]), torque = column(from, inputs[1]),
                            temperature = column(from, inputs[2]);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < from.table.rows; ++i)
    samples.push_back({static_cast<int>(plates[i]), time[i], speed[i], torque[i], temperature[i]});
  return samples;
}

std::vector<DesignPoint> read_design(const std::filesystem::path& file) {
  return read_design(CampaignTable{read_table(file)});
}
std::vector<Cycle> read_cycles(const std::filesystem::path& file) {
  const CampaignTable table{read_table(file)};
  return read_cycles(table, plate_names({&table}));
}
std::vector<Weighing> read_weighings(const std::filesystem::path& file) {
  const CampaignTable table{read_table(file)};
  return read_weighings(table, plate_names({&table}));
}
std::vector<Sample> read_traces(const std::filesystem::path& file) {
  const CampaignTable table{read_table(file)};
  return read_traces(table, plate_names({&table}));
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

std::vector<DataColumn> cycle_columns(const Campaign& campaign) {
  std::vector<DataColumn> columns;
  for (const Input& input : inputs) {
    const bool celsius = input.value == &OperatingPoint::temperature;
    columns.push_back({input.name, input.si, read_unit(celsius ? "degC" : input.si, input.si), {}});
    for (const Cycle& cycle : campaign.cycles)
      columns.back().values.push_back(cycle.at.*input.value + (celsius ? celsius_zero : 0));
  }
  return columns;
}

}  // namespace wearwell::clutch
