#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "wearwell/prognosis/bytes.h"

namespace wearwell::formula_model {

/// The bytes of a tracked unit: a mark with a version, numbers as eight bytes (ByteWriter), a checksum.
class StateWriter {
 public:
  void number(std::size_t value) { bytes_.u64(value); }
  void text(std::string_view text) { bytes_.text(text); }
  void numbers(std::span<const double> values);  ///< with their count
  /// The same in four bytes each: for numbers that are already in single precision.
  void short_numbers(std::span<const double> values);
  std::string done();

 private:
  prognosis::ByteWriter bytes_;
};

/// Reads them. Throws InputError if they are of another version or damaged.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes);
  std::size_t number() { return bytes_.u64(); }
  std::string text() { return bytes_.text(); }
  std::vector<double> numbers();
  std::vector<double> short_numbers();
  void demand(bool good) const;
  void end() const { bytes_.end(); }

 private:
  prognosis::ByteReader bytes_;
};

}  // namespace wearwell::formula_model
