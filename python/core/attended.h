#pragma once

#include <pybind11/functional.h>
#include <pybind11/pybind11.h>

#include <optional>
#include <type_traits>
#include <utility>

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

/// What `work` returns; the same without progress.
template <class Work>
auto interruptible(const Work& work) {
  std::optional<std::invoke_result_t<const Work&>> result;
  attended(py::none{}, [&](const Monitor&) { result.emplace(work()); });
  return std::move(*result);
}

}  // namespace wearwell::python
