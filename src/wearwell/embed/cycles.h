#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::embed {

/// A wear model of a clutch and the plates that went through it. Threads may share it.
class PlateCycles {
 public:
  /// `model`: the path of a model.json. Throws InputError.
  PlateCycles(const std::string& model, bool scatter_only, bool skip_not_finite);

  /// All cycles of the table or, where one is refused (InputError), none of them. Returns how many.
  std::size_t add(const Table& table);
  /// The same of a file that may be larger than memory.
  std::size_t add_file(const std::string& file);

  /// As `wearwell clutch predict --json` prints it.
  nlohmann::ordered_json json() const;

 private:
  clutch::WearModel model_;
  clutch::CycleSum sum_;
  mutable std::mutex mutex_;
  std::vector<std::string> names_;
  bool any_ = false, named_ = false;
};

}  // namespace wearwell::embed
