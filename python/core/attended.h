#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>

#include "core.h"
#include "wearwell/embed/attended.h"

namespace wearwell::python {

/// Does `work`, a function of a Monitor, without the interpreter's lock, while this thread looks for Ctrl-C and tells
/// `progress` (a function of what, done, total and seconds, or None) how far it is.
template <class Work>
void attended(const py::object& progress, const Work& work) {
  embed::attended<py::gil_scoped_release>(
      work, [&](const std::optional<embed::ProgressSnapshot>& reported) {
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        if (reported && !progress.is_none())
          progress(reported->what, reported->done, reported->total, reported->seconds);
      });
}

}  // namespace wearwell::python
