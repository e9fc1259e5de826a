#include "wearwell/plan/candidates.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/heading.h"
#include "wearwell/present/plain.h"
#include "wearwell/prognosis/matched_rows.h"

namespace wearwell::plan {
namespace {

constexpr int most_specimens = 1000;

// A column by its heading, or its name before a unit, case ignored.
const Column* special_column(const Table& table, const std::string& name) {
  for (const Column& each : table.columns) {
    std::string own = read_heading(each.name, "").name;
    for (char& c : own) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    if (own == name || each.name == name) return &each;
  }
  return nullptr;
}

// The number in a cell that must have one.
double required_number(const Table& table, const Column& column, std::size_t row,
                       const char* allowed) {
  const double value = cell_number(table, column, row);
  if (!std::isfinite(value))
    throw InputError(fmt::format("{}: {}", place(table, column.name, row),
                                 std::isnan(value) ? fmt::format("no value; it must be {}", allowed)
                                                   : fmt::format("must be {}", allowed)));
  return value;
}

class CandidateReader {
 public:
  CandidateReader(const TestStudy& study, const Table& table,
                  const std::optional<std::string>& cost)
      : study_(study), table_(table) {
    if (table.rows == 0) throw InputError(fmt::format("{} has no candidates", table.source));
    specimens_ = special_column(table, specimens_column);
    stop_ = special_column(table, stop_column);
    name_ = special_column(table, name_column);
    if (cost) cost_ = find_cost(*cost);
    refuse_unknown();
    if (stop_) read_stop_unit();
  }

  Candidates candidates(const std::vector<int>& specimens) {
    Candidates found{table_.source, {}, {}};
    read_conditions(found);
    if (cost_) found.currency = unit_text(*cost_);
    for (std::size_t row = 0; row < table_.rows; ++row) add(row, specimens, found);
    refuse_equal(found);
    return found;
  }

 private:
  const Column* find_cost(const std::string& name) const {
    std::vector<std::string> headings;
    for (const Column& each : table_.columns) {
      if (each.name == name || read_heading(each.name, "").name == name) return &each;
      headings.push_back(each.name);
    }
    throw InputError(fmt::format("--cost: {} has no column '{}'; it has {}{}", table_.source,
                                 printable(name), fmt::join(headings, ", "),
                                 did_you_mean(name, headings)));
  }

  static std::string unit_text(const Column& column) {
    if (!column.unit.empty()) return bare_unit(column.unit);
    const std::size_t open = column.name.find('['), close = column.name.rfind(']');
    if (open == column.name.npos || close == column.name.npos || close < open)
      return read_heading(column.name, "").unit;
    return column.name.substr(open + 1, close - open - 1);
  }

  bool is_condition(const Column& column) const {
    const std::string own = read_heading(column.name, "").name;
    return std::any_of(study_.conditions.begin(), study_.conditions.end(),
                       [&](const ConditionColumn& each) {
                         return column.name == each.heading || own == each.heading ||
                                own == each.name || own == read_heading(each.heading, "").name;
                       });
  }

  void refuse_unknown() const {
    std::vector<std::string> known;
    for (const ConditionColumn& each : study_.conditions) known.push_back(each.heading);
    for (const char* each : {specimens_column, stop_column, name_column}) known.emplace_back(each);
    for (const Column& each : table_.columns) {
      if (&each == specimens_ || &each == stop_ || &each == name_ || &each == cost_ ||
          is_condition(each))
        continue;
      const std::string own = read_heading(each.name, "").name;
      if (each.name == study_.measured || own == study_.measured_name)
        throw InputError(fmt::format("{}: column '{}' is what a test shows; remove it",
                                     table_.source, each.name));
      for (const std::string& unit : study_.new_units)
        if (each.name == unit)
          throw InputError(fmt::format(
              "{}: column '{}': each candidate is a test of a new one; remove the column",
              table_.source, each.name));
      throw InputError(fmt::format(
          "{}: column '{}' is unknown; a table of candidates has {}{}, and a cost if --cost names "
          "it",
          table_.source, printable(each.name), fmt::join(known, ", "),
          did_you_mean(each.name, known)));
    }
  }

  void read_stop_unit() {
    if (!study_.is_life)
      throw InputError(fmt::format(
          "{}, column '{}': {} of this study is not a life, so that a test is not stopped; remove "
          "the column",
          table_.source, stop_->name,
          study_.measured.empty() ? "the outcome" : study_.measured_name));
    const std::string text = unit_text(*stop_);
    const std::string like = study_.measured_unit.text;
    const bool plain = study_.measured_unit.scale == 1 && may_be_plain(study_.measured_si);
    if (text.empty() && !plain)
      throw InputError(fmt::format("{}, column '{}': needs its unit, like 'stop [{}]'",
                                   table_.source, stop_->name, like));
    if (text.empty()) return;
    try {
      stop_unit_ = read_unit(text, study_.measured_si);
    } catch (const InputError& error) {
      throw InputError(
          fmt::format("{}, column '{}': {}", table_.source, stop_->name, error.what()));
    }
  }

  void read_conditions(Candidates& found) {
    std::vector<std::string> needed;
    for (const ConditionColumn& each : study_.conditions)
      if (!each.varies) needed.push_back(each.heading);
    Table fresh = table_;
    // Only conditions are matched with the study's table.
    std::erase_if(fresh.columns, [&](const Column& each) { return !is_condition(each); });
    Table like = study_.table();
    prognosis::MatchedRows matched = prognosis::matched_rows(fresh, study_.roles, needed, like);
    found.conditions = std::move(matched.table);
    found.conditions.source = table_.source;
    found.conditions.lines = table_.lines;
    found.notes = std::move(matched.notes);
    for (const ConditionColumn& each : study_.conditions) check(each, found.conditions);
    // Names leave out conditions that all candidates share.
    std::vector<std::string> shared;
    for (const ConditionColumn& each : study_.conditions) {
      const Column& column = condition_column(found.conditions, each.heading);
      bool varies = table_.rows == 1;
      for (std::size_t row = 1; row < table_.rows && !varies; ++row)
        varies = cell_word(column, row) != cell_word(column, 0);
      varies_.push_back(varies);
      if (!varies && !(each.varies && cell_word(column, 0).empty()))
        shared.push_back(
            fmt::format("{} {}{}", each.name, cell_word(column, 0),
                        each.words || each.unit.text == "1" ? "" : " " + each.unit.text));
    }
    if (!shared.empty())
      found.notes.push_back(fmt::format("all candidates are at {}", fmt::join(shared, ", ")));
  }

  void check(const ConditionColumn& condition, const Table& table) const {
    const Column& column = table.column(condition.heading);
    for (std::size_t row = 0; row < table.rows; ++row) {
      if (!condition.words) {
        required_number(table, column, row, "a number");
        continue;
      }
      if (condition.varies && cell_word(column, row).empty()) continue;
      const std::string word = label_word(table, column, row);
      if (condition.is_new(word))
        throw InputError(fmt::format(
            "{}: '{}' is not in the data of the study, which have {}{}{}",
            place(table, condition.heading, row), printable(word),
            fmt::join(condition.labels, ", "), did_you_mean(word, condition.labels),
            condition.varies ? fmt::format("; leave the cell empty for a new {}", condition.name)
                             : ""));
    }
  }

  void add(std::size_t row, const std::vector<int>& specimens, Candidates& found) const {
    Candidate candidate{"", row};
    if (stop_) {
      const double given = cell_number(table_, *stop_, row);
      if (!std::isnan(given)) {
        if (!(given > 0 && std::isfinite(given)))
          throw InputError(
              fmt::format("{}: {:.6g} must be positive", place(table_, stop_->name, row), given));
        candidate.stop =
            stop_unit_ ? from_si(study_.measured_unit, to_si(*stop_unit_, given)) : given;
      }
    }
    if (cost_) {
      candidate.cost = required_number(table_, *cost_, row, "a positive cost");
      if (!(*candidate.cost > 0))
        throw InputError(fmt::format("{}: {:.6g} must be positive: a test costs something",
                                     place(table_, cost_->name, row), *candidate.cost));
    }
    describe_conditions(row, found.conditions, candidate);
    if (name_ && !cell_word(*name_, row).empty()) candidate.name = cell_word(*name_, row);
    for (const int count : counts_of(row, specimens)) {
      if (count > 1 && !candidate.unit.empty())
        throw InputError(fmt::format(
            "{}: {} readings of one {}; a candidate of a {} that the study has is one reading",
            place(table_, study_.unit, row), count, study_.factor_noun, study_.factor_noun));
      candidate.specimens = count;
      found.all.push_back(candidate);
    }
  }

  std::vector<int> counts_of(std::size_t row, const std::vector<int>& specimens) const {
    if (!specimens_) return specimens;
    const double given = cell_number(table_, *specimens_, row);
    if (std::isnan(given)) return {1};
    if (!(given >= 1 && given <= most_specimens && given == std::floor(given)))
      throw InputError(fmt::format("{}: {:.6g} must be a whole number from 1 to {}",
                                   place(table_, specimens_->name, row), given, most_specimens));
    return {static_cast<int>(given)};
  }

  void describe_conditions(std::size_t row, const Table& conditions, Candidate& candidate) const {
    std::vector<std::string> words;
    for (std::size_t c = 0; c < study_.conditions.size(); ++c) {
      const ConditionColumn& each = study_.conditions[c];
      const Column& column = condition_column(conditions, each.heading);
      if (each.words) {
        const std::string word = cell_word(column, row);
        if (varies_[c])
          words.push_back(word.empty() ? "new " + each.name
                                       : fmt::format("{} {}", each.name, word));
        if (!word.empty() && each.heading == study_.unit) candidate.unit = word;
        continue;
      }
      const double value = cell_number(conditions, column, row);
      const std::string unit = each.unit.text == "1" ? "" : " " + each.unit.text;
      if (varies_[c]) words.push_back(fmt::format("{} {:.6g}{}", each.name, value, unit));
      const double slack = 1e-9 * std::max(std::abs(each.low), std::abs(each.high));
      if (each.heading == study_.trials) continue;  // more trials are no extrapolation
      if (value < each.low - slack || value > each.high + slack)
        candidate.outside.push_back(
            fmt::format("{} {:.6g}{} is outside the tested {:.6g} to {:.6g}{}", each.name, value,
                        unit, each.low, each.high, unit));
    }
    candidate.name = fmt::format("{}", fmt::join(words, ", "));
    if (candidate.stop)
      candidate.name += (words.empty() ? "stop " : ", stop ") +
                        with_plain_unit(*candidate.stop, study_.measured_unit.text);
    if (candidate.name.empty()) candidate.name = "one more test";
  }

  void refuse_equal(const Candidates& found) const {
    std::map<std::string, std::size_t> known;
    for (const Candidate& each : found.all) {
      std::string key = fmt::format("{}|{}|", each.specimens, each.stop.value_or(-1));
      for (const ConditionColumn& condition : study_.conditions)
        key += cell_word(condition_column(found.conditions, condition.heading), each.row) + "|";
      const auto [at, fresh] = known.emplace(key, each.row);
      if (!fresh)
        throw InputError(fmt::format("{}: rows {} and {} are the same candidate; keep one",
                                     table_.source, at->second + 1, each.row + 1));
    }
  }

  const TestStudy& study_;
  const Table& table_;
  const Column *specimens_ = nullptr, *stop_ = nullptr, *name_ = nullptr, *cost_ = nullptr;
  std::optional<Unit> stop_unit_;
  std::vector<bool> varies_;  // of each condition: whether it differs between candidates
};

}  // namespace

const Column& condition_column(const Table& conditions, const std::string& heading) {
  for (const Column& each : conditions.columns)
    if (each.name == heading) return each;
  return conditions.column(heading);
}

std::pair<double, std::string> plain_unit(const std::string& unit) {
  double factor = 1;
  const auto [end, failure] = std::from_chars(unit.data(), unit.data() + unit.size(), factor);
  if (failure != std::errc{} || *end != ' ') return {1, unit};
  return {factor, std::string(end + 1, unit.data() + unit.size())};
}

std::string with_plain_unit(double value, const std::string& unit) {
  const auto [factor, rest] = plain_unit(unit);
  return plain_number(value * factor, 6) + (rest == "1" ? "" : " " + rest);
}

Candidates read_candidates(const TestStudy& study, const Table& table,
                           const std::optional<std::string>& cost,
                           const std::vector<int>& specimens) {
  return CandidateReader(study, table, cost).candidates(specimens);
}

}  // namespace wearwell::plan
