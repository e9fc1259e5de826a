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

/// What the columns of a table are, recognized for one reading of it: by what the user chose, by the words of
/// headings (study/role_words.h), or by units. A column has one role.
class ColumnRoles {
 public:
  /// `preset_named`: the user has said which reading; then what stands in brackets and is of another dimension is an
  /// error of the heading, and no sign of another role.
  ColumnRoles(const Table& table, std::string file, const TableChoices& choices, bool preset_named);

  struct Found {
    const Column* column = nullptr;
    const RoleForm* role = nullptr;
    std::string si;          ///< the dimension that it has
    std::string unit = "1";  ///< as the table has it, or as guessed
    bool unit_guessed = false;
    bool no_unit = false;  ///< what stands in its brackets is none: its numbers are plain
  };
  using Roles = std::initializer_list<std::string_view>;

  /// The column of the first of these roles that a column has, which the study calls `key`; takes it. Of two that fit
  /// alike the first is taken, and `questions` has both.
  std::optional<Found> take(const std::string& key, Roles roles);
  /// What `take` would find; takes nothing, asks nothing.
  std::optional<Found> find(Roles roles) const;
  bool has(Roles roles) const { return find(roles).has_value(); }

  /// The column of that role, which the study has no use for: names of rows.
  void pass_over(std::string_view role);

  /// A column whatever its heading, under a name of the study.
  Found take_column(const std::string& key, const Column& column, const RoleForm& role);

  /// The column that says how lives ended; the line of the study that names it.
  std::optional<std::string> take_status(bool of_lives);
  /// A column that looks like a status and is none of this reading: the study says so.
  void refuse_status();

  /// Columns of numbers that differ from row to row and have no role so far.
  std::vector<const Column*> other_numbers() const;
  /// Columns of words that are alike in several rows and have no role so far.
  std::vector<const Column*> other_labels() const;

  const Table& table() const { return table_; }
  const std::string& file() const { return file_; }
  const TableChoices& choices() const { return choices_; }

  /// "volume = { column = \"worn volume\", unit = \"mm^3\" }\n", with a comment where the unit is a
  /// guess.
  static std::string line(const std::string& name, const Found& found);
  /// "radius = "?"", with a comment: a condition that no heading names. `like`: a value that it may
  /// have.
  std::string unstated_line(const std::string& name, const std::string& what,
                            const std::string& like);
  /// "[data]" with the file and how it is read.
  std::string data_section() const;

  /// What was taken, what was guessed, what is left to be stated, what is open.
  std::vector<std::string> taken, guesses, unstated;
  std::vector<TableQuestion> questions;

  /// The study of that text, with these and the headings that nobody asked for.
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
