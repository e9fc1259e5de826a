#include "wearwell/models/formula_model/failure_modes.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>

#include "wearwell/base/contains.h"
#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/cell_text.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/status_words.h"
#include "wearwell/models/formula_model/mode_words.h"

namespace wearwell::formula_model {
namespace {

constexpr std::string_view keys_of_modes[] = {"column", "runout", "unknown"};

// Cells of the mode column.
class ModeCells {
 public:
  // `of_returns`: of a returns triangle, whose reader has settled which units failed.
  ModeCells(const ModeWords& words, const FormulaData& data, const Observed& all,
            const Column& column, bool of_returns)
      : words_(words), data_(data), column_(column), all_(all), of_returns_(of_returns) {
    for (std::size_t i = 0; i < all.rows.size(); ++i) marks_runouts_ |= says_runout(word(i));
    const SpecialColumns special = special_columns(data);
    stated_ = data.status || special.lower || special.upper || marks_runouts_ ||
              std::any_of(all.responses.begin(), all.responses.end(),
                          [](const Response& y) { return y.seen != Censoring::none; });
  }

  // The modes that the cell of observation i names; none for a run-out; `every` if it is unknown.
  struct Named {
    bool runout = false;
    std::vector<std::string> modes = {};
  };
  Named named(std::size_t i) const {
    const std::string text = word(i);
    const bool none = text.empty(),
               unknown = none ? contains(words_.unknown, "") : words_.means_unknown(text);
    if (of_returns_) {
      if (all_.responses[i].seen == Censoring::right) return {true};
      return none ? Named{} : Named{false, parts(i, text)};
    }
    if (all_.responses[i].seen == Censoring::right) {
      if (!none && !unknown && !says_runout(text) && !is_runout_word(text))
        fail(i,
             fmt::format("this life is a run-out, but has the failure mode '{}'; a run-out has no "
                         "mode: leave the cell empty, or correct its status",
                         text));
      return {true};
    }
    if (says_runout(text)) {
      if (data_.status)
        fail(i, fmt::format("'{}' is a run-out, but column '{}' has '{}'; correct one of them",
                            text, data_.status->column,
                            cell_word(data_.table.column(data_.status->column), all_.rows[i])));
      if (all_.responses[i].seen != Censoring::none)
        fail(i, fmt::format("'{}' is a run-out, but the life has an upper end; correct one of them",
                            text));
      return {true};
    }
    if (unknown) return {};
    if (none && !stated_)
      fail(
          i,
          "no failure mode: it can mean a run-out, or a failure of unknown mode; write 'runout' or "
          "'unknown' in the cell, or give the study a status column");
    return none ? Named{} : Named{false, parts(i, text)};
  }

  // "failed" beside "seal" and "motor": a mode of this name, or one that is not known.
  void refuse_failures_of_no_mode(const std::vector<std::string>& modes) const {
    if (!words_.unknown.empty() || modes.size() < 2) return;
    for (std::size_t i = 0; i < all_.rows.size(); ++i) {
      const std::string text = word(i);
      if (all_.responses[i].seen == Censoring::right || !is_failure_of_no_mode(text)) continue;
      fail(i,
           fmt::format("'{0}' can mean a failure of unknown mode, or a failure mode of this name "
                       "(beside {1}); for the first write 'unknown' in the cell, or "
                       "[failure_modes] unknown = \"{0}\"; for the second unknown = \"unknown\"",
                       text, fmt::join(others(modes, text), ", ")));
    }
  }

  // `stated` have a table of their own: they are modes.
  void refuse_doubtful_modes(const std::vector<std::string>& modes,
                             const std::vector<std::string>& stated) const {
    for (auto mode = modes.rbegin(); mode != modes.rend(); ++mode) {
      if (contains(stated, *mode)) continue;
      const std::string doubt = doubt_of_mode(*mode, modes);
      if (doubt.empty()) continue;
      for (std::size_t i = 0; i < all_.rows.size(); ++i) {
        const Named own = named(i);
        if (contains(own.modes, *mode)) fail(i, doubt);
      }
    }
  }

 private:
  static std::vector<std::string> others(std::vector<std::string> modes, const std::string& but) {
    std::erase(modes, but);
    return modes;
  }
  std::string word(std::size_t i) const {
    const std::string text = cell_word(column_, all_.rows[i]);
    return is_missing_mark(text) ? std::string() : text;
  }
  static bool is_runout_word(const std::string& text) {
    return censoring_by_word(text) == Censoring::right;
  }

  // With a status column the status decides, so a short word can be a mode.
  bool says_runout(const std::string& text) const { return words_.means_runout(text); }

  std::vector<std::string> parts(std::size_t i, const std::string& text) const {
    const std::vector<std::string> modes =
        modes_in(text, [&] { return place(data_.table, column_.name, all_.rows[i]); });
    if (!of_returns_)
      for (const std::string& mode : modes) refuse_two_readings(i, mode);
    return modes;
  }

  void refuse_two_readings(std::size_t i, const std::string& mode) const {
    if (!words_.runout.empty()) return;
    if (const auto near = misspelt_runout(mode); near && !data_.status)
      fail(i,
           fmt::format("'{}' can mean a run-out ('{}', misspelt), or a failure mode of this name; "
                       "correct the cell, or list the words of this column that mark run-outs: "
                       "[failure_modes] runout = [...]",
                       mode, *near));
    if (data_.status || marks_runouts_) return;
    if (!is_runout_word(mode) && mode != "0") return;
    fail(i,
         fmt::format("'{0}' can mean a run-out, or a failure mode of this name; give the study a "
                     "status column, or write [failure_modes] runout = \"{0}\", or the word of the "
                     "table that marks run-outs",
                     mode));
  }

  [[noreturn]] void fail(std::size_t i, const std::string& why) const {
    throw InputError(fmt::format("{}: {}", place(data_.table, column_.name, all_.rows[i]), why));
  }

  ModeWords words_;
  const FormulaData& data_;
  const Column& column_;
  const Observed& all_;
  bool of_returns_ = false, marks_runouts_ = false, stated_ = false;
};

std::size_t place_of(std::vector<std::string>& all, const std::string& name) {
  const auto at = std::find(all.begin(), all.end(), name);
  const auto place = static_cast<std::size_t>(at - all.begin());
  if (at == all.end()) all.push_back(name);
  return place;
}

std::string heading_of_modes(const TomlReader& columns, const std::string& name) {
  return columns.is_text(name) ? columns.required_text(name)
                               : columns.required_table(name).required_text("column");
}

}  // namespace

std::vector<std::string> modes_with_tables(const TomlReader& failure_modes) {
  std::vector<std::string> names;
  for (const std::string& key : failure_modes.keys()) {
    if (std::find(std::begin(keys_of_modes), std::end(keys_of_modes), key) ==
        std::end(keys_of_modes))
      names.push_back(key);
  }
  return names;
}

FailureModes read_failure_modes(const TomlReader& root, const FormulaData& data,
                                const Observed& all) {
  const TomlReader section = root.required_table("failure_modes");
  FailureModes found{section.required_text("column"), {}, {}};
  const TomlReader of_data = root.required_table("data");
  const bool of_returns = of_data.has("returns");
  const Column& column =
      of_returns
          ? data.table.columns.back()
          : data.table.column(heading_of_modes(of_data.required_table("columns"), found.name));
  const std::string heading = column.name;
  const ModeCells cells(read_mode_words(section), data, all, column, of_returns);
  found.possible.assign(data.table.rows, 0);
  std::vector<std::size_t> unknown;
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const ModeCells::Named named = cells.named(i);
    if (named.runout) continue;
    if (named.modes.empty()) unknown.push_back(all.rows[i]);
    for (const std::string& mode : named.modes) {
      const std::size_t k = place_of(found.modes, mode);
      if (k == FailureModes::most)
        throw InputError(fmt::format(
            "{}: '{}' is failure mode number {}; at most {} are possible: put rare ones together",
            place(data.table, heading, all.rows[i]), mode, k + 1, FailureModes::most));
      found.possible[all.rows[i]] |= std::uint32_t{1} << k;
    }
  }
  cells.refuse_failures_of_no_mode(found.modes);
  cells.refuse_doubtful_modes(found.modes, modes_with_tables(section));
  if (found.modes.empty())
    throw InputError(fmt::format("{}: column '{}' names no failure mode{}", data.table.source,
                                 heading, of_returns ? " of a return in the fitted periods" : ""));
  const std::uint32_t every = (std::uint32_t{1} << found.modes.size()) - 1;
  for (const std::size_t row : unknown) found.possible[row] = every;
  for (const std::string& mode : modes_with_tables(section)) {
    if (std::find(found.modes.begin(), found.modes.end(), mode) != found.modes.end()) continue;
    section.fail(mode, fmt::format("no row of column '{}' has this failure mode, but {}{}", heading,
                                   fmt::join(found.modes, ", "), did_you_mean(mode, found.modes)));
  }
  return found;
}

ObservedModes observed_by_mode(const FailureModes& modes, const Observed& all) {
  ObservedModes result;
  result.of.resize(modes.modes.size());
  const bool alone = modes.modes.size() == 1;
  for (std::size_t i = 0; i < all.rows.size(); ++i) {
    const std::uint32_t possible = modes.possible[all.rows[i]];
    const Response& y = all.responses[i];
    Response lasted = y;
    lasted.seen = Censoring::right;
    const bool exact = y.seen == Censoring::none;
    if (possible != 0 && !alone && (!exact || std::popcount(possible) > 1)) {
      result.joint.push_back({all.rows[i], possible, y.seen == Censoring::left ? 0 : y.at,
                              y.seen == Censoring::interval ? y.until : y.at});
    }
    for (std::size_t k = 0; k < result.of.size(); ++k) {
      const bool mine = possible >> k & 1;
      Observed& own = result.of[k];
      own.failures += mine ? 1 : 0;
      // From 0 on a run-out says nothing.
      if (!alone && possible != 0 && y.seen == Censoring::left) continue;
      const bool failed = mine && (alone || (exact && std::has_single_bit(possible)));
      own.rows.push_back(all.rows[i]);
      own.counts.push_back(all.counts[i]);
      own.responses.push_back(failed ? y : lasted);
    }
  }
  return result;
}

}  // namespace wearwell::formula_model
