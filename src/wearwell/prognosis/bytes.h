#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace wearwell::prognosis {

/// Numbers and texts as bytes: little-endian on every machine, doubles in IEEE 754 format.
class ByteWriter {
 public:
  void byte(std::uint8_t value) { bytes_.push_back(static_cast<char>(value)); }
  void u32(std::uint32_t value);
  void u64(std::uint64_t value);
  void number(double value);
  void single(double value);          ///< rounded to single precision
  void text(std::string_view value);  ///< its length (u64), then the text
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

/// Reads them back. Every function throws InputError, which names the file, if the bytes end too
/// early or a length exceeds the bytes left.
class ByteReader {
 public:
  ByteReader(std::string_view bytes, std::string file) : left_(bytes), file_(std::move(file)) {}

  std::uint8_t byte();
  bool flag();  ///< 0 or 1
  std::uint32_t u32();
  std::uint64_t u64();
  double number();
  double single();
  std::string text();
  /// A number of items (u64) of at least `each` bytes each.
  std::size_t count(std::size_t each);
  /// Throws unless `size` items of `each` bytes are left.
  void require(std::size_t size, std::size_t each) const;
  void end() const;  ///< throws if anything is left

  [[noreturn]] void fail(const std::string& why) const;

 private:
  std::string_view take(std::size_t size);
  std::string_view left_;
  std::string file_;
};

}  // namespace wearwell::prognosis
