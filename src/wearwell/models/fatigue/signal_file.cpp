#include "wearwell/models/fatigue/signal_file.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/base/unit.h"
#include "wearwell/base/unit_hint.h"
#include "wearwell/base/unit_system.h"
#include "wearwell/input/heading.h"

namespace wearwell::fatigue {
namespace {

// A step longer than this multiple of the first is a gap.
constexpr double longest_step = 1.5;
// The squares of larger ranges overflow.
constexpr double largest = 1e150;

bool is_time(const Column& column) {
  const Heading heading = read_heading(column.name, "s");
  if (heading.name == "time" || heading.name == "t") return true;
  const auto unit = parse_unit(load_heading(column).unit);
  return unit && unit->dimension == Dimension{{"second", 1}};
}

}  // namespace

Heading load_heading(const Column& column) {
  if (!column.unit.empty()) return {column.name, column.unit, true};
  if (const Heading any = read_heading(column.name, ""); any.certain) return any;
  for (const char* si : {"Pa", "N", "N m", "1"}) {
    const Heading heading = read_heading(column.name, si);
    // "load_N" may be the load of N.
    if (!heading.unit.empty() && (!heading.suffix || si == std::string_view("Pa"))) return heading;
  }
  return {column.name, "", false};
}

Table signal_headings(const SignalChoice& choice) {
  if (!choice.table) return ColumnStream(choice.file).columns();
  Table headings{choice.table->source, {}};
  for (const Column& column : choice.table->columns)
    headings.columns.push_back({column.name, column.is_number, {}, {}, column.unit});
  return headings;
}

SignalFile::SignalFile(const SignalChoice& choice)
    : table_(choice.table), stop_(choice.stop), source_(choice.source()) {
  if (!table_) {
    stream_.emplace(choice.file);
    source_ = stream_->source();
  }
  const Table headings = table_ ? signal_headings(choice) : stream_->columns();
  choose(choice, headings);
  std::vector<std::string> columns = {column_};
  if (!choice.time.empty()) {
    const Column& times = headings.column(choice.time);
    time_ = times.name;
    time_unit_ = times.unit.empty() ? read_heading(times.name, "s").unit : times.unit;
    columns.push_back(time_);
  }
  if (stream_) {
    stream_->select(columns);
    return;
  }
  for (const std::string& name : columns) {
    chosen_.push_back(&table_->column(name));
    if (!chosen_.back()->is_number)
      throw InputError(
          fmt::format("{}: column '{}' holds texts; a signal has numbers", source_, name));
  }
  batch_.columns.resize(chosen_.size());
}

void SignalFile::choose(const SignalChoice& choice, const Table& table) {
  const Column* chosen = nullptr;
  if (!choice.column.empty()) {
    chosen = &table.column(choice.column);
  } else {
    std::vector<std::string> possible;
    for (const Column& column : table.columns) {
      if (!column.is_number || is_time(column) || column.name == choice.time) continue;
      possible.push_back(fmt::format("'{}'", column.name));
      chosen = &column;
    }
    if (possible.empty())
      throw InputError(fmt::format("{} has no numeric column that is a load", source()));
    if (possible.size() > 1)
      throw InputError(
          fmt::format("{} has several columns: name the load with --column NAME, one of {}",
                      source(), fmt::join(possible, ", ")));
  }
  column_ = chosen->name;
  for (const Column& column : table.columns)
    if (column.is_number && choice.time.empty() && column.name != column_ && is_time(column))
      unread_times_ = column.name;
  unit_ = load_heading(*chosen).unit;
  if (choice.unit.empty()) {
    if (!unit_.empty() && !parse_unit(unit_))
      throw InputError(
          fmt::format("{}, column '{}': '{}' is not a unit{}; give the unit: --unit UNIT", source(),
                      column_, unit_, unit_hint(unit_, std::nullopt)));
    return;
  }
  const auto wanted = parse_unit(choice.unit);
  if (!wanted) throw InputError(fmt::format("--unit: '{}' is not a unit", choice.unit));
  const auto said = unit_.empty() ? std::nullopt : parse_unit(unit_);
  if (said && (said->dimension != wanted->dimension || said->scale != wanted->scale ||
               said->offset != wanted->offset))
    throw InputError(
        fmt::format("{}, column '{}': the table has {} and --unit has {}; remove one of them",
                    source(), column_, unit_, choice.unit));
  unit_ = choice.unit;
}

void SignalFile::read_rows_in_memory() {
  constexpr std::size_t most = 65'536;
  batch_.first_row = row_;
  batch_.rows = std::min(most, table_->rows - row_);
  for (std::size_t c = 0; c < chosen_.size(); ++c) {
    const auto from = chosen_[c]->numbers.begin() + static_cast<std::ptrdiff_t>(row_);
    batch_.columns[c].assign(from, from + static_cast<std::ptrdiff_t>(batch_.rows));
  }
  row_ += batch_.rows;
}

bool SignalFile::read_batch() {
  if (stop_.stop_requested()) throw Cancelled();
  if (stream_) return stream_->next(batch_);
  read_rows_in_memory();
  return batch_.rows > 0;
}

std::span<const double> SignalFile::next() {
  if (!read_batch()) return {};
  const std::vector<double>& samples = batch_.columns.front();
  bool good = true;
  for (const double x : samples) good &= std::abs(x) < largest;
  if (!good) {
    std::size_t i = 0;
    while (std::abs(samples[i]) < largest) ++i;
    throw InputError(fmt::format(
        "{}, row {}, column '{}': {}", source(), batch_.first_row + i + 1, column_,
        std::isnan(samples[i])
            ? "no value: a signal must not have gaps; cut the file there and count the parts"
            : fmt::format("{} is not a valid load", samples[i])));
  }
  if (!time_.empty()) check_times();
  return samples;
}

void SignalFile::check_times() {
  const std::vector<double>& times = batch_.columns[1];
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto fail = [&](const std::string& what) {
      throw InputError(fmt::format("{}, row {}, column '{}': {}", source(),
                                   batch_.first_row + i + 1, time_, what));
    };
    if (!std::isfinite(times[i])) fail("no time");
    if (last_time_) {
      const double step = times[i] - *last_time_;
      if (!(step > 0)) fail(fmt::format("{} does not come after {}", times[i], *last_time_));
      if (!step_) step_ = step;
      if (step > longest_step * *step_)
        fail(
            fmt::format("a gap: nothing between {} and {}, but the first step is {:.6g}; cut the "
                        "file there and count the parts",
                        *last_time_, times[i], *step_));
    }
    if (!first_time_) first_time_ = times[i];
    last_time_ = times[i];
  }
}

std::optional<double> SignalFile::seconds() const {
  if (!step_) return {};
  const auto unit = parse_unit(time_unit_);
  if (time_unit_.empty() || !unit || unit->dimension != Dimension{{"second", 1}})
    throw InputError(fmt::format(
        "{}, column '{}' {}: give the unit of times in the heading, \"time [s]\", or the duration "
        "of one pass with --block",
        source(), time_,
        time_unit_.empty() ? "has no unit"
                           : fmt::format("is in '{}', which is not a unit of time", time_unit_)));
  return unit->scale * (*last_time_ - *first_time_ + *step_);
}

}  // namespace wearwell::fatigue
