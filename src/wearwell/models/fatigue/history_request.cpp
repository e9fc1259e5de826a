#include "wearwell/models/fatigue/history_request.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"

namespace wearwell::fatigue {
namespace {

void refuse_without_cycles(const SignalFile& file, const LoadHistory::Counted& counted) {
  if (!counted.classes.cells().empty()) return;
  if (counted.samples == 1)
    throw InputError(fmt::format("{}, column '{}' has one sample and therefore no cycle",
                                 file.source(), file.column()));
  throw InputError(fmt::format("{}, column '{}' is {} throughout and has no cycle", file.source(),
                               file.column(), counted.lowest));
}

}  // namespace

HistoryReport counted_history(const HistoryRequest& request, SignalFile& file,
                              LoadHistory& history) {
  const CountingRule rule = request.counting.rule(request.bin_width);
  for (auto samples = file.next(); !samples.empty(); samples = file.next()) history.add(samples);
  HistoryReport report{file.source(),      file.column(),
                       file.unit(),        rule,
                       history.counted(),  static_cast<std::size_t>(request.bins),
                       file.unread_times()};
  if (report.counted.samples == 0) throw InputError(fmt::format("{} has no rows", file.source()));
  refuse_without_cycles(file, report.counted);
  if (rule.class_width > 0 && report.counted.classes.width() > rule.class_width)
    throw InputError(fmt::format("--bin-width: {} makes too many classes of ranges up to {}",
                                 rule.class_width, report.counted.highest - report.counted.lowest));
  return report;
}

}  // namespace wearwell::fatigue
