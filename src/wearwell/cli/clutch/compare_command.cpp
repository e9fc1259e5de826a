#include <fmt/format.h>
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "wearwell/base/error.h"
#include "wearwell/cli/clutch/command_parts.h"
#include "wearwell/input/json_reader.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/saved_result.h"

namespace wearwell::clutch {
namespace {

/// A result folder as one row of Table 4 of the paper.
std::vector<std::string> row_of(const std::filesystem::path& folder) {
  const std::filesystem::path file = summary_file(folder);
  const auto summary = read_json(file);
  const JsonReader json(summary, file);
  const std::string model = json.at("model").text();
  if (model != "clutch-wear")
    throw InputError(
        fmt::format("{} is of model {}, not of a clutch; wearwell compare takes every model",
                    file.string(), model));
  const std::vector<JsonReader> maps = json.at("maps").items();
  if (maps.empty()) json.at("maps").fail("is empty");
  const JsonReader& map = maps.front();
  return {json.at("title").text(),
          fmt::format("{:.3f}", map.at("r2").number()),
          fmt::format("{:.3f}", map.at("r2p").number()),
          fmt::format("{:.3g}", map.at("rmse").number()),
          fmt::format("{}", map.at("terms").items().size()),
          fmt::format("{:.1f}", map.at("r").number()),
          fmt::format("{:.1f}", map.at("q").number()),
          fmt::format("{:.4g}", json.at("run_in").at("w0").at("value").number())};
}

}  // namespace

void add_compare_command(CLI::App& clutch) {
  CLI::App* command =
      clutch.add_subcommand("compare", "Compare several materials by their results");
  const auto folders = std::make_shared<std::vector<std::filesystem::path>>();
  command->add_option("DIR", *folders, "Folders that wearwell fit wrote")->required();
  command->footer("Example:\n  wearwell clutch compare a-results b-results");
  command->callback([folders] {
    std::vector<std::vector<std::string>> rows = {
        {"material", "R2", "R2p", "RMSE [mm^3/MJ]", "terms", "r", "q", "w0 [mm^3/MJ]"}};
    for (const auto& folder : *folders) rows.push_back(row_of(folder));
    fmt::print("{}", text_table(rows));
  });
}

}  // namespace wearwell::clutch
