#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "wearwell/input/table_file.h"

namespace wearwell {

/// A CSV written to memory and then read as a file.
class MemoryText {
 public:
  /// Throws MachineError.
  MemoryText();
  ~MemoryText();
  MemoryText(const MemoryText&) = delete;
  MemoryText& operator=(const MemoryText&) = delete;

  void add_line(std::string_view line);
  /// The written text; call once. `source` is its name in messages.
  std::unique_ptr<TableFile> table(const std::string& source);

 private:
  void flush();

  int descriptor_ = -1;
  std::string waiting_;
};

}  // namespace wearwell
