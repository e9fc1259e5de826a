#include <pybind11/numpy.h>

#include <variant>

#include "attended.h"
#include "core.h"
#include "wearwell/embed/export.h"
#include "wearwell/embed/follow.h"
#include "wearwell/embed/update.h"

namespace wearwell::python {
namespace {

using embed::Fitted;
using embed::FollowedUnit;
using embed::Population;
using SharedTable = std::shared_ptr<Table>;

// `rows`: tables, or paths of files.
embed::Run update(const embed::Run* run, const std::string& path,
                  const std::vector<std::variant<SharedTable, std::string>>& rows,
                  const std::string& repeated, int threads, bool report,
                  const py::object& progress) {
  std::vector<prognosis::NewRows> all;
  for (const auto& each : rows) {
    if (const auto* const table = std::get_if<SharedTable>(&each)) {
      all.emplace_back(**table);
    } else {
      all.emplace_back(std::filesystem::path(std::get<std::string>(each)));
    }
  }
  embed::Run updated;
  attended(progress, [&](Monitor monitor) {
    monitor.threads = threads;
    updated = embed::update({run, path}, all, repeated, report, std::move(monitor));
  });
  return updated;
}

// A study of a saved state as the study of a run is: what is pickled of an update.
embed::ReadStudy study_of_state(const py::bytes& state) {
  const std::string bytes = state;
  return interruptible([&] { return embed::study_of_state(bytes); });
}

// (at, level05, level50, level95), each an array.
py::tuple path_of(const FollowedUnit& unit) {
  std::vector<prognosis::ForecastBand> path;
  {
    const py::gil_scoped_release release;
    path = unit.path();
  }
  const auto column = [&](auto member) {
    py::array_t<double> values(static_cast<py::ssize_t>(path.size()));
    double* to = values.mutable_data();
    for (const prognosis::ForecastBand& each : path) *to++ = each.*member;
    return values;
  };
  using Band = prognosis::ForecastBand;
  return py::make_tuple(column(&Band::at), column(&Band::level05), column(&Band::level50),
                        column(&Band::level95));
}

// (text, JSON, CSV of each forecast).
py::tuple backtest(const Population& population, const SharedTable& readings,
                   const SharedTable& lives) {
  embed::Backtested test;
  attended(py::none{},
           [&](const Monitor&) { test = embed::backtest(population, *readings, *lives); });
  return py::make_tuple(test.text, test.json, test.forecasts);
}

}  // namespace

void add_followed(py::module_& module) {
  using unlocked = py::call_guard<py::gil_scoped_release>;
  py::class_<Population, std::shared_ptr<Population>>(module, "Population")
      .def_readonly("trusted", &Population::trusted)
      .def("units",
           [](const Population& population) {
             const auto seen = population.tracker->seen();
             return std::vector<std::string>(seen.begin(), seen.end());
           })
      .def("backtest", &backtest);
  py::class_<FollowedUnit>(module, "FollowedUnit")
      .def(py::init([](const std::shared_ptr<Population>& population, const std::string& unit,
                       bool fresh) { return FollowedUnit(population, unit, fresh); }),
           unlocked())
      .def("update",
           [](FollowedUnit& unit, const SharedTable& rows) {
             return interruptible([&] { return unit.update(*rows); });
           })
      .def("json", &FollowedUnit::json, unlocked())
      .def("risk", &FollowedUnit::risk, unlocked())
      .def("path", &path_of);
  module.def("population_of", [](const embed::Run* run, const std::string& path) {
    return interruptible([&] {
      return std::const_pointer_cast<Population>(embed::population_of({run, path}));
    });
  });
  module.def("update", &update);
  module.def("study_of_state", &study_of_state);
  module.def("study_with_text", [](const embed::ReadStudy& study, const std::string& text) {
    return interruptible([&] { return embed::with_text(study, text); });
  });
  module.def("export_c",
             [](const embed::Run* run, const std::string& path, const std::string& arguments) {
               embed::CCode code;
               {
                 const py::gil_scoped_release release;
                 code = embed::export_c({run, path}, arguments);
               }
               return py::make_tuple(code.files, code.text, code.trusted);
             });
  module.def("export_sql",
             [](const embed::Run* run, const std::string& path, const std::string& arguments) {
               embed::SqlCode code;
               {
                 const py::gil_scoped_release release;
                 code = embed::export_sql({run, path}, arguments);
               }
               return py::make_tuple(code.text, code.trusted);
             });
}

}  // namespace wearwell::python
