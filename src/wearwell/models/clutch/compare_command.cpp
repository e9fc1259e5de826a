#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>

#include "wearwell/base/error.h"

#include <CLI/CLI.hpp>
#include "wearwell/models/clutch/command_parts.h"
#include "wearwell/present/text_table.h"

namespace wearwell::clutch {
namespace {

/// A result folder as one row of Table 4.
std::vector<std::string> row_of(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "summary.json";
  std::ifstream stream(file);
  if (!stream) throw InputError(fmt::format("cannot read {}", file.string()));
  try {
    const auto json = nlohmann::json::parse(stream);
    const auto& map = json.at("maps").at(0);
    return {json.at("title").get<std::string>(),
            fmt::format("{:.3f}", map.at("r2").get<double>()),
            fmt::format("{:.3f}", map.at("r2p").get<double>()),
            fmt::format("{:.3g}", map.at("rmse").get<double>()),
            fmt::format("{}", map.at("terms").size()),
            fmt::format("{:.1f}", map.at("r").get<double>()),
            fmt::format("{:.1f}", map.at("q").get<double>()),
            fmt::format("{:.4g}", json.at("run_in").at("w0").at("value").get<double>())};
  } catch (const nlohmann::json::exception& error) {
    throw InputError(
        fmt::format("{} is no summary of a clutch study: {}", file.string(), error.what()));
  }
}

}  // namespace

void add_compare_command(CLI::App& clutch) {
  CLI::App* command =
      clutch.add_subcommand("compare", "Several materials beside each other, from their results");
  const auto folders = std::make_shared<std::vector<std::filesystem::path>>();
  command->add_option("DIR", *folders, "folders that wearwell fit wrote")->required();
  command->footer("Example:\n  wearwell clutch compare a-results b-results");
  command->callback([folders] {
    std::vector<std::vector<std::string>> rows = {
        {"material", "R2", "R2p", "RMSE [mm^3/MJ]", "terms", "r", "q", "w0 [mm^3/MJ]"}};
    for (const auto& folder : *folders) rows.push_back(row_of(folder));
    fmt::print("{}", text_table(rows));
  });
}

}  // namespace wearwell::clutch
