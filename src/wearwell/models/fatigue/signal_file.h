#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "wearwell/input/column_stream.h"
#include "wearwell/input/heading.h"

namespace wearwell::fatigue {

/// A column of a file, as named by the user.
struct SignalChoice {
  std::filesystem::path file;
  std::string column = {};  ///< its heading; empty: the only numeric column that is not a time
  std::string unit = {};    ///< if the heading has none
  std::string time = {};    ///< a column of times for the check of gaps; empty for none
};

/// The name of a load and its unit, from a heading or from a unit beside it: "stress [MPa]" in any
/// unit, "force (kN)" and "strain in um/m" in one of a stress, a force, a moment or a plain number,
/// "stress_MPa" in one of a stress. Without a unit if there is none or it is ambiguous.
Heading load_heading(const Column& column);

/// A load signal in a file, piece by piece. Throws InputError that names file, row and column: no
/// such column or several, two units, no value (a gap), times that are not evenly spaced.
class SignalFile {
 public:
  explicit SignalFile(const SignalChoice& choice);

  const std::string& source() const { return stream_.source(); }
  const std::string& column() const { return column_; }
  const std::string& unit() const { return unit_; }  ///< empty if unknown
  /// A column of times that was not checked for gaps; else empty.
  const std::string& unread_times() const { return unread_times_; }

  /// The duration of the samples read so far, s, with the last of them as long as the first step.
  /// Empty without a column of times, or for a single sample; throws InputError if its heading has
  /// no unit of time.
  std::optional<double> seconds() const;

  /// The next samples, in the file's unit; empty at the end.
  std::span<const double> next();

 private:
  void choose(const SignalChoice& choice);
  void check_times();

  ColumnStream stream_;
  ColumnStream::Batch batch_;
  std::string column_, unit_, time_, unread_times_;
  std::string time_unit_;
  std::optional<double> first_time_, last_time_, step_;
};

}  // namespace wearwell::fatigue
