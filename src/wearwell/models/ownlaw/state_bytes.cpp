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

void StateWriter::put(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) bytes_ += static_cast<char>(value >> (8 * i) & 0xff);
}

void StateWriter::number(std::size_t value) {
  put(value, 8);
}

void StateWriter::text(std::string_view text) {
  number(text.size());
  bytes_ += text;
}

void StateWriter::numbers(std::span<const double> values) {
  number(values.size());
  for (const double each : values) put(std::bit_cast<std::uint64_t>(each), 8);
}

void StateWriter::short_numbers(std::span<const double> values) {
  number(values.size());
  for (const double each : values) {
    put(std::bit_cast<std::uint32_t>(static_cast<float>(each)), 4);
  }
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

std::uint64_t StateReader::get(int count) {
  std::uint64_t value = 0;
  const std::string_view bytes = take(static_cast<std::size_t>(count));
  for (auto each = bytes.rbegin(); each != bytes.rend(); ++each) {
    value = value << 8 | static_cast<unsigned char>(*each);
  }
  return value;
}

std::size_t StateReader::number() {
  return static_cast<std::size_t>(get(8));
}

std::string StateReader::text() {
  return std::string(take(number()));
}

std::vector<double> StateReader::numbers() {
  const std::size_t count = number();
  demand(count <= rest_.size() / 8);
  std::vector<double> values(count);
  for (double& each : values) each = std::bit_cast<double>(get(8));
  return values;
}

std::vector<double> StateReader::short_numbers() {
  const std::size_t count = number();
  demand(count <= rest_.size() / 4);
  std::vector<double> values(count);
  for (double& each : values) {
    each = std::bit_cast<float>(static_cast<std::uint32_t>(get(4)));
  }
  return values;
}

}  // namespace wearwell::ownlaw
