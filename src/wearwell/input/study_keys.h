#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "wearwell/input/toml_reader.h"

namespace wearwell {

/// A key that a study file may contain, for messages and for docs/reference/study-keys.md. Readers
/// define the meaning of a study; tests compare these lists with the keys that readers use.
struct StudyKey {
  /// "data.columns.volume". A part "*" is a name chosen by the user, or one of the names in the
  /// list ("prior.*.distribution").
  std::string path;
  std::string example;  ///< an example value in TOML
  std::string meaning;
  bool needed = false;
  /// Needed only if one of these is present: "data", "law.fatigue_limit=random"; ".distribution=normal" is a
  /// sibling of the key.
  std::vector<std::string> when = {};
  /// Not needed if one of these is present.
  std::vector<std::string> unless = {};
};
using StudyKeys = std::vector<StudyKey>;

StudyKey needed_key(std::string path, std::string example, std::string meaning,
                    std::vector<std::string> unless = {}, std::vector<std::string> when = {});

/// Appends `more` to `keys`.
void add_keys(StudyKeys& keys, const StudyKeys& more);

/// The keys `column` and `unit` of each table in `data.columns`.
StudyKeys column_keys(const std::string& table = "data");
/// The keys of a status column (input/life_status.h).
StudyKeys status_keys();
/// The key for columns that look like a status (input/idle_status.h).
StudyKey unused_columns_key();

/// The layout keys of [data], or of another table that names a file.
StudyKeys layout_keys(const std::string& table = "data");

/// The keys of `[prior]` for each unknown (docs/reference/priors.md).
StudyKeys prior_keys();

/// The needed keys that a study lacks.
StudyKeys missing_keys(const TomlReader& root, const StudyKeys& keys);

/// Describes the key errors of a study that a reader refused: misspelled or misplaced keys first,
/// then missing ones, in one message with file and positions. Empty if there are none, or if
/// `refusal`, the reader's message, already names them.
std::string key_faults(const TomlReader& root, const StudyKeys& keys, std::string_view refusal);

/// Describes the unused keys of a study that was read. Empty if there are none.
std::string unused_keys(const TomlReader& root, const StudyKeys& keys);

/// Whether `path` is `pattern`, in which a part "*" is any name. For tests.
bool matches_key(std::string_view pattern, std::string_view path);

}  // namespace wearwell
