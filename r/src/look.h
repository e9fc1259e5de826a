#pragma once

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

}  // namespace wearwell::r
