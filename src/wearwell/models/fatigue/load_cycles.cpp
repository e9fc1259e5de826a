#include "wearwell/models/fatigue/load_cycles.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/models/fatigue/history_state.h"

namespace wearwell::fatigue {
namespace {

// From the unit of the load to that of the curve's stress quantity, in SI.
double to_si_of_curve(const std::string& unit, const std::string& scale, const std::string& where,
                      const std::string& si) {
  const Dimension wanted = parse_unit(si)->dimension;
  const auto load = parse_unit(unit.empty() ? "1" : unit);
  if (!load) throw InputError(fmt::format("{}: '{}' is not a unit", where, unit));
  if (unit.empty())
    throw InputError(
        scale.empty()
            ? fmt::format("{} has no unit: give it in the heading, \"{}\", or with --unit {}",
                          where, si == "Pa" ? "stress [MPa]" : fmt::format("load [{}]", si),
                          si == "Pa" ? "MPa" : si)
            : fmt::format(
                  "{} has no unit, but --scale {} applies per unit of it: give um/m or a plain "
                  "number in the heading or with --unit: um/m, N, or 1 for a plain number",
                  where, scale));
  if (scale.empty()) {
    if (load->dimension == wanted) return load->scale;
    if (si != "Pa")
      throw InputError(fmt::format(
          "{} is in {}, but the study's tests are in {}; give the conversion with --scale", where,
          unit,
          si == "1" ? "as a strain or a plain number" : fmt::format("in the dimension of {}", si)));
    const bool strain = load->dimension.empty();
    throw InputError(fmt::format(
        "{} is in {}, which is {}, not a stress; give the factor to stress: --scale '{}'", where,
        unit, strain ? "a strain or a plain number" : "a load",
        strain ? "206 GPa" : fmt::format("0.35 MPa/{}", unit)));
  }
  std::size_t end = 0;
  double factor = 0;
  try {
    factor = std::stod(scale, &end);
  } catch (const std::exception&) {
    throw InputError(fmt::format("--scale: '{}' does not start with a number", scale));
  }
  const std::string text = scale.substr(std::min(scale.size(), scale.find_first_not_of(' ', end)));
  const auto per = parse_unit(text.empty() ? "1" : text);
  if (!per) throw InputError(fmt::format("--scale: '{}' is not a unit", text));
  Dimension product = per->dimension;
  for (const auto& [base, power] : load->dimension) {
    if ((product[base] += power) == 0) product.erase(base);
  }
  if (product != wanted)
    throw InputError(fmt::format("--scale: {} times a load in {} is not a {}", scale, unit,
                                 si == "Pa" ? "stress"
                                 : si == "1"
                                     ? "strain or plain number, as the study's tests are"
                                     : fmt::format("load in {}, as the study's tests are", si)));
  if (!(std::abs(factor) > 0 && std::isfinite(factor)) || load->offset != 0 || per->offset != 0)
    throw InputError(fmt::format("--scale: {} is not a factor", scale));
  return factor * per->scale * load->scale;
}

const Column* named(const Table& table, std::initializer_list<const char*> names) {
  for (const char* name : names) {
    for (const Column& column : table.columns) {
      if (column.name == name || load_heading(column).name == name) return &column;
    }
  }
  return nullptr;
}

// A contradiction between the table and --unit is an error.
std::string unit_in(const Column& column, const std::string& given, const std::string& where) {
  const std::string said = load_heading(column).unit;
  if (given.empty()) return said;
  const auto one = parse_unit(said.empty() ? given : said), other = parse_unit(given);
  if (!other) throw InputError(fmt::format("--unit: '{}' is not a unit", given));
  if (one && (one->dimension != other->dimension || one->scale != other->scale))
    throw InputError(fmt::format("{}: the table has {} and --unit has {}; remove one of them",
                                 where, said, given));
  return given;
}

// Effect of the options on a column, for descriptions.
std::string options_text(const BlockChoice& choice) {
  return (choice.signal.unit.empty() ? "" : fmt::format(" in {}", choice.signal.unit)) +
         (choice.scale.empty() ? "" : fmt::format(", times {}", choice.scale));
}

double largest_amplitude(const LoadCycles& cycles) {
  double largest = 0;
  for (const LoadCycle& each : cycles) largest = std::max(largest, each.stress.alternating);
  return largest;
}

Block counted_signal(const BlockChoice& choice) {
  SignalFile file(choice.signal);
  const double pascal = to_si_of_curve(file.unit(), choice.scale,
                                       fmt::format("{}, column '{}'", file.source(), file.column()),
                                       choice.stress_si);
  LoadHistory history(choice.rule);
  for (auto samples = file.next(); !samples.empty(); samples = file.next()) history.add(samples);
  const LoadHistory::Counted counted = history.counted();
  if (counted.classes.cells().empty())
    throw InputError(fmt::format(
        "{}, column '{}' has {} and no cycle", file.source(), file.column(),
        counted.samples == 1 ? "one sample" : fmt::format("{} throughout", counted.lowest)));
  Block block;
  if (choice.timed) block.seconds = file.seconds();
  for (const CycleClass& each : counted.classes.classes()) {
    block.cycles.push_back({{0.5 * std::abs(pascal) * each.range, pascal * each.mean}, each.count});
    block.count += each.count;
  }
  block.description = fmt::format(
      "{} samples of {}, column '{}'{}; {} rainflow counting, {}", counted.samples, file.source(),
      file.column(), options_text(choice), counting_name(choice.rule.counting),
      choice.rule.residual == Residual::half ? "the residual in half cycles"
                                             : "the history repeated");
  if (!choice.with_mean) {
    for (const LoadCycle& each : block.cycles)
      block.largest_mean_left_out =
          std::max(block.largest_mean_left_out, std::abs(each.stress.mean));
  }
  return block;
}

// A table with a row for each class of cycles.
class CountedTable {
 public:
  CountedTable(const BlockChoice& choice, Table table) : choice_(choice), table_(std::move(table)) {
    size_ = named(table_, {"range", "stress_range", "load_range", "force_range", "strain_range"});
    amplitude_ = named(table_, {"amplitude", "alternating_stress", "stress_amplitude",
                                "load_amplitude", "force_amplitude", "strain_amplitude"});
    count_ = named(table_, {"cycles", "count", "n"});
    mean_ = named(table_, {"mean", "mean_stress", "mean_load", "mean_force", "mean_strain"});
    ratio_ = named(table_, {"stress_ratio", "R"});
  }

  bool is_one() const { return (size_ || amplitude_) && count_; }
  bool doubtful() const { return (size_ || amplitude_ || count_) && !is_one(); }
  std::string doubt() const {
    if (count_)
      return fmt::format(
          "column '{}' counts cycles, but no column is called range or amplitude: name the counted "
          "column range (from valley to peak) or amplitude (half of it); or, for a signal, name "
          "its column: --column NAME",
          count_->name);
    return fmt::format(
        "column '{}' may be a signal or a class of counted cycles: for a signal name its column: "
        "--column NAME; for counted cycles add a column 'cycles'",
        (size_ ? size_ : amplitude_)->name);
  }

  Block read() const {
    if (size_ && amplitude_)
      throw InputError(
          fmt::format("{} has '{}' and '{}': a range is twice an amplitude; remove one",
                      table_.source, size_->name, amplitude_->name));
    if (choice_.with_mean && (mean_ != nullptr) == (ratio_ != nullptr))
      throw InputError(
          fmt::format("{}: the study's model needs the mean stress: add one of the columns 'mean' "
                      "and 'stress_ratio'",
                      table_.source));
    const Column& size = size_ ? *size_ : *amplitude_;
    const double factor = (size_ ? 0.5 : 1) * std::abs(pascal(size));
    const double mean_factor = mean_ ? pascal(*mean_) : 0;
    Block block;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      const double count = cell(*count_, i);
      if (!(count >= 0)) fail(*count_, i, "is not a number of cycles");
      const double amplitude = factor * cell(size, i);
      if (!(amplitude > 0)) fail(size, i, "must be positive");
      double mean = mean_ && choice_.with_mean ? mean_factor * cell(*mean_, i) : 0;
      if (ratio_ && choice_.with_mean) {
        const double r = cell(*ratio_, i);
        if (!(r < 1)) fail(*ratio_, i, "must be less than 1 (smallest over largest stress)");
        mean = amplitude * (1 + r) / (1 - r);
      }
      block.cycles.push_back({{amplitude, mean}, count});
      block.count += count;
    }
    if (!(block.count > 0)) throw InputError(fmt::format("{} has no cycle", table_.source));
    block.description =
        fmt::format("{} classes of counted cycles of {}, by {} '{}'{}", table_.rows, table_.source,
                    size_ ? "the range" : "the amplitude", size.name, options_text(choice_));
    if (const Column* mean = mean_ ? mean_ : ratio_; mean && !choice_.with_mean)
      block.description +=
          fmt::format("; '{}' is ignored, since the study's model has no mean stress", mean->name);
    return block;
  }

 private:
  double pascal(const Column& column) const {
    const std::string where = fmt::format("{}, column '{}'", table_.source, column.name);
    return to_si_of_curve(unit_in(column, choice_.signal.unit, where), choice_.scale, where,
                          choice_.stress_si);
  }
  double cell(const Column& column, std::size_t row) const {
    const double value = cell_number(table_, column, row);
    if (!std::isfinite(value)) fail(column, row, "is not a number");
    return value;
  }
  [[noreturn]] void fail(const Column& column, std::size_t row, const char* what) const {
    throw InputError(
        fmt::format("{}: '{}' {}", place(table_, column.name, row), cell_word(column, row), what));
  }

  const BlockChoice& choice_;
  Table table_;
  const Column *size_, *amplitude_, *count_, *mean_, *ratio_;
};

}  // namespace

Block read_block(const BlockChoice& choice) {
  if (choice.signal.column.empty()) {
    const Table* const table = choice.signal.table;
    const CountedTable headings(choice, signal_headings(choice.signal));
    if (headings.is_one() && !choice.signal.time.empty())
      throw InputError(fmt::format(
          "{} is a table of counted cycles, which has no times: remove --time and give the use of "
          "one block with --block; or for a signal name its column: --column NAME",
          choice.signal.source()));
    if (headings.is_one())
      return CountedTable(choice, table ? *table : read_table(choice.signal.file)).read();
    if (headings.doubtful())
      throw InputError(fmt::format("{}: {}", choice.signal.source(), headings.doubt()));
  }
  return counted_signal(choice);
}

LoadCycles reduced(const LoadCycles& cycles, std::size_t most, bool with_mean) {
  LoadCycles result = cycles;
  if (!with_mean) {
    for (LoadCycle& each : result) each.stress.mean = 0;
  }
  double width = std::ldexp(largest_amplitude(cycles), -24);
  while (width > 0) {
    std::map<std::pair<long long, long long>, std::size_t> places;
    LoadCycles wide;
    for (const LoadCycle& each : result) {
      const auto [at, fresh] = places.emplace(
          std::pair{static_cast<long long>(std::floor(each.stress.alternating / width)),
                    static_cast<long long>(std::floor(each.stress.mean / width))},
          wide.size());
      if (fresh) {
        wide.push_back(each);
        continue;
      }
      LoadCycle& cell = wide[at->second];
      cell.count += each.count;
      if (!(cell.count > 0)) continue;
      const double share = each.count / cell.count;
      cell.stress.alternating += share * (each.stress.alternating - cell.stress.alternating);
      cell.stress.mean += share * (each.stress.mean - cell.stress.mean);
    }
    result = std::move(wide);
    if (result.size() <= most) break;
    width *= 2;
  }
  std::sort(result.begin(), result.end(), [](const LoadCycle& a, const LoadCycle& b) {
    return a.stress.alternating > b.stress.alternating;
  });
  return result;
}

}  // namespace wearwell::fatigue
