#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/input_errors.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::monitor {

/// The problems of a file's parts, all of them.
class Problems {
 public:
  /// Whether the part has none. `example`: a line that is right, which follows a problem.
  bool in(const std::function<void()>& part, const std::string& example = {}) {
    try {
      part();
      return true;
    } catch (const InputErrors& errors) {
      for (const std::string& each : errors.all) add(each);
    } catch (const InputError& error) {
      const std::string what = error.what();
      const bool has_excerpt = what.find("\n    ") != what.npos;
      add(example.empty() || what.find("\n    right: ") != what.npos ? what
          : has_excerpt ? fmt::format("{}\n    right: {}", what, example)
                        : fmt::format("{}; for example: {}", what, example));
    }
    return false;
  }
  /// A part in a table of its own, with the unknown keys of that. Keys behind the first problem of
  /// a table were never requested, so they are not unknown.
  void in_table(const TomlReader& root, const char* key, const std::function<void()>& part) {
    if (!in(part)) return;
    in([&] {
      if (const auto table = root.table(key)) table->finish();
    });
  }
  bool empty() const { return all_.empty(); }
  std::size_t count() const { return all_.size(); }
  void finish() const {
    if (!all_.empty()) throw InputErrors(all_);
  }

 private:
  void add(const std::string& text) {
    if (std::find(all_.begin(), all_.end(), text) == all_.end()) all_.push_back(text);
  }
  std::vector<std::string> all_;
};

}  // namespace wearwell::monitor
