#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "wearwell/study/result.h"
#include "wearwell/study/study.h"

/// The module wearwell._core: what Python asks of the library. Plain texts, numbers and arrays go over; everything that a
/// user sees is made of them in python/wearwell.
namespace wearwell::python {

namespace py = pybind11;

/// A study with the text that it was read from.
struct ReadStudy {
  std::shared_ptr<const Study> study;
  std::string text;
};

/// What a run of it found.
struct Run {
  ReadStudy of;
  std::shared_ptr<const Result> result;
};

/// While it lives, a process that was forked after the library had started its threads uses one: the others are not there.
class ForkGuard {
 public:
  ForkGuard();
  ~ForkGuard();
  ForkGuard(const ForkGuard&) = delete;
  ForkGuard& operator=(const ForkGuard&) = delete;
  bool forked() const { return limit_ != nullptr; }

 private:
  struct Limit;
  std::unique_ptr<Limit> limit_;
};

void add_errors(py::module_& module);
void add_tables(py::module_& module);
void add_studies(py::module_& module);
void add_tools(py::module_& module);

}  // namespace wearwell::python
