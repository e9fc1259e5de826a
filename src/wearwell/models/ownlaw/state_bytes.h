#pragma once

#include <cstddef>
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
  std::string done();

 private:
  std::string bytes_;
};

/// Reads them. Throws InputError where they are of another version or damaged.
class StateReader {
 public:
  explicit StateReader(std::string_view bytes);
  std::size_t number();
  std::string text();
  std::vector<double> numbers();
  void demand(bool good) const;
  bool at_end() const { return rest_.empty(); }

 private:
  std::string_view take(std::size_t count);
  std::string_view rest_;
};

}  // namespace wearwell::ownlaw
