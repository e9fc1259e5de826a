#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/selection/data.h"

namespace wearwell::embed {

/// What `wearwell select` is asked beside its data.
struct SelectOptions {
  std::string criterion = "loo";
  int keep = 10;
  double near = 0;
  int folds = 0, nested = -1;
  std::uint64_t seed = 1;
  double seconds = std::numeric_limits<double>::infinity();
  bool report = false;
};

/// summary.json, what the terminal shows, models.csv, and the page where one was asked for and a model was found.
struct Selected {
  std::string summary, text, models, page;
};
/// Of `table` where there is one, else of the file that `asked` names. Throws InputError.
Selected select(const SelectData& asked, const Table* table, const SelectOptions& options,
                const Monitor& monitor);

/// Cycles and half cycles in the order in which they close.
struct Cycles {
  std::vector<double> from, to, count;
};
/// Throws InputError naming the row of what is not finite.
Cycles rainflow(const std::vector<double>& signal, bool three_points, bool repeat);

}  // namespace wearwell::embed
