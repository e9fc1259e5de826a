#pragma once

#include <cstdint>
#include <mutex>
#include <string>
#include <unordered_map>

namespace wearwell::monitor {

/// Outcomes of messages since the start of the monitor, in all and by known unit. Any thread may
/// call.
class Tally {
 public:
  struct Counts {
    std::uint64_t refused = 0, repeated = 0;
    std::string last_problem = {};
  };
  struct Total {
    std::uint64_t messages = 0, stored = 0, refused = 0, repeated = 0;
    std::int64_t last_message_ms = 0;
  };

  explicit Tally(std::size_t most_units) : most_units_(most_units) {}

  void messages(std::uint64_t count, std::int64_t now_ms);
  void stored(std::uint64_t readings);
  void repeated(const std::string& unit);
  /// `unit` may be empty or unknown: then it counts only in the total.
  void refused(const std::string& unit, const std::string& problem);
  /// False if it is new and the limit is reached.
  bool admit(const std::string& unit);
  bool knows(const std::string& unit) const;

  Counts counts(const std::string& unit) const;
  Total total() const;

 private:
  const std::size_t most_units_;
  mutable std::mutex lock_;
  Total total_;
  std::unordered_map<std::string, Counts> units_;
};

}  // namespace wearwell::monitor
