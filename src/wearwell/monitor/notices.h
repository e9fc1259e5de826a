#pragma once

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <map>
#include <mutex>
#include <string>

namespace wearwell::monitor {

/// Log lines of a monitor on a stream. At most `burst` lines per subject, and then one in ten
/// seconds with the number of suppressed lines, so that a faulty device does not fill a log. Any
/// thread may call.
class Notices {
 public:
  explicit Notices(std::FILE* stream) : stream_(stream) {}  ///< null: no output

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
