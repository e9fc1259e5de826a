#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "attended.h"
#include "core.h"
#include "wearwell/embed/cycles.h"
#include "wearwell/embed/tools.h"
#include "wearwell/models/bearing/answer.h"

namespace wearwell::python {
namespace {

// (summary.json, text, models.csv, page) of a selection; as `wearwell select` with these options.
py::tuple select(const std::variant<std::shared_ptr<Table>, std::string>& data, SelectData asked,
                 const embed::SelectOptions& options, int threads) {
  const auto* const table = std::get_if<std::shared_ptr<Table>>(&data);
  if (!table) asked.file = std::get<std::string>(data);
  embed::Selected selected;
  attended(py::none{}, [&](Monitor monitor) {
    monitor.threads = threads;
    selected = embed::select(asked, table ? table->get() : nullptr, options, monitor);
  });
  return py::make_tuple(selected.summary, selected.text, selected.models, selected.page);
}

py::array_t<double> array_of(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// Cycles and half cycles in the order in which they close: from, to, count.
py::tuple rainflow(const py::array_t<double, py::array::forcecast>& signal, bool three_points,
                   bool repeat) {
  const auto view = signal.unchecked<1>();
  std::vector<double> samples;
  samples.reserve(static_cast<std::size_t>(view.shape(0)));
  for (py::ssize_t i = 0; i < view.shape(0); ++i) samples.push_back(view(i));
  embed::Cycles cycles;
  attended(py::none{}, [&](const Monitor& monitor) {
    cycles = embed::rainflow(samples, three_points, repeat, monitor);
  });
  return py::make_tuple(array_of(cycles.from), array_of(cycles.to), array_of(cycles.count));
}

py::tuple bearing_answer(const std::string& command, const std::string& contact,
                         const std::map<std::string, std::string>& inputs, const std::string& unit,
                         const std::string& limit, int draws, std::uint64_t seed) {
  const bearing::Answer answer = interruptible([&] {
    return bearing::answer(command, contact, inputs,
                           {.unit = unit, .limit = limit, .draws = draws, .seed = seed});
  });
  return py::make_tuple(bearing::to_json(answer).dump(), bearing::warnings(answer), answer.margin);
}

}  // namespace

void add_tools(py::module_& module) {
  module.def("select",
             [](const std::variant<std::shared_ptr<Table>, std::string>& data,
                const std::string& response, const std::vector<std::string>& inputs,
                std::optional<int> degree, const std::vector<std::string>& terms,
                const std::string& weights, const std::vector<std::string>& forced,
                const std::string& criterion, int keep, double near, int folds, int nested,
                std::uint64_t seed, double seconds, int threads, bool report) {
               return select(data, {{}, {}, response, inputs, degree, terms, weights, forced},
                             {.criterion = criterion,
                              .keep = keep,
                              .near = near,
                              .folds = folds,
                              .nested = nested,
                              .seed = seed,
                              .seconds = seconds,
                              .report = report},
                             threads);
             });
  module.def("rainflow", &rainflow);
  module.def("bearing", &bearing_answer);
  using embed::PlateCycles;
  py::class_<PlateCycles>(module, "Cycles")
      .def(py::init<const std::string&, bool, bool>())
      .def("add", &PlateCycles::add, py::call_guard<py::gil_scoped_release>())
      .def("add_file", &PlateCycles::add_file, py::call_guard<py::gil_scoped_release>())
      .def("json", [](const PlateCycles& cycles) { return cycles.json().dump(); });
}

}  // namespace wearwell::python
