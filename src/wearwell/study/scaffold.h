#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wearwell {

/// Placeholder for a condition that you still have to state; `read_study` refuses it.
inline constexpr const char* not_stated = "?";

/// The user's choices for a table, from the command line or from answers to questions.
struct TableChoices {
  std::map<std::string, std::string> columns = {};  ///< heading of each role; empty: no column has
                                                    ///< it
  std::vector<std::string> unused = {};             ///< headings
  std::optional<int> failure = {};                  ///< the status code of a failure: 0 or 1
  std::string limit = {};                           ///< wear limit, "100 um"
  std::string settings = {};                        ///< lines of TOML for [data]: "sheet = ..."
};

/// One way to read a table, and the option that chooses it.
struct TableReading {
  std::string text;                  ///< "'wear left [um]' is depth"
  std::vector<std::string> options;  ///< {"--column", "depth=wear left [um]"}
};

/// A question that the table does not answer.
struct TableQuestion {
  std::string text;  ///< "Which column is depth?"
  std::vector<TableReading> readings;
};

/// How well a reading fits the table; larger is better. Readings of equal fit become a question.
/// `none`: the reading does not use a column that the user chose.
enum class ReadingFit { none, possible, general, specific };

/// A study generated from a table, with its guesses.
struct Scaffold {
  std::string text;                       ///< TOML
  std::vector<std::string> taken;         ///< "volume: column 'worn volume' in mm^3"
  std::vector<std::string> guesses = {};  ///< guesses to check, as sentences
  /// Conditions that can be neither read nor guessed. The study does not run until you state them.
  std::vector<std::string> unstated = {};
  std::vector<TableQuestion> questions = {};  ///< for the user to answer before the study is
                                              ///< written
  ReadingFit fit = ReadingFit::specific;
  std::string reading = {};  ///< "S-N curve: lives under stresses"
};

/// A quoted TOML string.
std::string toml_text(const std::string& text);

}  // namespace wearwell
