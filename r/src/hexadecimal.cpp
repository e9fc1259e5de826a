#include "hexadecimal.h"

namespace wearwell::r {

std::string in_digits(const std::string& bytes) {
  static constexpr char digits[] = "0123456789abcdef";
  std::string text;
  text.reserve(2 * bytes.size());
  for (const char each : bytes) {
    const auto value = static_cast<unsigned char>(each);
    text += {digits[value >> 4], digits[value & 15]};
  }
  return text;
}

std::string of_digits(const std::string& text) {
  const auto digit = [](char c) { return c <= '9' ? c - '0' : c - 'a' + 10; };
  std::string bytes;
  bytes.reserve(text.size() / 2);
  for (std::size_t i = 0; i + 1 < text.size(); i += 2)
    bytes.push_back(static_cast<char>(digit(text[i]) * 16 + digit(text[i + 1])));
  return bytes;
}

}  // namespace wearwell::r
