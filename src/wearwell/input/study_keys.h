#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// A key that a study file may hold, for messages and for docs/reference/study-keys.md. What a study means is
/// the reader's business alone; tests hold these lists against what readers ask for.
struct StudyKey {
  /// "data.columns.volume". A part "*" is a name that the user chooses, or one of those that stand
  /// in the list by themselves ("prior.*.distribution").
  std::string path;
  std::string example;  ///< a value as it stands in TOML
  std::string meaning;
  bool needed = false;
  /// Needed only where one of these stands: "data", "law.fatigue_limit=random"; ".distribution=normal" is
  /// beside the key itself.
  std::vector<std::string> when = {};
  /// Not needed where one of these stands.
  std::vector<std::string> unless = {};
};
using StudyKeys = std::vector<StudyKey>;

StudyKey needed_key(std::string path, std::string example, std::string meaning,
                    std::vector<std::string> unless = {}, std::vector<std::string> when = {});

/// Appends `more` to `keys`.
void add_keys(StudyKeys& keys, const StudyKeys& more);

/// Column and unit of each of `data.columns`, if these are tables.
StudyKeys column_keys(const std::string& table = "data");
/// What a column of status has for each end (input/life_status.h).
StudyKeys status_keys();
/// Of columns that look like a status (input/idle_status.h).
StudyKey unused_columns_key();

/// How a table is written, of [data] or of whatever table names a file.
StudyKeys layout_keys(const std::string& table = "data");

/// What `[prior]` may say of each unknown (docs/reference/priors.md).
StudyKeys prior_keys();

/// The needed keys that do not stand in a study.
StudyKeys missing_keys(const TomlReader& root, const StudyKeys& keys);

/// What is wrong with the keys of a study that a reader refused: those that are misspelt or stand
/// elsewhere first, then all that are missing and not misspelt, in one message with file and
/// places. Empty where all is well, or where `refusal`, the reader's own words, says it already.
std::string key_faults(const TomlReader& root, const StudyKeys& keys, std::string_view refusal);

/// What is wrong with the keys of a study that was read: those that nobody asked for. Empty where
/// all is well.
std::string unused_keys(const TomlReader& root, const StudyKeys& keys);

/// Whether `path` is `pattern`, in which a part "*" is any name. For tests.
bool matches_key(std::string_view pattern, std::string_view path);

}  // namespace wearwell
