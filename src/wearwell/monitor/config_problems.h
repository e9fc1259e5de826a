#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"

namespace wearwell::monitor {

/// The problems of a file's parts, all of them.
class Problems {
 public:
  /// Whether the part has none. `example`: a line that is right, which follows a problem.
  bool in(const std::function<void()>& part, const std::string& example = {});
  /// Adds a problem, once.
  void add(const std::string& text);
  /// Adds the keys that no part has requested, in this table and in those below that were read. A
  /// part must have requested all its keys, also behind a problem.
  void unknown_keys(const TomlReader& root) { unknown_keys(root, {}); }
  bool empty() const { return all_.empty(); }
  std::size_t count() const { return all_.size(); }
  /// Throws InputErrors if there are problems: in the order of the file, then those without a place.
  void finish() const;

 private:
  void unknown_keys(const TomlReader& table, const std::string& path);
  std::vector<std::string> all_;
};

}  // namespace wearwell::monitor
