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

/// A study with the text that it was read from.
struct ReadStudy {
  std::shared_ptr<const Study> study;
  std::string text;
  std::shared_ptr<const Source> source = {};
};

/// What a run of it found.
struct Run {
  ReadStudy of;
  std::shared_ptr<const Result> result;
  std::string state = {};  ///< state.bin; empty of a study without a posterior
};

/// Of any model that is known. Throws InputError.
ReadStudy read(Source source);
/// A study as text; `path` is its name in messages, and files are looked for beside it.
ReadStudy read_text(const std::string& text, const std::string& path,
                    std::map<std::string, Table> tables);

/// As Study::run; alone on one thread in a forked process.
Run run(const ReadStudy& read, const RunOptions& options, Monitor monitor);

/// What the sampler tells of each draw, by the names of draws_1.csv without the two underscores: chain by chain. Empty
/// where there are no draws.
std::vector<std::pair<std::string, std::vector<double>>> sample_stats(const Run& run);

using Files = std::vector<std::pair<std::string, std::string>>;

/// Content is text but that of files that end in .bin. All files of its folder but the page, which is made of the others.
Files files_of(const Run& run);
/// report.html of summary.json and report.json.
std::string page_of(const std::string& summary, const std::string& report);
/// A folder of results, whole or not at all. Throws as ResultFolder does.
void write_folder(const std::string& target, const Files& files);

/// Draws, log-likelihoods and data as ArviZ reads them. Throws InputError of a study without a posterior. One thread at a
/// time: HDF5 below is not made for more, whoever else in the process uses it.
void write_netcdf(const Run& run, const std::string& target);

/// Predictions, quantities and life that another [predict] asks of the same posterior, as summary.json has them.
nlohmann::ordered_json asked(const Run& run, const ReadStudy& other, double level);

struct Compared {
  nlohmann::ordered_json json;
  std::string text, page;
};
/// Folders of results with their names.
Compared compared(const Files& names_and_folders);

}  // namespace wearwell::embed
