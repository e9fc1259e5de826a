#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/trimmed.h"
#include "wearwell/plan/candidates.h"

namespace wearwell::plan {
namespace {

constexpr std::size_t most_candidates = 20'000;

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find(at, begin), text.size());
    parts.emplace_back(trimmed(std::string_view(text).substr(begin, end - begin)));
    begin = end + 1;
  }
  return parts;
}

// The number at the start of a text, and what follows it.
struct Leading {
  double number = NAN;
  std::string rest;
};
Leading leading_number(const std::string& text) {
  Leading found;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), found.number);
  if (failure != std::errc{}) return {NAN, text};
  found.rest =
      trimmed(std::string_view(end, static_cast<std::size_t>(text.data() + text.size() - end)));
  return found;
}

[[noreturn]] void refuse_part(const std::string& part) {
  throw InputError(
      fmt::format("--grid: '{}' must be like 'stress = 200 to 500 by 25 MPa', 'stress "
                  "= 200 to 500 in 13 MPa' or 'stop = 1e6, 5e6 cycles'",
                  printable(part)));
}

// One axis of a grid.
struct Axis {
  std::string name, unit;
  std::vector<double> numbers;
  std::vector<std::string> words;  // of a label
};

// "200 to 500 by 25 MPa".
bool read_range(const std::string& part, const std::string& values, Axis& axis) {
  const Leading from = leading_number(values);
  if (!std::isfinite(from.number) || !from.rest.starts_with("to ")) return false;
  const Leading to = leading_number(std::string(trimmed(from.rest.substr(3))));
  const bool by = to.rest.starts_with("by "), in = to.rest.starts_with("in ");
  if (!std::isfinite(to.number) || !(by || in)) refuse_part(part);
  const Leading step = leading_number(std::string(trimmed(to.rest.substr(3))));
  if (!std::isfinite(step.number)) refuse_part(part);
  axis.unit = step.rest;
  const double span = to.number - from.number;
  const double count = in ? step.number : std::floor(span / step.number + 1e-9) + 1;
  if (in && !(count >= 2 && count == std::floor(count)))
    throw InputError(
        fmt::format("--grid: '{}': a range 'in COUNT' has a whole number of at least 2 "
                    "values",
                    printable(part)));
  if (!(count >= 1) || (by && step.number == 0) || span == 0)
    throw InputError(fmt::format("--grid: '{}': the step does not lead from {:.6g} to {:.6g}",
                                 printable(part), from.number, to.number));
  if (count > static_cast<double>(most_candidates))
    throw InputError(
        fmt::format("--grid: '{}' has more than {} values", printable(part), most_candidates));
  for (int i = 0; i < static_cast<int>(count); ++i)
    axis.numbers.push_back(in ? from.number + span * i / (count - 1)
                              : from.number + step.number * i);
  return true;
}

void read_list(const std::string& part, const std::string& values, Axis& axis) {
  const std::vector<std::string> each = split(values, ',');
  for (std::size_t i = 0; i < each.size(); ++i) {
    const Leading one = leading_number(each[i]);
    if (each[i].empty()) refuse_part(part);
    if (std::isfinite(one.number) && axis.words.empty()) {
      axis.numbers.push_back(one.number);
      if (i + 1 == each.size()) axis.unit = one.rest;
      if (i + 1 < each.size() && !one.rest.empty()) refuse_part(part);
    } else {
      if (!axis.numbers.empty()) refuse_part(part);
      axis.words.push_back(each[i]);
    }
  }
}

Axis read_axis(const std::string& part) {
  const std::size_t sign = part.find('=');
  if (sign == part.npos) refuse_part(part);
  Axis axis{std::string(trimmed(std::string_view(part).substr(0, sign))), "", {}, {}};
  const std::string values(trimmed(std::string_view(part).substr(sign + 1)));
  if (axis.name.empty() || values.empty()) refuse_part(part);
  if (!read_range(part, values, axis)) read_list(part, values, axis);
  return axis;
}

}  // namespace

Table grid_table(const std::string& text) {
  std::vector<Axis> axes;
  std::size_t rows = 1;
  for (const std::string& part : split(text, ';')) {
    if (part.empty()) continue;
    axes.push_back(read_axis(part));
    const Axis& axis = axes.back();
    for (std::size_t i = 0; i + 1 < axes.size(); ++i)
      if (axes[i].name == axis.name)
        throw InputError(fmt::format("--grid: '{}' is given twice", printable(axis.name)));
    rows *= std::max(axis.numbers.size(), axis.words.size());
    if (rows > most_candidates)
      throw InputError(
          fmt::format("--grid: more than {} candidates; use larger steps", most_candidates));
  }
  if (axes.empty()) throw InputError("--grid: is empty; give the conditions of tests");
  Table table{"--grid", {}, rows};
  std::size_t repeat = rows;
  for (const Axis& axis : axes) {
    const bool words = !axis.words.empty();
    const std::size_t count = words ? axis.words.size() : axis.numbers.size();
    repeat /= count;
    Column column{axis.unit.empty() ? axis.name : fmt::format("{} [{}]", axis.name, axis.unit),
                  !words,
                  {},
                  {}};
    for (std::size_t row = 0; row < rows; ++row) {
      const std::size_t i = row / repeat % count;
      words ? column.text.push_back(axis.words[i]) : column.numbers.push_back(axis.numbers[i]);
    }
    table.columns.push_back(std::move(column));
  }
  return table;
}

std::vector<int> specimen_counts(const std::string& text) {
  std::vector<int> counts;
  for (const std::string& part : split(text, ',')) {
    const Leading one = leading_number(part);
    if (!(one.number >= 1 && one.number <= 1000 && one.number == std::floor(one.number)) ||
        !one.rest.empty())
      throw InputError(
          fmt::format("--specimens: '{}' must be a whole number from 1 to 1000, or "
                      "several: '1, 3, 5'",
                      printable(part)));
    const int count = static_cast<int>(one.number);
    if (std::find(counts.begin(), counts.end(), count) != counts.end())
      throw InputError(fmt::format("--specimens: {} is given twice", count));
    counts.push_back(count);
  }
  return counts;
}

}  // namespace wearwell::plan
