#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace wearwell::monitor {

/// Notices that a folder of results has been written again, by its files state.bin and
/// results.sha1.
class ResultWatch {
 public:
  explicit ResultWatch(std::filesystem::path folder);

  /// Whether it has changed, and then stayed the same for two calls, since the last answer `true`.
  bool changed();
  /// What it has is what counts from now on.
  void reset();

 private:
  std::string stamp() const;

  std::filesystem::path folder_;
  std::string taken_, last_;
};

/// Why the folder is not a whole result: state.bin is not the one that results.sha1 lists. Empty if
/// it is, or has no such list.
std::string incomplete_result(const std::filesystem::path& folder);

/// Unix time in ms when its state.bin was written; 0 if there is none.
std::int64_t written_ms(const std::filesystem::path& folder);

}  // namespace wearwell::monitor
