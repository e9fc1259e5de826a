#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// The value of a condition that nobody has stated yet: `read_study` refuses it.
inline constexpr const char* not_stated = "?";

/// A study written from the headings of a table, with what of it is a guess.
struct FirstStudy {
  std::string text;                       ///< TOML
  std::vector<std::string> taken;         ///< "volume: column 'worn volume' in mm^3"
  std::vector<std::string> guesses = {};  ///< what no heading says, in sentences: to be looked at
  /// What no heading says and nothing can be guessed of: the study does not run until it is stated.
  std::vector<std::string> unstated = {};
};

/// Columns of a table by what people call them: words in lower case, of any language, told apart from
/// units in brackets, behind a slash or an underscore.
class HeadingGuesses {
 public:
  explicit HeadingGuesses(const Table& table);

  struct Found {
    const Column* column = nullptr;
    std::string unit = "1";  ///< as the heading has it, or as guessed
    bool unit_guessed = false;
  };

  /// The column called by one of `names`, the earlier the better, that is not taken yet, and takes it.
  /// `si`: its dimension; `usual`: its unit where the heading has none, "1" where it needs none.
  std::optional<Found> take(const char* what, std::string_view si, std::string_view usual,
                            const std::vector<std::string_view>& names, bool numbers = true);
  bool has(std::string_view si, const std::vector<std::string_view>& names) const;

  /// "volume = { column = \"worn volume\", unit = \"mm^3\" }\n", with a comment where the unit is a
  /// guess.
  static std::string line(const std::string& name, const Found& found);

  /// "radius = "?"", with a comment: a condition that no heading names. `like`: a value that it may
  /// have.
  std::string unstated_line(const std::string& name, const std::string& what,
                            const std::string& like);

  /// What was taken, what was guessed, and what is left to be stated.
  std::vector<std::string> taken, guesses, unstated;

  /// The study of that text, with these and the headings that nobody asked for.
  FirstStudy study(std::string text) const;

 private:
  const Column* find(std::string_view si, const std::vector<std::string_view>& names, bool numbers,
                     std::string& unit) const;
  const Table& table_;
  std::vector<const Column*> used_;
};

/// A TOML text with its quotes.
std::string toml_text(const std::string& text);

/// The values of a column in the unit that it has, without those that are missing.
std::vector<double> values_of(const Column& column);

}  // namespace wearwell
