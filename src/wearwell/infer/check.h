#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

namespace wearwell {

enum class Verdict { pass, warn, fail };

/// One check of the results.
struct Check {
  std::string name;
  Verdict verdict = Verdict::pass;
  std::string detail;  ///< the finding, with numbers
  std::string advice;  ///< advice; empty if the check passes
};

/// Collects findings; the worst one determines the verdict and the advice.
class Findings {
 public:
  explicit Findings(std::string name) { check_.name = std::move(name); }

  void add(Verdict verdict, const std::string& detail, const std::string& advice) {
    if (verdict > check_.verdict) {
      check_.verdict = verdict;
      check_.advice = advice;
    }
    details_.push_back(detail);
  }

  Check result(const std::string& detail_if_none) {
    check_.detail =
        details_.empty() ? detail_if_none : fmt::format("{}", fmt::join(details_, "; "));
    return check_;
  }

 private:
  Check check_;
  std::vector<std::string> details_;
};

}  // namespace wearwell
