#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace wearwell::ownlaw {

/// The bytes of a tracked unit: a mark with a version, numbers as eight bytes, the least first, a checksum.
class StateWriter {
 public:
  StateWriter();
  void number(std::size_t value);
  void text(std::string_view text);
  void numbers(std::span<const double> values);  ///< with their count
  /// The same in four bytes each: of numbers that are single precision already.
  void short_numbers(std::span<const double> values);
  std::string done();

 private:
  void put(std::uint64_t value, int bytes);
  std::string bytes_;
};

/// Reads them. Throws InputError where they are of another version or damaged.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes);
  std::size_t number();
  std::string text();
  std::vector<double> numbers();
  std::vector<double> short_numbers();
  void demand(bool good) const;
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view take(std::size_t count);
  std::uint64_t get(int bytes);
  std::string_view rest_;
};

}  // namespace wearwell::ownlaw
