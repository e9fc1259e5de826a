#include "wearwell/embed/tools.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/models/fatigue/rainflow.h"
#include "wearwell/selection/json.h"
#include "wearwell/selection/report.h"
#include "wearwell/selection/selection_header.h"
#include "wearwell/selection/text.h"
#include "wearwell/study/header_json.h"

namespace wearwell::embed {

Selected select(const SelectData& asked, const Table* table, const SelectOptions& options,
                const Monitor& monitor) {
  const ForkGuard guard;
  std::atomic<bool> stop = false;
  const std::stop_callback stopped(monitor.stop, [&] { stop = true; });
  SelectionResult result = table ? read_selection(asked, *table) : read_selection(asked);
  result.version = WEARWELL_VERSION;
  SearchSettings& search = result.settings.search;
  search.criterion = read_criterion(options.criterion);
  search.keep = options.keep;
  search.near = options.near;
  search.seconds = options.seconds;
  search.threads = guard.most(monitor.threads);
  constexpr int few_terms = 20;  // as in the command
  if (static_cast<int>(result.design.terms.size() - search.forced.size()) <= few_terms) {
    search.prove_sizes = true;
    if (options.report) search.cloud = CloudKind::bins;
  }
  search.stop = &stop;
  result.settings.folds = options.folds;
  result.settings.nested = options.nested;
  result.settings.seed = options.seed;
  result.selection = select_terms(result.design, result.observed, result.weights, result.settings);
  result.settings.search.stop = nullptr;
  check_stop();  // a search that is stopped returns what it has
  nlohmann::ordered_json json = to_json(selection_header(result));
  json.update(to_json(result), true);
  Selected selected{
      printable_json(json.dump(2)) + "\n", selection_text(result), models_csv(result), {}};
  if (options.report && !result.selection.search.models.empty())
    selected.page = selection_report(result);
  return selected;
}

Cycles rainflow(const std::vector<double>& signal, bool three_points, bool repeat,
                const Monitor& monitor) {
  for (std::size_t i = 0; i < signal.size(); ++i) {
    if (!std::isfinite(signal[i]))
      throw InputError(fmt::format("signal, row {}: not a number", i + 1));
  }
  Cycles cycles;
  fatigue::Rainflow counted(
      three_points ? fatigue::Counting::three_point : fatigue::Counting::four_point,
      repeat ? fatigue::Residual::repeat : fatigue::Residual::half);
  const auto take = [&](double from, double to, double count) {
    cycles.from.push_back(from);
    cycles.to.push_back(to);
    cycles.count.push_back(count);
  };
  const auto point = [&](double p) { counted.add(p, take); };
  fatigue::TurningPoints turns;
  constexpr std::size_t piece = 65'536;
  for (std::size_t i = 0; i < signal.size(); i += piece) {
    if (monitor.stop.stop_requested()) throw Cancelled();
    turns.add(std::span(signal).subspan(i, std::min(piece, signal.size() - i)), point);
  }
  turns.finish(point);
  counted.finish(take);
  return cycles;
}

}  // namespace wearwell::embed
