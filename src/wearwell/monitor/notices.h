#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>

namespace wearwell::monitor {

/// What a monitor tells whoever runs it, a line each on a stream. Of one subject no more than `burst` lines, and then one in ten
/// seconds that says how many were left out: a device gone mad fills no log. Any thread may call.
class Notices {
 public:
  explicit Notices(std::FILE* stream) : stream_(stream) {}  ///< null: tells nobody

  void tell(const std::string& subject, const std::string& text);

 private:
  static constexpr int burst = 5;
  struct Subject {
    int reported = 0;
    std::uint64_t left_out = 0;
    std::chrono::steady_clock::time_point last = {};
  };
  std::FILE* stream_;
  std::mutex lock_;
  std::map<std::string, Subject> subjects_;
};

}  // namespace wearwell::monitor
