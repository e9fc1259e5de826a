#pragma once

#include <string>
#include <vector>

#include "wearwell/infer/check.h"
#include "wearwell/present/section.h"

namespace wearwell {

/// "pass", "warn" or "fail".
const char* verdict_kind(Verdict verdict);

/// Names of the checks with this verdict: "fit, sense".
std::string names_of(const std::vector<Check>& checks, Verdict verdict);

/// Whether to use the numbers, in a line: "Trusted, with a warning: ..."
std::string trust_line(const std::vector<Check>& checks);

/// The same in a cell: "yes", "with a warning" or "no".
const char* trust_word(const std::vector<Check>& checks);

/// Whether to use the numbers, and if not, what to do.
present::Callout trust_callout(const std::vector<Check>& checks);

/// Every check with what it found.
present::Table checks_table(const std::vector<Check>& checks);

}  // namespace wearwell
