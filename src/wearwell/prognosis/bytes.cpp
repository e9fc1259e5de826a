#include "wearwell/prognosis/bytes.h"

#include <fmt/format.h>

#include <bit>

#include "wearwell/base/error.h"

namespace wearwell::prognosis {
namespace {

template <class Unsigned>
void put(Unsigned value, std::string& bytes) {
  char little[sizeof value];
  for (std::size_t i = 0; i < sizeof value; ++i)
    little[i] = static_cast<char>((value >> (8 * i)) & 0xff);
  bytes.append(little, sizeof value);
}

template <class Unsigned>
Unsigned taken(std::string_view bytes) {
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof value; ++i)
    value |= static_cast<Unsigned>(static_cast<unsigned char>(bytes[i])) << (8 * i);
  return value;
}

}  // namespace

void ByteWriter::u32(std::uint32_t value) {
  put(value, bytes_);
}
void ByteWriter::u64(std::uint64_t value) {
  put(value, bytes_);
}
void ByteWriter::number(double value) {
  put(std::bit_cast<std::uint64_t>(value), bytes_);
}
void ByteWriter::single(double value) {
  u32(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
}
void ByteWriter::text(std::string_view value) {
  u64(value.size());
  bytes_ += value;
}

void ByteReader::fail(const std::string& why) const {
  throw InputError(fmt::format("{} is damaged: {}", file_, why));
}

std::string_view ByteReader::take(std::size_t size) {
  if (size > left_.size())
    fail(fmt::format("{} bytes are needed, {} are left", size, left_.size()));
  const std::string_view first = left_.substr(0, size);
  left_.remove_prefix(size);
  return first;
}

std::uint8_t ByteReader::byte() {
  return static_cast<std::uint8_t>(take(1)[0]);
}
bool ByteReader::flag() {
  const std::uint8_t value = byte();
  if (value > 1) fail(fmt::format("{} where 0 or 1 is expected", value));
  return value == 1;
}
std::uint32_t ByteReader::u32() {
  return taken<std::uint32_t>(take(4));
}
std::uint64_t ByteReader::u64() {
  return taken<std::uint64_t>(take(8));
}
double ByteReader::number() {
  return std::bit_cast<double>(u64());
}
double ByteReader::single() {
  return std::bit_cast<float>(u32());
}
std::string ByteReader::text() {
  return std::string(take(count(1)));
}

std::size_t ByteReader::count(std::size_t each) {
  const std::uint64_t size = u64();
  require(size, each);
  return size;
}

void ByteReader::require(std::size_t size, std::size_t each) const {
  if (each > 0 && size > left_.size() / each)
    fail(fmt::format("{} items of {} bytes are needed, {} bytes are left", size, each,
                     left_.size()));
}

void ByteReader::end() const {
  if (!left_.empty()) fail(fmt::format("{} extra bytes", left_.size()));
}

}  // namespace wearwell::prognosis
