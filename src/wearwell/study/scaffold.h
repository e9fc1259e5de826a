#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace wearwell {

/// The value of a condition that nobody has stated yet: `read_study` refuses it.
inline constexpr const char* not_stated = "?";

/// What a user has said of a table, on the command line or when asked.
struct TableChoices {
  std::map<std::string, std::string> columns = {};  ///< heading of each role; empty: there is none
  std::vector<std::string> unused = {};             ///< headings
  std::optional<int> failure = {};                  ///< as what a status writes a failure: 0 or 1
  std::string limit = {};                           ///< of wear, "100 um"
  std::string settings = {};                        ///< lines of TOML for [data]: "sheet = ..."
};

/// One way to read a table, and the option that chooses it.
struct TableReading {
  std::string text;                  ///< "'wear left [um]' is depth"
  std::vector<std::string> options;  ///< {"--column", "depth=wear left [um]"}
};

/// What a table leaves open.
struct TableQuestion {
  std::string text;  ///< "Which column is depth?"
  std::vector<TableReading> readings;
};

/// How well a reading of a table fits, the larger the better: those of the same fit are a question. `none`: it has no use for a
/// column that the user chose.
enum class ReadingFit { none, possible, general, specific };

/// A study written from a table, with what of it is a guess.
struct Scaffold {
  std::string text;                       ///< TOML
  std::vector<std::string> taken;         ///< "volume: column 'worn volume' in mm^3"
  std::vector<std::string> guesses = {};  ///< what no heading says, in sentences: to be looked at
  /// What no heading says and nothing can be guessed of: the study does not run until it is stated.
  std::vector<std::string> unstated = {};
  std::vector<TableQuestion> questions = {};  ///< what the user decides before it is written
  ReadingFit fit = ReadingFit::specific;
  std::string reading = {};  ///< "S-N curve: lives under stresses"
};

/// A TOML text with its quotes.
std::string toml_text(const std::string& text);

}  // namespace wearwell
