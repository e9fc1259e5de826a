#include "wearwell/input/memory_text.h"

#include <fmt/format.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "wearwell/base/error.h"

namespace wearwell {

MemoryText::MemoryText() : descriptor_(memfd_create("table", MFD_CLOEXEC)) {
  if (descriptor_ < 0)
    throw MachineError(fmt::format("no memory for a table: {}", std::strerror(errno)));
}

MemoryText::~MemoryText() {
  if (descriptor_ >= 0) close(descriptor_);
}

void MemoryText::add_line(std::string_view line) {
  waiting_ += line;
  waiting_ += '\n';
  if (waiting_.size() >= 1 << 20) flush();
}

void MemoryText::flush() {
  for (std::string_view left = waiting_; !left.empty();) {
    const ssize_t count = write(descriptor_, left.data(), left.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0)
      throw MachineError(fmt::format("no memory for a table: {}", std::strerror(errno)));
    left.remove_prefix(static_cast<std::size_t>(count));
  }
  waiting_.clear();
}

std::unique_ptr<TableFile> MemoryText::table(const std::string& source) {
  flush();
  return std::make_unique<TableFile>(std::exchange(descriptor_, -1), source);
}

}  // namespace wearwell
