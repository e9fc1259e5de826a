#pragma once

#define STRICT_R_HEADERS
#include <Rcpp.h>

#include <cstdint>
#include <map>
#include <new>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/shown.h"
#include "wearwell/embed/cycles.h"
#include "wearwell/embed/run.h"
#include "wearwell/input/table.h"

/// What R asks of the library: plain texts, numbers and lists go over; everything that a user sees is made of them in r/R.
/// Rcpp stands between: what R throws by longjmp unwinds C++ first, also in calls within calls.
namespace wearwell::r {

/// Objects of the library that R holds, and the library's object again.
template <class T>
SEXP hold(T value) {
  return Rcpp::XPtr<T>(new T(std::move(value)));
}
template <class T>
T& held(SEXP object) {
  return *Rcpp::XPtr<T>(object).checked_get();
}

/// A text in UTF-8, whatever R's locale.
SEXP text_of(const std::string& text);
SEXP texts_of(const std::vector<std::string>& texts);
/// Objects are named lists; arrays of numbers, texts or truths are vectors, others lists; null is NA.
SEXP list_of(const nlohmann::ordered_json& json);
/// A list whose names are those of the pairs.
SEXP named_list(const std::vector<std::pair<std::string, SEXP>>& entries);

/// list("input" or "machine", message): r/R makes a condition of it, when nothing of C++ stands on the stack any more.
SEXP failure(const char* kind, const char* message);

template <class T>
T given(SEXP value) {
  if constexpr (std::is_same_v<T, SEXP>) {
    return value;
  } else {
    return Rcpp::as<T>(value);
  }
}

/// A function of the library as R calls it: errors are values (r/R/errors.R raises them), interrupts and errors of R go on
/// as such.
template <auto f>
struct Door;
template <class... A, SEXP (*f)(A...)>
struct Door<f> {
  static constexpr int arguments = sizeof...(A);

  template <class>
  using Any = SEXP;
  static SEXP call(Any<A>... values) {
    BEGIN_RCPP
    try {
      return f(given<std::decay_t<A>>(values)...);
    } catch (const InputError& error) {
      return failure("input", error.what());
    } catch (const MachineError& error) {
      return failure("machine", error.what());
    } catch (const std::system_error& error) {  // of the file system too
      return failure("machine", error.what());
    } catch (const std::bad_alloc&) {
      return failure("machine", "out of memory");
    }
    END_RCPP
  }
};

template <auto f>
R_CallMethodDef door(const char* name) {
  const auto any = reinterpret_cast<void (*)()>(&Door<f>::call);
  return {name, reinterpret_cast<DL_FUNC>(any), Door<f>::arguments};
}

using Doors = std::vector<R_CallMethodDef>;
void add_tables(Doors& doors);
void add_studies(Doors& doors);
void add_plans(Doors& doors);
void add_followed(Doors& doors);
void add_tools(Doors& doors);

}  // namespace wearwell::r
