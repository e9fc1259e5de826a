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

/// The verdict as a line: "Trusted, with a warning: ..."
std::string trust_line(const std::vector<Check>& checks);

/// The verdict as a table cell: "yes", "with a warning" or "no".
const char* trust_word(const std::vector<Check>& checks);

/// The verdict, with advice if a check failed.
present::Callout trust_callout(const std::vector<Check>& checks);

/// Every check as lines for a terminal: verdict, name and finding, then the advice.
std::string checks_text(const std::vector<Check>& checks);

/// Every check with its finding.
present::Table checks_table(const std::vector<Check>& checks);

/// The verdict and every check, of a result whose report has no verdict of its own.
present::Section checks_section(const std::vector<Check>& checks);

}  // namespace wearwell
