#include "wearwell/models/formula_model/state_bytes.h"

#include "wearwell/base/error.h"
#include "wearwell/base/sha1.h"

namespace wearwell::formula_model {
namespace {

constexpr std::string_view mark = "wearwell unit 1\n";
constexpr std::size_t check_size = 16;

std::string check_of(std::string_view bytes) {
  return sha1_of(bytes).substr(0, check_size);
}

// The content between mark and checksum.
std::string_view checked(std::string_view bytes) {
  if (bytes.substr(0, mark.size()) != mark) {
    throw InputError(bytes.substr(0, 14) == mark.substr(0, 14)
                         ? "the state of a unit is of another version of wearwell"
                         : "these bytes are not a state of a unit");
  }
  const auto all = bytes.substr(0, bytes.size() < check_size ? 0 : bytes.size() - check_size);
  if (all.size() < mark.size() || check_of(all) != bytes.substr(all.size()))
    throw InputError("the state of a unit is damaged");
  return all.substr(mark.size());
}

}  // namespace

void StateWriter::numbers(std::span<const double> values) {
  number(values.size());
  for (const double each : values) bytes_.number(each);
}

void StateWriter::short_numbers(std::span<const double> values) {
  number(values.size());
  for (const double each : values) bytes_.single(each);
}

std::string StateWriter::done() {
  const std::string all = std::string(mark) + bytes_.take();
  return all + check_of(all);
}

StateReader::StateReader(std::string_view bytes) : bytes_(checked(bytes), "the state of a unit") {}

void StateReader::demand(bool good) const {
  if (!good) throw InputError("the state of a unit is damaged");
}

std::vector<double> StateReader::numbers() {
  std::vector<double> values(bytes_.count(8));
  for (double& each : values) each = bytes_.number();
  return values;
}

std::vector<double> StateReader::short_numbers() {
  std::vector<double> values(bytes_.count(4));
  for (double& each : values) each = bytes_.single();
  return values;
}

}  // namespace wearwell::formula_model
