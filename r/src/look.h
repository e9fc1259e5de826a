#pragma once

#include <optional>
#include <type_traits>
#include <utility>

#include "core.h"
#include "wearwell/embed/attended.h"

namespace wearwell::r {

struct Nothing {
  ~Nothing() {}  // NOLINT: R has no lock to let go of while its thread waits
};

/// Work on a thread of its own, while R's looks for Ctrl-C and calls `progress`, a function of what, done, total and
/// seconds, or NULL.
template <class Work>
void attended(SEXP progress, const Work& work) {
  embed::attended<Nothing>(work, [&](const std::optional<embed::ProgressSnapshot>& reported) {
    Rcpp::checkUserInterrupt();
    if (!reported || Rf_isNull(progress)) return;
    const Rcpp::Function function(progress);
    function(reported->what, static_cast<double>(reported->done),
             static_cast<double>(reported->total), reported->seconds);
  });
}

/// What `work` returns; the same without progress. `work` calls nothing of R.
template <class Work>
auto interruptible(const Work& work) {
  std::optional<std::invoke_result_t<const Work&>> result;
  attended(R_NilValue, [&](const Monitor&) { result.emplace(work()); });
  return std::move(*result);
}

}  // namespace wearwell::r
