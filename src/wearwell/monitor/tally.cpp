#include "wearwell/monitor/tally.h"

namespace wearwell::monitor {

void Tally::messages(std::uint64_t count, std::int64_t now_ms) {
  const std::lock_guard lock(lock_);
  total_.messages += count;
  total_.last_message_ms = now_ms;
}

void Tally::stored(std::uint64_t readings) {
  const std::lock_guard lock(lock_);
  total_.stored += readings;
}

void Tally::repeated(const std::string& unit) {
  const std::lock_guard lock(lock_);
  ++total_.repeated;
  if (const auto found = units_.find(unit); found != units_.end()) ++found->second.repeated;
}

void Tally::refused(const std::string& unit, const std::string& problem) {
  const std::lock_guard lock(lock_);
  ++total_.refused;
  const auto found = units_.find(unit);
  if (found == units_.end()) return;
  ++found->second.refused;
  found->second.last_problem = problem;
}

bool Tally::admit(const std::string& unit) {
  const std::lock_guard lock(lock_);
  if (units_.contains(unit)) return true;
  if (units_.size() >= most_units_) return false;
  units_.emplace(unit, Counts());
  return true;
}

bool Tally::knows(const std::string& unit) const {
  const std::lock_guard lock(lock_);
  return units_.contains(unit);
}

Tally::Counts Tally::counts(const std::string& unit) const {
  const std::lock_guard lock(lock_);
  const auto found = units_.find(unit);
  return found == units_.end() ? Counts() : found->second;
}

Tally::Total Tally::total() const {
  const std::lock_guard lock(lock_);
  return total_;
}

}  // namespace wearwell::monitor
