#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string_view>

#include "wearwell/input/source.h"
#include "wearwell/input/study_keys.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/study/scaffold.h"
#include "wearwell/study/study.h"

namespace wearwell::prognosis {
struct CarriedState;
class Tracker;
}  // namespace wearwell::prognosis

namespace wearwell {

class ColumnRoles;

/// A file that `wearwell new` writes.
struct ExampleFile {
  const char* name;
  std::string_view (*content)();
};

/// What the commands know of a model: its key, its example, and how its studies are read.
struct Model {
  std::string_view key;                  ///< in study files: model = "archard-joint"
  std::string_view preset;               ///< its application, for `wearwell new`: "joint"
  std::span<const ExampleFile> example;  ///< the study first, then its data
  /// Reads the model's part of the study file; the caller refuses unused keys. Throws InputError.
  std::unique_ptr<const Study> (*read)(const TomlReader& root, const Source& source);
  /// All keys of its studies, for messages and docs/reference/study-keys.md; may be null.
  StudyKeys (*keys)() = nullptr;
  /// A study of a table whose columns have these roles; nothing where the table is of another
  /// application. May be null.
  std::optional<Scaffold> (*scaffold)(ColumnRoles& roles) = nullptr;
  /// Tracks single units, from the state that a fit of this model left (prognosis/tracker.h). May be
  /// null, and returns null for a study that measures lives, where there is nothing to track.
  std::unique_ptr<const prognosis::Tracker> (*track)(const prognosis::CarriedState& state) =
      nullptr;
};

/// The models that a program supports (models/registry.h).
using Models = std::span<const Model>;

/// Reads a study file and its data; paths in it are relative to the file. Throws InputError that
/// names file:line:column and key, or file, row and column of the data.
std::unique_ptr<const Study> read_study(const Source& source, Models models);

}  // namespace wearwell
