#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/selection/data.h"

namespace wearwell::embed {

/// The settings of `wearwell select` besides its data.
struct SelectOptions {
  std::string criterion = "loo";
  int keep = 10;
  double near = 0;
  int folds = 0, nested = -1;
  std::uint64_t seed = 1;
  double seconds = std::numeric_limits<double>::infinity();
  bool report = false;
};

/// summary.json, the terminal output, models.csv, and the page if it was requested and a model was
/// found.
struct Selected {
  std::string summary, text, models, page;
};
/// From `table` if given, else from the file that `asked` names. Throws InputError.
Selected select(const SelectData& asked, const Table* table, const SelectOptions& options,
                const Monitor& monitor);

/// Cycles and half cycles in the order in which they close.
struct Cycles {
  std::vector<double> from, to, count;
};
/// Throws InputError naming the first row that is not finite; Cancelled.
Cycles rainflow(const std::vector<double>& signal, bool three_points, bool repeat,
                const Monitor& monitor);

}  // namespace wearwell::embed
