#pragma once

#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "wearwell/input/table.h"
#include "wearwell/models/clutch/cycle_sum.h"

namespace wearwell::embed {

/// A wear model of a clutch with the state of its plates. Threads may share it.
class PlateCycles {
 public:
  /// `model`: the path of a model.json. Throws InputError.
  PlateCycles(const std::string& model, bool scatter_only, bool skip_not_finite);

  /// Adds all cycles of the table or, if one is refused (InputError), none of them. Returns their
  /// number.
  std::size_t add(const Table& table);
  /// The same for a file that may be larger than memory.
  std::size_t add_file(const std::string& file);

  /// In the format of `wearwell clutch predict --json`.
  nlohmann::ordered_json json() const;

 private:
  clutch::WearModel model_;
  clutch::CycleSum sum_;
  mutable std::mutex mutex_;
  std::vector<std::string> names_;
  bool any_ = false, named_ = false;
};

}  // namespace wearwell::embed
