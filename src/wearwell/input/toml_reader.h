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

/// One table of a TOML file, read strictly: only requested keys are allowed. Every message begins
/// with file:line:column, names the key and ends with that line (study_excerpt.h); `finish` refuses
/// keys that were never requested. All throw InputError.
class TomlReader {
 public:
  /// Throws InputError if it is not TOML.
  static TomlReader parse(const TextFile& file);
  /// Also if it cannot be read.
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

  std::optional<bool> boolean(std::string_view key) const;

  std::optional<long long> integer(std::string_view key, long long least, long long most) const;

  /// "NUMBER UNIT" of the dimension of `si`; for a number or a count also a plain number.
  std::optional<Quantity> quantity(std::string_view key, std::string_view si) const;
  Quantity required_quantity(std::string_view key, std::string_view si) const;
  /// One quantity or a list of them.
  std::vector<Quantity> quantities(std::string_view key, std::string_view si) const;

  std::optional<TomlReader> table(std::string_view key) const;
  TomlReader required_table(std::string_view key) const;

  /// The keys in the table, in the order of the file.
  std::vector<std::string> keys() const;

  /// Refuses the value of `key`, or the table itself if it has no such key. `repair` is the
  /// correction of its line.
  [[noreturn]] void fail(std::string_view key, const std::string& message,
                         const Repair& repair = {}) const;

  /// A key in the file, with its table: "prior.k.distribution".
  struct Present {
    std::string path;
    bool is_table = false;
    std::string text;                  ///< its value, if that is a text
    std::string place;                 ///< "12:3", line and column of the value
    std::size_t line = 0, column = 0;  ///< the same
  };
  /// All keys here and in the tables below, in the order of the file. Does not count as a request.
  std::vector<Present> present() const;

  /// The keys requested so far, here and in the tables below, with their kinds: "predict.limit"
  /// with {"quantity `m^3`"}. A key whose presence alone was tested has no kind.
  std::map<std::string, std::set<std::string>> asked() const;

  const std::string& file() const;
  /// The excerpt of the file after a message (study_excerpt.h).
  std::string excerpt(std::size_t line, std::size_t column, const Repair& repair = {}) const;

  /// Refuses keys that were never requested, here and in the tables below, and names the nearest
  /// allowed key.
  void finish() const;

 private:
  struct State;
  std::optional<std::string> text_as(std::string_view key, std::string kind) const;
  explicit TomlReader(std::shared_ptr<State> state);
  std::shared_ptr<State> state_;
};

}  // namespace wearwell
