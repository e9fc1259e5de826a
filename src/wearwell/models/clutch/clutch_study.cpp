#include "wearwell/models/clutch/clutch_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/input/source.h"
#include "wearwell/input/toml_reader.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/models/clutch/clutch_truth.h"
#include "wearwell/models/clutch/missing_cycles.h"

namespace wearwell::clutch {
namespace {

namespace fs = std::filesystem;

constexpr int traced_closings = 3;  // of a simulated campaign

void read_simulation(const TomlReader& table, ClutchStudy& study) {
  study.simulated = true;
  const fs::path folder = study.file.parent_path();
  study.files = {required_file(table, "design", folder), required_file(table, "truth", folder)};
  const std::vector<ReadFile> read(study.files.begin(), study.files.end());
  const auto seed = table.integer("seed", 0, std::numeric_limits<long long>::max()).value_or(1);
  study.truth = read_truth(study.files[1]);
  Simulation simulation =
      simulate(read_design(study.files[0]), *study.truth, static_cast<std::uint64_t>(seed));
  study.traces =
      simulate_traces(simulation.campaign, traced_closings, static_cast<std::uint64_t>(seed));
  study.campaign = std::move(simulation.campaign);
  study.realized = std::move(simulation.realized);
  study.plate_factors = std::move(simulation.plate_factors);
  study.worn_out = study.truth->worn_out;
  for (const ReadFile& file : read) study.sha1s.push_back(file.sha1());
}

/// The data that `wearwell update` continues from: a path and lines of a file are not valid there.
void keep_table(const std::string& name, const std::string& source, Table table, bool by_sql,
                ClutchStudy& study) {
  table.source = source;
  table.lines.clear();
  if (by_sql || !study.tables.emplace(name, std::move(table)).second) study.carried = false;
}

/// One table of [data]: KEY = "file", or a table [data.KEY] with file, sql, columns and so on.
CampaignTable open_table(const TomlReader& data, const char* key, const Source& source,
                         ClutchStudy& study) {
  const bool is_name = data.has(key) && data.is_text(key);
  const TomlReader section = is_name ? data : data.required_table(key);
  const char* const file_key = is_name ? key : "file";
  const std::string name = section.required_text(file_key);
  const auto named = source.tables.find(name);
  const Table* const in_memory = !is_name                       ? table_in_memory(section, source)
                                 : named == source.tables.end() ? nullptr
                                                                : &named->second;
  study.files.push_back(in_memory ? fs::path(name)
                                  : required_file(section, file_key, source.folder()));
  const ReadFile read(study.files.back());
  CampaignTable table{
      is_name ? in_memory ? *in_memory
                          : read_table(study.files.back(), {}, {}, read_table_settings(data))
              : read_table(section, source),
      is_name ? std::nullopt : section.table("columns")};
  study.sha1s.push_back(in_memory ? "" : read.sha1());
  study.layouts.push_back(table.table.layout);
  keep_table(is_name ? name : as_read_name(section), name, table.table,
             !is_name && section.has("sql"), study);
  return table;
}

/// Keeps numeric columns as read, for messages.
void keep_columns(const CampaignTable& from, const char* key,
                  const std::vector<std::pair<const char*, const char*>>& columns,
                  ClutchStudy& study) {
  for (const auto& [name, si] : columns) {
    const ColumnChoice choice = from.numbers(name, si);
    study.data_columns.push_back(
        {fmt::format("{}.{}", key, name), si, choice.unit, si_numbers(from.table, choice)});
  }
}

void read_data(const TomlReader& root, const TomlReader& data, const Source& source,
               ClutchStudy& study) {
  Campaign& campaign = study.campaign;
  const CampaignTable design = open_table(data, "design", source, study),
                      cycles = open_table(data, "cycles", source, study),
                      weighings = open_table(data, "weighings", source, study);
  std::optional<CampaignTable> traces;
  if (data.has("traces")) traces.emplace(open_table(data, "traces", source, study));
  std::vector<const CampaignTable*> with_plates = {&cycles, &weighings};
  if (traces) with_plates.push_back(&*traces);
  campaign.plate_names = plate_names(with_plates);
  campaign.design = read_design(design);
  campaign.cycles = read_cycles(cycles, campaign.plate_names);
  campaign.weighings = read_weighings(weighings, campaign.plate_names);
  campaign.cycles_source = cycles.table.source;
  campaign.weighings_source = weighings.table.source;
  if (traces) study.traces = read_traces(*traces, campaign.plate_names);
  using Columns = std::vector<std::pair<const char*, const char*>>;
  Columns conditions;
  for (const Input& input : inputs) conditions.emplace_back(input.name, input.si);
  keep_columns(design, "design", conditions, study);
  keep_columns(cycles, "cycles", {{"cycle", "cycle"}}, study);
  keep_columns(cycles, "cycles", conditions, study);
  keep_columns(cycles, "cycles", {{"energy", "J"}}, study);
  keep_columns(weighings, "weighings", {{"cycle", "cycle"}, {"mass", "kg"}}, study);
  if (traces) {
    keep_columns(*traces, "traces", {{"time", "s"}}, study);
    keep_columns(*traces, "traces", {conditions.begin(), conditions.begin() + 3}, study);
  }
  if (data.choice("missing_cycles", {"refuse", "fill"}) == "fill") fill_missing_cycles(campaign);
  const Lining lining = read_lining(root);
  study.campaign.density = lining.density;
  study.campaign.balance_sd = lining.balance_sd;
  study.worn_out = lining.worn_out;
}

/// lowest, lowest + step, ... highest.
std::vector<double> read_exponents(const TomlReader& table) {
  const auto number = [&](const char* key, double otherwise) {
    const auto given = table.quantity(key, "1");
    if (given && !(given->si() > 0)) table.fail(key, "must be positive");
    return given ? given->si() : otherwise;
  };
  const double low = number("lowest", 0.1), high = number("highest", 3.0),
               step = number("step", 0.1);
  const double steps = (high - low) / step;
  if (!(steps >= 0 && steps <= 200))
    table.fail("step", "must divide the exponents into 0 to 200 steps");
  std::vector<double> exponents;
  for (int i = 0; i <= static_cast<int>(steps + 1e-9); ++i)
    exponents.push_back(std::round((low + i * step) * 1e9) / 1e9);
  return exponents;
}

void read_life(const TomlReader& root, ClutchStudy& study) {
  study.levels = {0.1, 0.25, 0.5, 0.75, 1};
  const auto life = root.table("life");
  if (!life) return;
  if (life->has("levels")) {
    study.levels.clear();
    for (const Quantity& level : life->quantities("levels", "1")) {
      if (!(level.si() > 0)) life->fail("levels", "must be positive");
      study.levels.push_back(level.si());
    }
  }
  if (const auto points = life->table("points")) {
    for (const std::string& name : points->keys())
      study.life_points.emplace_back(name, read_operating_point(points->required_table(name)));
  }
}

}  // namespace

ClutchStudy read_clutch_study(const fs::path& file) {
  const TextFile text = read_text_file(file);
  const TomlReader root = TomlReader::parse(text);
  ClutchStudy study = read_clutch_study(root, Source{text});
  root.finish();
  return study;
}

ClutchStudy read_clutch_study(const TomlReader& root, const Source& source) {
  const TextFile& text = source.study;
  const fs::path& file = text.path;
  ClutchStudy study;
  study.file = file;
  study.file_text = text.text;
  study.title = root.text("title").value_or(valid_utf8(file.stem().string()));
  root.required_text("model");
  const auto simulation = root.table("simulation");
  const auto data = root.table("data");
  if (simulation && data)
    root.fail(
        "data",
        "is given, and so is [simulation]; keep one of them, the files of a rig or a simulation");
  if (!simulation && !data)
    root.fail("data", "is missing: [data] with the files of a rig, or [simulation]");
  if (simulation) {
    read_simulation(*simulation, study);
  } else {
    read_data(root, *data, source, study);
  }
  study.exponents = paper_exponents();
  if (const auto search = root.table("search")) study.exponents = read_exponents(*search);
  if (const auto uncertainty = root.table("uncertainty")) {
    study.replicates = static_cast<int>(uncertainty->integer("replicates", 0, 10'000).value_or(50));
    study.seed = static_cast<std::uint64_t>(
        uncertainty->integer("seed", 0, std::numeric_limits<long long>::max()).value_or(1));
  }
  read_life(root, study);
  return study;
}

std::string error_text(double share) {
  return fmt::format("{:.1f}\u00a0% {} the measured wear", 100 * std::abs(share),
                     share < 0 ? "below" : "above");
}

}  // namespace wearwell::clutch
