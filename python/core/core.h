#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

/// The module wearwell._impl._core: what Python asks of the library (wearwell/embed). Plain texts, numbers and arrays go over; everything that a
/// user sees is made of them in python/wearwell.
namespace wearwell::python {

namespace py = pybind11;

void add_errors(py::module_& module);
void add_tables(py::module_& module);
void add_studies(py::module_& module);
void add_plans(py::module_& module);
void add_followed(py::module_& module);
void add_tools(py::module_& module);

}  // namespace wearwell::python
