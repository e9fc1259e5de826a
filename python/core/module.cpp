#include <pybind11/pybind11.h>

#include <filesystem>
#include <new>
#include <system_error>

#include "core.h"
#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/base/shown.h"

namespace wearwell::python {

// The exceptions are classes of wearwell._impl.errors, so that they can be pickled and documented as Python's.
void add_errors(py::module_&) {
  const py::module_ errors = py::module_::import("wearwell._impl.errors");
  static const py::handle input = py::object(errors.attr("InputError")).release();
  static const py::handle machine = py::object(errors.attr("MachineError")).release();
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const InputError& error) {
      PyErr_SetString(input.ptr(), shown(error.what()).c_str());
    } catch (const MachineError& error) {
      PyErr_SetString(machine.ptr(), shown(error.what()).c_str());
    } catch (const std::system_error& error) {  // of the file system too
      PyErr_SetString(machine.ptr(), shown(error.what()).c_str());
    } catch (const std::bad_alloc&) {
      PyErr_SetString(machine.ptr(), "out of memory");
    } catch (const Cancelled& cancelled) {
      PyErr_SetString(PyExc_KeyboardInterrupt, cancelled.what());
    }
  });
}

}  // namespace wearwell::python

PYBIND11_MODULE(_core, module) {
  using namespace wearwell::python;
  module.attr("version") = WEARWELL_VERSION;
  add_errors(module);
  add_tables(module);
  add_studies(module);
  add_plans(module);
  add_followed(module);
  add_tools(module);
}
