#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "wearwell/input/column_stream.h"
#include "wearwell/input/heading.h"

namespace wearwell::fatigue {

/// A column of a file or of a table in memory, as named by the user.
struct SignalChoice {
  std::filesystem::path file;
  std::string column = {};       ///< its heading; empty: the only numeric column that is not a time
  std::string unit = {};         ///< if the heading has none
  std::string time = {};         ///< a column of times for the check of gaps; empty for none
  const Table* table = nullptr;  ///< in memory, instead of the file; outlives its readers
  std::stop_token stop = {};     ///< once requested, reading throws Cancelled

  std::string source() const { return table ? table->source : file.string(); }
};

/// The name of a load and its unit, from a heading or from a unit beside it: "stress [MPa]" in any
/// unit, "force (kN)" and "strain in um/m" in one of a stress, a force, a moment or a plain number,
/// "stress_MPa" in one of a stress. Without a unit if there is none or it is ambiguous.
Heading load_heading(const Column& column);

/// The headings of the file or table, without rows.
Table signal_headings(const SignalChoice& choice);

/// A load signal in a file or in memory, piece by piece. Throws InputError that names file, row and column: no
/// such column or several, two units, no value (a gap), times that are not evenly spaced.
class SignalFile {
 public:
  explicit SignalFile(const SignalChoice& choice);

  const std::string& source() const { return source_; }
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
  void choose(const SignalChoice& choice, const Table& headings);
  bool read_batch();
  void read_rows_in_memory();
  void check_times();

  std::optional<ColumnStream> stream_;  // of a file
  const Table* table_ = nullptr;        // in memory
  std::vector<const Column*> chosen_;   // of the table
  std::size_t row_ = 0;                 // of the table: the next one
  std::stop_token stop_;
  std::string source_;
  ColumnStream::Batch batch_;
  std::string column_, unit_, time_, unread_times_;
  std::string time_unit_;
  std::optional<double> first_time_, last_time_, step_;
};

}  // namespace wearwell::fatigue
