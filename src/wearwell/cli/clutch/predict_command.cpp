#include "wearwell/models/clutch/clutch_predict.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "wearwell/base/error.h"
#include "wearwell/base/lock_file.h"
#include "wearwell/base/printable.h"
#include "wearwell/base/same_file.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/cycle_table.h"
#include "wearwell/present/plain.h"
#include "wearwell/present/text_table.h"

namespace wearwell::clutch {
namespace {

struct PredictOptions {
  std::filesystem::path model, cycles, state, trace;
  int every = 1, threads = 0;
  bool scatter_only = false, skip = false, json = false;
};

std::string outside_text(const PlateWear& p) {
  std::string text;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    if (p.outside[i] == 0) continue;
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", inputs[i].name, p.outside[i]);
  }
  if (p.clamped > 0) text += fmt::format("{}negative {}", text.empty() ? "" : ", ", p.clamped);
  if (p.skipped > 0) text += fmt::format("{}skipped {}", text.empty() ? "" : ", ", p.skipped);
  return text.empty() ? "-" : text;
}

void print_table(const WearModel& model, const CycleSum& sum, bool full) {
  std::vector<std::vector<std::string>> rows = {
      {"plate", "cycles", "energy [MJ]", "volume [mm^3]", "95 % scatter"}};
  if (full) rows.front().push_back("95 % full");
  rows.front().insert(rows.front().end(), {"worn [%]", "cycles outside the range"});
  for (const PlateWear& p : sum.plates()) {
    const auto half = [&](double sd) {
      return fmt::format("+- {} ({:.1f} %)", plain_number(2 * sd / mm3), 200 * sd / p.volume);
    };
    rows.push_back({p.description(), plain_given(static_cast<double>(p.cycles)),
                    plain_number(p.energy * 1e-6, 5), plain_number(p.volume / mm3, 5),
                    half(p.sd())});
    if (full) rows.back().push_back(half(p.full_sd(model.plate_sd)));
    rows.back().push_back(fmt::format("{:.1f}", 100 * p.volume / model.worn_out));
    rows.back().push_back(outside_text(p));
  }
  fmt::print("{}", text_table(rows, true));
}

/// Only a file that can be read again as a state may be replaced by one.
std::string checked_state(const CycleSum& sum, const std::string& fingerprint) {
  for (const PlateWear& p : sum.plates()) {
    if (!std::isfinite(p.volume) || !std::isfinite(p.variance) || !std::isfinite(p.energy) ||
        !p.replicates.isFinite().all())
      throw InputError(
          fmt::format("plate {} has no finite wear; its state is not written", p.description()));
  }
  return state_text(sum.plates(), fingerprint);
}

void run(const PredictOptions& options, int& exit_code) {
  refuse_overwriting({{"the model", options.model}, {"the cycles", options.cycles}},
                     {{"--state", options.state}, {"--trace", options.trace}});
  const ReadFile read(options.model);
  const WearModel model = read_model(options.model);
  const std::string fingerprint = read.sha1();
  const bool full = !options.scatter_only, kept = !options.state.empty();
  if (kept && fingerprint.empty())
    throw InputError(
        fmt::format("--state needs a model in a file; {} is not a file", options.model.string()));
  std::optional<LockFile> lock;
  if (kept)
    lock.emplace(options.state, [&] {
      fmt::print(stderr, "waiting for another wearwell that updates {}\n", options.state.string());
    });
  CycleSum sum(model, full, options.skip ? NotFinite::skip : NotFinite::refuse);
  if (kept && std::filesystem::exists(options.state))
    sum.restore(read_state(options.state, fingerprint, full ? model.replicates.size() : 0));
  std::optional<StagedFile> state, trace;
  if (kept) state.emplace(options.state);  // refused before the work starts
  if (!options.trace.empty()) trace.emplace(options.trace);
  std::function<void(std::string_view)> write_trace;
  if (trace) write_trace = [&](std::string_view lines) { trace->write(lines); };
  sum_cycles(options.cycles, sum, write_trace, static_cast<std::size_t>(options.every),
             options.threads);
  if (state) state->write(checked_state(sum, fingerprint));
  if (trace) trace->commit();
  if (state) state->commit();
  lock.reset();
  if (options.json) {
    fmt::print("{}\n", printable_json(wear_json(model, sum, full).dump(2)));
  } else {
    print_table(model, sum, full);
  }
  const std::vector<std::string> problems = energy_problems(sum);
  for (const std::string& each : problems) fmt::print(stderr, "NOT TRUSTED: {}\n", each);
  exit_code = problems.empty() ? 0 : 1;
}

}  // namespace

void add_predict_command(CLI::App& clutch, int& exit_code) {
  CLI::App* command = clutch.add_subcommand(
      "predict", "Worn volume, cycle by cycle, with its 95 % interval; files may exceed memory");
  const auto options = std::make_shared<PredictOptions>();
  command->add_option("MODEL", options->model, "model.json of wearwell fit")->required();
  command
      ->add_option("CYCLES", options->cycles,
                   "plate, cycle, slip_speed, torque, temperature, closing_time, energy (CSV, "
                   "Parquet)")
      ->required();
  command->add_option("--state", options->state,
                      "Continue from this state file if it exists, and write the new state to it");
  command->add_option("--trace", options->trace,
                      "Write volume and interval after each cycle (CSV)");
  command->add_option("--every", options->every, "Write the trace only every N cycles")
      ->check(CLI::Range(1, 1'000'000'000))
      ->capture_default_str();
  command->add_flag(
      "--skip-not-finite", options->skip,
      "Skip and count cycles at which the model has no finite value, instead of refusing the file");
  command->add_flag("--scatter-only", options->scatter_only,
                    "Only the paper's interval, from the scatter of cycles; much faster");
  command
      ->add_option("--threads", options->threads,
                   "Threads (default: all); results do not depend on the number")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--json", options->json, "Print one JSON object");
  command->footer(
      "Example:\n  wearwell clutch predict study-results/model.json fleet.parquet --state "
      "fleet.json");
  command->callback([options, &exit_code] { run(*options, exit_code); });
}

}  // namespace wearwell::clutch
