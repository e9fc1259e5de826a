#include <fmt/format.h>
#include <pybind11/numpy.h>

#include <cmath>
#include <optional>

#include "arrow.h"
#include "arrow_export.h"
#include "attended.h"
#include "core.h"
#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/embed/fork_guard.h"
#include "wearwell/embed/memory_table.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/life_status.h"
#include "wearwell/input/prior.h"
#include "wearwell/models/formula_model/straight_line.h"
#include "wearwell/study/column_values.h"
#include "wearwell/study/life_size.h"

namespace wearwell::python {
namespace {

using Numbers = py::array_t<double, py::array::forcecast>;

// (median, log_sd, failed, the words for both) of the default prior of a life.
py::tuple size_of_lives(const Table& table, const std::string& lines,
                        const std::vector<std::string>& runouts, double least,
                        const std::vector<std::string>& stresses) {
  const LifeSize size = interruptible([&] {
    LifeHeadings headings = life_headings(lines, table);
    headings.runouts = runouts;
    return life_size_under(table, headings, least, stresses);
  });
  return py::make_tuple(size.median, size.log_sd, size.failed, words_of(size));
}

void add_numbers(Column& column, const py::array& values) {
  const Numbers numbers = Numbers::ensure(values);  // the same array where it holds doubles
  if (!numbers) throw py::error_already_set();
  const auto view = numbers.unchecked<1>();
  column.is_number = true;
  column.numbers.resize(static_cast<std::size_t>(view.shape(0)));
  for (py::ssize_t i = 0; i < view.shape(0); ++i)
    column.numbers[static_cast<std::size_t>(i)] = view(i);
}

void add_text(Column& column, const py::sequence& values, const std::string& table) {
  std::size_t row = 0;
  for (const py::handle each : values) {
    ++row;
    if (row % 65'536 == 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (py::isinstance<py::str>(each)) {
      Py_ssize_t size = 0;
      const char* const text = PyUnicode_AsUTF8AndSize(each.ptr(), &size);
      if (!text) {
        PyErr_Clear();
        throw InputError(fmt::format("{}, row {}, column '{}': the text is not Unicode", table, row,
                                     column.name));
      }
      column.text.emplace_back(text, static_cast<std::size_t>(size));
    } else if (each.is_none() ||
               (PyFloat_Check(each.ptr()) && std::isnan(PyFloat_AS_DOUBLE(each.ptr())))) {
      column.text.emplace_back();
    } else {
      throw InputError(
          fmt::format("{}, row {}, column '{}': {} in a column of objects, which may hold texts "
                      "alone; numbers need a dtype of numbers (astype(float))",
                      table, row, column.name,
                      std::string(py::str(py::type::handle_of(each).attr("__name__")))));
    }
  }
}

// (heading, unit, array of numbers or list of texts).
using Named = std::tuple<std::string, std::string, py::object>;

Table table_of(const std::string& name, const std::vector<Named>& columns) {
  Table table;
  table.source = name;
  for (const auto& [heading, unit, values] : columns) {
    Column column;
    column.name = heading;
    column.unit = unit;
    if (py::isinstance<py::array>(values)) {
      add_numbers(column, py::reinterpret_borrow<py::array>(values));
    } else {
      add_text(column, py::reinterpret_borrow<py::sequence>(values), name);
    }
    embed::add_column(table, std::move(column));
  }
  embed::refuse_no_table(table);
  return table;
}

// (whether the path begins at 0, whether it falls, its rate): what `wearwell new --from` proposes a prior with.
std::tuple<bool, bool, double> straight_line(const Table& table, const std::string& axis,
                                             const std::string& measured,
                                             const std::optional<std::string>& unit) {
  const formula_model::StraightLine line = formula_model::straight_line(
      table, table.column(axis), table.column(measured), unit ? &table.column(*unit) : nullptr);
  return {line.begins_at_zero, line.falls, line.rate};
}

void require_rows_of_family(const Table& table, const std::string& axis,
                            const std::string& measured, const std::string& family) {
  attended(py::none{}, [&](const Monitor&) {
    formula_model::require_rows_of_family(table, table.column(axis), table.column(measured),
                                          family);
  });
}

}  // namespace

void add_tables(py::module_& module) {
  // Python keeps with a table which of its columns were of booleans.
  py::class_<Table, std::shared_ptr<Table>>(module, "Table", py::dynamic_attr())
      .def_readonly("rows", &Table::rows)
      .def("headings",
           [](const Table& table) {
             std::vector<std::string> names;
             for (const Column& each : table.columns) names.push_back(each.name);
             return names;
           })
      .def("numbers",
           [](const Table& table, const std::string& heading) {
             const std::vector<double> numbers =
                 interruptible([&] { return numbers_of(table, table.column(heading)); });
             return py::array_t<double>(static_cast<py::ssize_t>(numbers.size()), numbers.data());
           })
      .def("words",
           [](const Table& table, const std::string& heading) {
             const Column& column = table.column(heading);
             return interruptible([&] {
               std::vector<std::string> words;
               for (std::size_t i = 0; i < table.rows; ++i) {
                 check_stop();
                 words.push_back(cell_word(column, i));
               }
               return words;
             });
           })
      .def("unit", [](const Table& table,
                      const std::string& heading) { return table.column(heading).unit; })
      .def("add_units", &embed::add_units);
  module.def("table_of", &table_of);
  module.def("table_of_arrow", [](const std::string& name, const py::capsule& capsule) {
    void* const stream = PyCapsule_GetPointer(capsule.ptr(), "arrow_array_stream");
    if (!stream) throw py::error_already_set();
    ArrowTable read = read_arrow(*static_cast<ArrowArrayStream*>(stream), name);
    embed::refuse_no_table(read.table);
    return std::make_pair(std::move(read.table), std::move(read.truths));
  });
  module.def("arrow_stream_of", &arrow_stream_of);
  module.def("rounded_up", &rounded_up);
  module.def("life_size", &size_of_lives);
  module.def("straight_line", &straight_line);
  module.def("require_rows_of_family", &require_rows_of_family);
  module.def("failure_code_of", &failure_code_of);
  module.def("table_of_file", [](const std::string& file, const std::optional<std::string>& sql) {
    const py::gil_scoped_release release;
    const embed::ForkGuard guard;
    return read_table(file, sql);
  });
}

}  // namespace wearwell::python
