#include "wearwell/models/ownlaw/state_bytes.h"

#include <bit>
#include <cstdint>

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"

namespace wearwell::ownlaw {
namespace {

constexpr std::string_view mark = "wearwell unit 1\n";
constexpr std::size_t check_size = 16;

std::string check_of(std::string_view bytes) {
  return sha1_of(bytes).substr(0, check_size);
}

}  // namespace

StateWriter::StateWriter() : bytes_(mark) {}

void StateWriter::number(std::size_t value) {
  for (int i = 0; i < 8; ++i) {
    bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i) & 0xff);
  }
}

void StateWriter::text(std::string_view text) {
  number(text.size());
  bytes_ += text;
}

void StateWriter::numbers(std::span<const double> values) {
  number(values.size());
  for (const double each : values) number(std::bit_cast<std::uint64_t>(each));
}

std::string StateWriter::done() {
  return bytes_ + check_of(bytes_);
}

StateReader::StateReader(std::string_view bytes) {
  if (bytes.substr(0, mark.size()) != mark) {
    throw InputError(bytes.substr(0, 14) == mark.substr(0, 14)
                         ? "the state of a unit is of another version of wearwell"
                         : "this is no state of a unit");
  }
  rest_ = bytes.substr(0, bytes.size() < check_size ? 0 : bytes.size() - check_size);
  demand(check_of(rest_) == bytes.substr(rest_.size()));
  rest_.remove_prefix(mark.size());
}

void StateReader::demand(bool good) const {
  if (!good) throw InputError("the state of a unit is damaged");
}

std::string_view StateReader::take(std::size_t count) {
  demand(count <= rest_.size());
  const std::string_view taken = rest_.substr(0, count);
  rest_.remove_prefix(count);
  return taken;
}

std::size_t StateReader::number() {
  std::uint64_t value = 0;
  const std::string_view bytes = take(8);
  for (int i = 7; i >= 0; --i) {
    value = value << 8 | static_cast<unsigned char>(bytes[static_cast<std::size_t>(i)]);
  }
  return static_cast<std::size_t>(value);
}

std::string StateReader::text() {
  return std::string(take(number()));
}

std::vector<double> StateReader::numbers() {
  const std::size_t count = number();
  demand(count <= rest_.size() / 8);
  std::vector<double> values(count);
  for (double& each : values) each = std::bit_cast<double>(static_cast<std::uint64_t>(number()));
  return values;
}

}  // namespace wearwell::ownlaw
