#pragma once

#include <initializer_list>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/study/role_words.h"
#include "wearwell/study/scaffold.h"

namespace wearwell {

/// Assigns a role to each column of a table, for one reading of the table: by the user's choice, by
/// words of the heading (study/role_words.h), or by unit. A column has one role.
class ColumnRoles {
 public:
  /// `preset_named`: the user chose the reading. A unit of another dimension in brackets is then an
  /// error of the heading, not a sign of another role.
  ColumnRoles(const Table& table, std::string file, const TableChoices& choices, bool preset_named);

  struct Found {
    const Column* column = nullptr;
    const RoleForm* role = nullptr;
    std::string si;          ///< SI unit of its dimension
    std::string unit = "1";  ///< from the table, or guessed
    bool unit_guessed = false;
    bool no_unit = false;  ///< the brackets hold no unit; the numbers are plain
  };
  using Roles = std::initializer_list<std::string_view>;

  /// Takes the column of the first of these roles that any column has; the study calls it `key`. If
  /// two fit equally well, it takes the first and adds both to `questions`.
  std::optional<Found> take(const std::string& key, Roles roles);
  /// What `take` would find, without taking it or asking.
  std::optional<Found> find(Roles roles) const;
  bool has(Roles roles) const { return find(roles).has_value(); }

  /// Marks the column of this role as used although the study does not read it: names of rows.
  void pass_over(std::string_view role);

  /// Takes a column regardless of its heading, under a name of the study.
  Found take_column(const std::string& key, const Column& column, const RoleForm& role);

  /// Takes the column that states how lives ended; returns the study line that names it.
  std::optional<std::string> take_status(bool of_lives);
  /// Lists a column that looks like a status as unused; this reading has no status.
  void refuse_status();

  /// Number columns that vary from row to row and have no role yet.
  std::vector<const Column*> other_numbers() const;
  /// Word columns that repeat values and have no role yet.
  std::vector<const Column*> other_labels() const;

  const Table& table() const { return table_; }
  const std::string& file() const { return file_; }
  const TableChoices& choices() const { return choices_; }

  /// "volume = { column = \"worn volume\", unit = \"mm^3\" }\n", with a comment if the unit is a
  /// guess.
  static std::string line(const std::string& name, const Found& found);
  /// "radius = "?"", with a comment: a condition that no heading names. `like` is an example value.
  std::string unstated_line(const std::string& name, const std::string& what,
                            const std::string& like);
  /// "[data]" with the file and how it is read.
  std::string data_section() const;

  /// What was recognized, what was guessed, what you still have to state, and open questions.
  std::vector<std::string> taken, guesses, unstated;
  std::vector<TableQuestion> questions;

  /// The study with this text, these lists and the unused headings.
  Scaffold study(std::string reading, ReadingFit fit, std::string text) const;

 private:
  struct Match {
    Found found;
    std::size_t word = 0;
    bool whole = false, by_unit = false, letter = false;
  };
  bool is_free(const Column& column) const;
  bool holds(const Column& column, Cells cells) const;
  std::optional<Match> match(const Column& column, const RoleForm& form, bool any_dimension) const;
  std::optional<Match> match_by_unit(const Column& column, const RoleForm& form) const;
  bool is_of_longer_word(const Column& column, const RoleForm& form, std::string_view word) const;
  std::vector<Match> matches(const RoleForm& form) const;
  const Column* chosen(std::string_view role) const;
  Found record(const std::string& key, const Match& match);
  const Column* status_column(bool of_lives) const;

  const Table& table_;
  std::string file_;
  const TableChoices& choices_;
  bool preset_named_;
  std::vector<const Column*> used_;
  std::vector<std::string> unused_statuses_;
  std::set<std::string> roles_;  ///< that were asked for
};

}  // namespace wearwell
