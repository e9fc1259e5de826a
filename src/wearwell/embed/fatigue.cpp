#include <fmt/format.h>

#include <filesystem>

#include "wearwell/base/error.h"
#include "wearwell/embed/fitted.h"
#include "wearwell/embed/readers.h"
#include "wearwell/models/fatigue/design_request.h"
#include "wearwell/models/fatigue/history_request.h"
#include "wearwell/models/fatigue/load_life_request.h"
#include "wearwell/study/json.h"

namespace wearwell::embed {
namespace {

fatigue::SnResult sn_result(const Subject& subject) {
  if (!subject.run) return fatigue::read_sn_result(subject.path);
  return fatigue::sn_result_of(summary_json(*subject.run->result), "summary.json", "fit", [&] {
    return state_of({subject.run, {}});
  });
}

// The load of a table in memory or of a file, and how it is counted.
void read_counting(PlanArguments& arguments, const Subject& subject, const Monitor& monitor,
                   fatigue::CountingChoice& counting) {
  std::string file;
  arguments.text("loads", file);
  arguments.text("column", counting.signal.column);
  arguments.text("units", counting.signal.unit);
  arguments.call_option("--unit", "units");
  arguments.text("time", counting.signal.time);
  arguments.text("method", counting.method);
  arguments.text("residual", counting.residual);
  counting.signal.file = file;
  counting.signal.table = table_of(subject, "loads");
  counting.signal.stop = monitor.stop;
  if (file.empty() && !counting.signal.table)
    throw InputError("loads is missing: a signal, or a table of counted cycles");
}

Work damage(PlanArguments& arguments, const Subject& subject, const Monitor& monitor) {
  fatigue::LoadLifeRequest request;
  read_counting(arguments, subject, monitor, request.counting);
  arguments.text("scale", request.scale);
  arguments.text("rule", request.rule);
  arguments.text("knee", request.knee);
  arguments.text("block", request.block);
  arguments.text("damage_sum", request.damage_sum);
  arguments.numbers("b", request.b_lives);
  arguments.number("confidence", request.confidence);
  return [request, &subject] {
    const fatigue::LoadLifeReport report = fatigue::load_life_of(request, sn_result(subject));
    return plan::Answer{report.result.title, load_life_text(report), load_life_sections(report),
                        load_life_json(report), report.result.trusted};
  };
}

Work design(PlanArguments& arguments, const Subject&, const Monitor& monitor) {
  fatigue::DesignRequest request;
  std::vector<std::pair<std::string, std::string>> results;
  arguments.named_texts("results", results);
  arguments.texts("stress", request.stresses);
  arguments.text("mean_stress", request.mean_stress);
  arguments.text("stress_ratio", request.stress_ratio);
  arguments.number("reliability", request.reliability);
  arguments.number("confidence", request.confidence);
  return [request, results, stop = monitor.stop] {
    fatigue::ModelsToAverage models = fatigue::models_to_average({results.begin(), results.end()});
    const fatigue::AveragedDesignReport report =
        fatigue::averaged_design_of(request, std::move(models), stop);
    return plan::Answer{report.from.models.front().result.title, averaged_design_text(report),
                        averaged_design_sections(report), averaged_design_json(report),
                        is_trusted(report)};
  };
}

Work spectrum(PlanArguments& arguments, const Subject& subject, const Monitor& monitor) {
  constexpr std::size_t most_bins = 1024;
  constexpr double least_width = 1e-300, largest_width = 1e150;
  fatigue::HistoryRequest request;
  read_counting(arguments, subject, monitor, request.counting);
  std::optional<double> width;
  std::size_t bins = static_cast<std::size_t>(request.bins);
  arguments.whole("bins", bins, 1, most_bins);
  arguments.number("bin_width", width);
  if (width && !(*width >= least_width && *width <= largest_width))
    throw InputError(fmt::format("bin_width is {}; it is above 0", *width));
  request.bins = static_cast<int>(bins);
  request.bin_width = width.value_or(0);
  return [request] {
    fatigue::SignalFile file(request.counting.signal);
    fatigue::LoadHistory history(request.counting.rule(request.bin_width));
    const fatigue::HistoryReport report = counted_history(request, file, history);
    return plan::Answer{
        fmt::format("{}, {}, {} samples", report.source, report.column, report.counted.samples),
        history_text(report), history_sections(report), history_json(report)};
  };
}

}  // namespace

Reader fatigue_reader(const std::string& kind) {
  if (kind == "damage") return &damage;
  if (kind == "design") return &design;
  if (kind == "spectrum") return &spectrum;
  return nullptr;
}

}  // namespace wearwell::embed
