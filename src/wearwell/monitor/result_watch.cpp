#include "wearwell/monitor/result_watch.h"

#include <fmt/format.h>
#include <sys/stat.h>

#include <fstream>

#include "wearwell/base/printable.h"
#include "wearwell/base/sha1.h"

namespace wearwell::monitor {
namespace {

namespace fs = std::filesystem;

constexpr const char* state_name = "state.bin";

/// The file itself, where `result` may be a folder or state.bin.
fs::path state_file(const fs::path& result) {
  std::error_code ignored;
  return fs::is_directory(result, ignored) ? result / state_name : result;
}

}  // namespace

ResultWatch::ResultWatch(fs::path folder) : folder_(std::move(folder)) {
  reset();
}

std::string ResultWatch::stamp() const {
  std::string text;
  const fs::path state = state_file(folder_);
  for (const fs::path& file : {state, state.parent_path() / "results.sha1"}) {
    struct stat about {};
    if (stat(file.c_str(), &about) != 0) {
      text += "none;";
    } else {
      text += fmt::format("{} {} {} {};", about.st_ino, about.st_size, about.st_mtim.tv_sec,
                          about.st_mtim.tv_nsec);
    }
  }
  return text;
}

void ResultWatch::reset() {
  taken_ = last_ = stamp();
}

bool ResultWatch::changed() {
  const std::string now = stamp();
  const bool still = now == last_;
  last_ = now;
  if (!still || now == taken_) return false;
  taken_ = now;
  return true;
}

std::string incomplete_result(const fs::path& result) {
  const fs::path state = state_file(result);
  std::ifstream list(state.parent_path() / "results.sha1");
  if (!list) return {};
  const std::string name = state.filename().string();
  for (std::string line; std::getline(list, line);) {
    // "<40 digits>  NAME", as sha1sum writes it.
    constexpr std::size_t digits = 40;
    if (line.size() <= digits + 2 || line.substr(digits + 2) != name) continue;
    std::ifstream file(state, std::ios::binary);
    if (file && sha1_of(file) == line.substr(0, digits)) return {};
    return fmt::format("it is half written: {} is not the one that results.sha1 lists",
                       valid_utf8(name));
  }
  return fmt::format("it is half written: results.sha1 does not list {}", valid_utf8(name));
}

std::int64_t written_ms(const fs::path& result) {
  struct stat about {};
  if (stat(state_file(result).c_str(), &about) != 0) return 0;
  return std::int64_t{about.st_mtim.tv_sec} * 1000 + about.st_mtim.tv_nsec / 1'000'000;
}

}  // namespace wearwell::monitor
