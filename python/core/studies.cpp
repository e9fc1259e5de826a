#include <pybind11/numpy.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <atomic>

#include "attended.h"
#include "core.h"
#include "wearwell/base/error.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/models/registry.h"
#include "wearwell/netcdf/netcdf_file.h"
#include "wearwell/present/result_folder.h"
#include "wearwell/present/section_json.h"
#include "wearwell/study/comparison.h"
#include "wearwell/study/inference_data.h"
#include "wearwell/study/json.h"
#include "wearwell/study/model.h"
#include "wearwell/study/result_writer.h"
#include "wearwell/study/saved_result.h"
#include "wearwell/study/summarize.h"

namespace wearwell::python {

namespace {
std::atomic<pid_t> threads_of = 0;  // the process that started them
}

struct ForkGuard::Limit {
  tbb::global_control one{tbb::global_control::max_allowed_parallelism, 1};
};

ForkGuard::ForkGuard() {
  pid_t none = 0;
  const pid_t here = getpid();
  if (!threads_of.compare_exchange_strong(none, here) && none != here)
    limit_ = std::make_unique<Limit>();
}
ForkGuard::~ForkGuard() = default;

namespace {

using Files = std::vector<std::pair<std::string, std::string>>;

ReadStudy read(Source source) {
  const py::gil_scoped_release release;
  const ForkGuard guard;
  ReadStudy result;
  result.study = read_study(source, all_models());
  result.text = std::move(source.study.text);
  return result;
}

ReadStudy read_text(const std::string& text, const std::string& path,
                    const std::map<std::string, std::shared_ptr<Table>>& tables) {
  Source source{{path, text}, {}};
  for (const auto& [name, table] : tables) source.tables.emplace(name, *table);
  return read(std::move(source));
}

Run run(const ReadStudy& read, const std::string& method, std::optional<int> chains,
        std::optional<int> warmup, std::optional<int> draws, std::optional<std::uint64_t> seed,
        int threads, bool report, py::object progress) {
  RunOptions options{{{}, chains, warmup, draws, seed}, report};
  if (!method.empty()) {
    options.sampler.method = method == "exact"  ? Method::exact
                             : method == "nuts" ? Method::nuts
                                                : Method::metropolis;
  }
  Attended attended(std::move(progress));
  Run run{read, {}};
  attended.run([&] {
    const ForkGuard guard;
    const Monitor monitor = attended.monitor(guard.forked() ? 1 : threads);
    run.result = std::make_shared<const Result>(read.study->run(options, monitor));
  });
  return run;
}

// The numbers of every draw: chains x draws x columns, in memory column by column, as data frames and Arrow have them.
py::array_t<double> draws_of(const Run& run) {
  if (!run.result->posterior) return py::array_t<double>(std::vector<py::ssize_t>{0, 0, 0});
  const Draws& draws = run.result->posterior->posterior_draws;
  const py::ssize_t n = draws.empty() ? 0 : draws.front().values.rows();
  const py::ssize_t columns = draws.empty() ? 0 : draws.front().values.cols();
  const auto chains = static_cast<py::ssize_t>(draws.size());
  constexpr py::ssize_t size = sizeof(double);
  py::array_t<double> all({chains, n, columns}, {n * size, size, chains * n * size});
  double* to = all.mutable_data();
  for (py::ssize_t c = 0; c < columns; ++c) {
    for (const Chain& chain : draws)
      for (py::ssize_t d = 0; d < n; ++d) *to++ = chain.values(d, c);
  }
  return all;
}

// Columns as draws_1.csv has them before the parameters, without the two underscores.
std::map<std::string, py::array_t<double>> sample_stats(const Run& run) {
  std::map<std::string, py::array_t<double>> stats;
  if (!run.result->posterior) return stats;
  const Draws& draws = run.result->posterior->posterior_draws;
  if (draws.empty()) return stats;
  const auto n = static_cast<py::ssize_t>(draws.front().log_density.size());
  const auto add = [&](const char* name, const auto& value) {
    py::array_t<double> all({static_cast<py::ssize_t>(draws.size()), n});
    double* to = all.mutable_data();
    for (const Chain& chain : draws) {
      for (std::size_t d = 0; d < static_cast<std::size_t>(n); ++d)
        *to++ = static_cast<double>(value(chain, d));
    }
    stats.emplace(name, std::move(all));
  };
  add("lp", [](const Chain& c, std::size_t d) { return c.log_density[d]; });
  if (draws.front().nuts.empty()) return stats;
  add("accept_stat", [](const Chain& c, std::size_t d) { return c.nuts[d].accept_stat; });
  add("stepsize", [](const Chain& c, std::size_t) { return c.step_size; });
  add("treedepth", [](const Chain& c, std::size_t d) { return c.nuts[d].treedepth; });
  add("n_leapfrog", [](const Chain& c, std::size_t d) { return c.nuts[d].n_leapfrog; });
  add("divergent", [](const Chain& c, std::size_t d) { return c.nuts[d].divergent; });
  add("energy", [](const Chain& c, std::size_t d) { return c.nuts[d].energy; });
  return stats;
}

// All files of its folder but the page, which is made of the others.
Files files_of(const Run& run) {
  const py::gil_scoped_release release;
  const Result& result = *run.result;
  Files files = {{"summary.json", summary_text(result)}};
  files.insert(files.end(), result.files.begin(), result.files.end());
  for (const present::Table* table : present::tables(result.sections))
    files.emplace_back("tables/" + table->id + ".csv", present::csv(*table));
  if (!result.sections.empty()) {
    using Json = nlohmann::ordered_json;
    files.emplace_back(
        "report.json",
        present::to_json(result.sections).dump(-1, ' ', false, Json::error_handler_t::replace) +
            "\n");
  }
  files.emplace_back("study.toml", run.of.text);
  return files;
}

std::string page_of(const std::string& summary, const std::string& report) {
  const py::gil_scoped_release release;
  const SavedReport saved = read_saved_report(summary, report);
  return report_html(saved.header, saved.sections);
}

void write_folder(const std::string& target, const Files& files) {
  const py::gil_scoped_release release;
  ResultFolder folder(target);
  for (const auto& [name, content] : files) folder.write(name, content);
  folder.commit();
}

const PosteriorSummary& posterior_of(const Run& run) {
  static_cast<void>(require_posterior_study(*run.of.study));
  return *run.result->posterior;
}

std::vector<netcdf::Group> groups_of(const Run& run) {
  const ForkGuard guard;
  return inference_data(require_posterior_study(*run.of.study), posterior_of(run));
}

// NetCDF is written with the interpreter's lock held: other modules use the same library, and it is not made for two
// threads.
void write_netcdf(const Run& run, const std::string& target) {
  std::vector<netcdf::Group> groups;
  {
    const py::gil_scoped_release release;
    groups = groups_of(run);
  }
  netcdf::write(target, groups);
}

// Predictions, quantities and life that another [predict] asks of the same posterior, as summary.json has them.
std::string asked(const Run& run, const ReadStudy& other, double level) {
  const py::gil_scoped_release release;
  const ForkGuard guard;
  constexpr double usual = 0.9;
  const Ends ends = level == usual ? Ends{} : Ends{(1 - level) / 2, (1 + level) / 2};
  const PosteriorSummary answers =
      asked_later(require_posterior_study(*other.study), posterior_of(run), ends);
  return posterior_json(answers).dump();
}

py::tuple compared(const std::vector<std::pair<std::string, std::string>>& names_and_folders) {
  std::vector<std::pair<std::string, SavedResult>> results;
  for (const auto& [name, folder] : names_and_folders)
    results.emplace_back(name, read_saved_result(folder));
  const Comparison comparison = compare(std::move(results));
  return py::make_tuple(to_json(comparison).dump(), comparison_text(comparison),
                        comparison_page(comparison));
}

}  // namespace

void add_studies(py::module_& module) {
  py::class_<ReadStudy>(module, "ReadStudy")
      .def_readonly("text", &ReadStudy::text)
      .def("in_words",
           [](const ReadStudy& read) {
             const py::gil_scoped_release release;
             const ForkGuard guard;
             return read.study->in_words();
           })
      .def("run", &run, py::arg("method"), py::arg("chains"), py::arg("warmup"), py::arg("draws"),
           py::arg("seed"), py::arg("threads"), py::arg("report"), py::arg("progress"));
  py::class_<Run>(module, "Run")
      .def("summary", [](const Run& run) { return summary_text(*run.result); })
      .def("terminal", [](const Run& run) { return terminal_text(*run.result, {}); })
      .def("draws", &draws_of)
      .def("sample_stats", &sample_stats)
      .def("files", &files_of)
      .def("write_netcdf", &write_netcdf)
      .def("asked", &asked);
  module.def("read_file", [](const std::string& file) { return read(source_of(file)); });
  module.def("read_text", &read_text);
  module.def("page_of", &page_of);
  module.def("write_folder", &write_folder);
  module.def("write_file", [](const std::string& target, const std::string& content) {
    const py::gil_scoped_release release;
    wearwell::write_file(target, content);
  });
  module.def("compared", &compared);
}

}  // namespace wearwell::python
