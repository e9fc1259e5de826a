#include <pybind11/numpy.h>

#include "attended.h"
#include "core.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/embed/fitted.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/embed/residuals.h"
#include "wearwell/embed/run.h"
#include "wearwell/study/posterior_summary.h"
#include "wearwell/study/result_writer.h"

namespace wearwell::python {
namespace {

using embed::ReadStudy;
using embed::Run;

ReadStudy read_text(const std::string& text, const std::string& path,
                    const std::map<std::string, std::shared_ptr<Table>>& tables) {
  std::map<std::string, Table> own;
  for (const auto& [name, table] : tables) own.emplace(name, *table);
  return interruptible([&] { return embed::read_text(text, path, std::move(own)); });
}

Run run(const ReadStudy& read, const std::string& method, std::optional<int> chains,
        std::optional<int> warmup, std::optional<int> draws, std::optional<std::uint64_t> seed,
        int threads, bool report, const py::object& progress) {
  RunOptions options{{{}, chains, warmup, draws, seed}, report};
  if (!method.empty()) {
    options.sampler.method = method == "exact"  ? Method::exact
                             : method == "nuts" ? Method::nuts
                                                : Method::metropolis;
  }
  Run run;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    run = embed::run(read, options, monitor);
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

// Chains x draws each.
std::map<std::string, py::array_t<double>> sample_stats(const Run& run) {
  std::map<std::string, py::array_t<double>> stats;
  for (const auto& [name, values] : embed::sample_stats(run)) {
    const std::size_t chains = run.result->posterior->posterior_draws.size();
    stats.emplace(name,
                  py::array_t<double>(std::vector{chains, values.size() / chains}, values.data()));
  }
  return stats;
}

// Of each observation its score and whether it is censored; what an observation is.
py::tuple residuals_of(const Run& run) {
  const embed::Residuals found = interruptible([&] {
    const embed::ForkGuard guard;
    return embed::residuals(run);
  });
  return py::make_tuple(found.score, found.censored, found.noun);
}

// Texts, but of files that end in .bin bytes.
py::list files_of(const Run& run) {
  const embed::Files files = interruptible([&] { return embed::files_of(run); });
  py::list all;
  for (const auto& [name, content] : files) {
    all.append(name.ends_with(".bin") ? py::make_tuple(name, py::bytes(content))
                                      : py::make_tuple(name, content));
  }
  return all;
}

// NetCDF is written with the interpreter's lock held: other modules use the same library, and it is not made for two
// threads.
void write_netcdf(const Run& run, const std::string& target) {
  embed::write_netcdf(run, target);
}

py::tuple compared(const embed::Files& names_and_folders) {
  const embed::Compared compared =
      interruptible([&] { return embed::compared(names_and_folders); });
  return py::make_tuple(compared.json.dump(), compared.text, compared.page);
}

py::tuple compared_families(const ReadStudy& read, const std::string& families, int threads,
                            const py::object& progress) {
  embed::Compared compared;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    compared = embed::compared_families(read, families, std::move(monitor));
  });
  return py::make_tuple(compared.json.dump(), compared.text, compared.page);
}

}  // namespace

void add_studies(py::module_& module) {
  using unlocked = py::call_guard<py::gil_scoped_release>;
  py::class_<ReadStudy>(module, "ReadStudy")
      .def_readonly("text", &ReadStudy::text)
      .def("description",
           [](const ReadStudy& read) {
             return interruptible([&] {
               const embed::ForkGuard guard;
               return read.study->description();
             });
           })
      .def("run", &run, py::arg("method"), py::arg("chains"), py::arg("warmup"), py::arg("draws"),
           py::arg("seed"), py::arg("threads"), py::arg("report"), py::arg("progress"));
  py::class_<Run>(module, "Run")
      .def("summary", [](const Run& run) { return summary_text(*run.result); })
      .def("terminal", [](const Run& run) { return terminal_text(*run.result, {}); })
      .def("draws", &draws_of)
      .def("sample_stats", &sample_stats)
      .def("residuals", &residuals_of)
      .def("files", &files_of)
      .def("state", [](const Run& run) { return py::bytes(embed::saved_state(run)); })
      .def("write_netcdf", &write_netcdf)
      .def("asked", [](const Run& run, const ReadStudy& other, double level) {
        return interruptible([&] { return embed::asked(run, other, level).dump(); });
      });
  module.def("read_file", [](const std::string& file) {
    return interruptible([&] { return embed::read(source_of(file)); });
  });
  module.def("read_text", &read_text);
  module.def("page_of", &embed::page_of, unlocked());
  module.def("write_folder", &embed::write_folder, unlocked());
  module.def("write_file", [](const std::string& target, const std::string& content) {
    const py::gil_scoped_release release;
    wearwell::write_file(target, content);
  });
  module.def("compared", &compared);
  module.def("compared_families", &compared_families);
}

}  // namespace wearwell::python
