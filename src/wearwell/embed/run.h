#pragma once

#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "wearwell/input/source.h"
#include "wearwell/study/result.h"
#include "wearwell/study/study.h"

namespace wearwell::embed {

/// A study with its text.
struct ReadStudy {
  std::shared_ptr<const Study> study;
  std::string text;
  std::shared_ptr<const Source> source = {};
};

/// The outcome of a run.
struct Run {
  ReadStudy of;
  std::shared_ptr<const Result> result;
  std::string state = {};  ///< state.bin; empty for a study without a posterior
};

/// For any known model. Throws InputError.
ReadStudy read(Source source);
/// A study as text; `path` is its name in messages, and files are found relative to it.
ReadStudy read_text(const std::string& text, const std::string& path,
                    std::map<std::string, Table> tables);

/// As Study::run; on one thread in a forked process.
Run run(const ReadStudy& read, const RunOptions& options, Monitor monitor);

/// The sampler statistics of each draw, by the names in draws_1.csv without the two underscores:
/// chain by chain. Empty without draws.
std::vector<std::pair<std::string, std::vector<double>>> sample_stats(const Run& run);

using Files = std::vector<std::pair<std::string, std::string>>;

/// Content is text except for files that end in .bin. All files of its folder except the page,
/// which is made from the others.
Files files_of(const Run& run);
/// report.html from summary.json and report.json.
std::string page_of(const std::string& summary, const std::string& report);
/// A folder of results, complete or not at all. Throws as ResultFolder does.
void write_folder(const std::string& target, const Files& files);

/// Draws, log-likelihoods and data in the layout of ArviZ. Throws InputError for a study without a
/// posterior. One thread at a time: HDF5 is not thread-safe, whoever else in the process uses it.
void write_netcdf(const Run& run, const std::string& target);

/// Predictions, quantities and life for another [predict] with the same posterior, as in
/// summary.json; with predict.next or predict.classical also what the model adds to its result
/// ("repairable", "returns", "classical").
nlohmann::ordered_json asked(const Run& run, const ReadStudy& other, double level);

struct Compared {
  nlohmann::ordered_json json;
  std::string text, page;
};
/// Folders of results with their names.
Compared compared(const Files& names_and_folders);
/// A study fitted with each of several families of lives (study/family_ranking.h).
Compared compared_families(const ReadStudy& read, const std::string& families, Monitor monitor);

}  // namespace wearwell::embed
