#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/base/unit.h"
#include "wearwell/input/study_excerpt.h"
#include "wearwell/input/text_file.h"

namespace wearwell {

/// One table of a TOML file, read strictly: what is asked for is what may stand there. Every
/// message begins with file:line:column, names the key and ends with that line (study_excerpt.h);
/// `finish` refuses what was never asked for. All throw InputError.
class TomlReader {
 public:
  /// Throws InputError when it is not TOML.
  static TomlReader parse(const TextFile& file);
  /// Or when it cannot be read.
  static TomlReader parse_file(const std::filesystem::path& file);

  TomlReader(const TomlReader&);
  TomlReader(TomlReader&&) noexcept;
  ~TomlReader();

  bool has(std::string_view key) const;
  bool is_text(std::string_view key) const;
  bool is_integer(std::string_view key) const;

  std::optional<std::string> text(std::string_view key) const;
  std::string required_text(std::string_view key) const;
  /// One text or a list of them.
  std::vector<std::string> texts(std::string_view key) const;
  /// One of a few words.
  std::optional<std::string> choice(std::string_view key,
                                    const std::vector<std::string>& allowed) const;

  std::optional<long long> integer(std::string_view key, long long least, long long most) const;

  /// "NUMBER UNIT" of the dimension of `si`; where that is a number or a count, a plain number too.
  std::optional<Quantity> quantity(std::string_view key, std::string_view si) const;
  Quantity required_quantity(std::string_view key, std::string_view si) const;
  /// One quantity or a list of them.
  std::vector<Quantity> quantities(std::string_view key, std::string_view si) const;

  std::optional<TomlReader> table(std::string_view key) const;
  TomlReader required_table(std::string_view key) const;

  /// The keys that stand in the table, in the order of the file.
  std::vector<std::string> keys() const;

  /// Refuses the value of `key`, or the table itself when it has no such key. `repair` is what would
  /// be right in its line.
  [[noreturn]] void fail(std::string_view key, const std::string& message,
                         const Repair& repair = {}) const;

  /// A key that stands in the file, with its table: "prior.k.distribution".
  struct Present {
    std::string path;
    bool is_table = false;
    std::string text;                  ///< its value, where that is a text
    std::string place;                 ///< "12:3", line and column of the value
    std::size_t line = 0, column = 0;  ///< the same
  };
  /// All that stands here and in the tables below, in the order of the file. Asks for nothing.
  std::vector<Present> present() const;

  /// What was asked for so far, here and in the tables below, and as what: "predict.limit" as
  /// {"quantity `m^3`"}. Of a key that was only looked for, nothing is known.
  std::map<std::string, std::set<std::string>> asked() const;

  const std::string& file() const;
  /// What stands in the file, behind a message (study_excerpt.h).
  std::string excerpt(std::size_t line, std::size_t column, const Repair& repair = {}) const;

  /// Refuses keys that were never asked for, here and in the tables below, naming the nearest that
  /// may stand there.
  void finish() const;

 private:
  struct State;
  std::optional<std::string> text_as(std::string_view key, std::string kind) const;
  explicit TomlReader(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace wearwell
