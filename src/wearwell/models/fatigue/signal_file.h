#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>

#include "wearwell/input/column_stream.h"
#include "wearwell/input/heading.h"

namespace wearwell::fatigue {

/// Which column of which file, as a user says it.
struct SignalChoice {
  std::filesystem::path file;
  std::string column = {};  ///< its heading; empty: the only one of numbers that is no time
  std::string unit = {};    ///< where the heading has none
  std::string time = {};    ///< a column of times by which gaps are found; empty for none
};

/// The name of a load and its unit, of a heading that says it, or of a unit beside it: "stress [MPa]" in
/// any unit, "force (kN)" and "strain in um/m" in one of a stress, a force, a moment or a plain number,
/// "stress_MPa" in one of a stress. Without a unit where none stands there, or doubtfully.
Heading load_heading(const Column& column);

/// A load signal as it stands in a file, piece by piece. Throws InputError that names file, row and
/// column: no such column or several, two units, no value (a gap), times that do not rise evenly.
class SignalFile {
 public:
  explicit SignalFile(const SignalChoice& choice);

  const std::string& source() const { return stream_.source(); }
  const std::string& column() const { return column_; }
  const std::string& unit() const { return unit_; }  ///< empty where nobody says
  /// A column of times in which nobody asked for gaps; else empty.
  const std::string& unread_times() const { return unread_times_; }

  /// How long the samples read so far last, s, the last of them as long as the first step. None without a column of
  /// times, or of a single sample; throws InputError where its heading says no unit of time.
  std::optional<double> seconds() const;

  /// The next samples, in the file's unit; none at the end.
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
