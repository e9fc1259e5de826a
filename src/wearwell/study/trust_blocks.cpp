#include "wearwell/study/trust_blocks.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/printable.h"
#include "wearwell/present/text_table.h"

namespace wearwell {

const char* verdict_kind(Verdict verdict) {
  static constexpr const char* kinds[] = {"pass", "warn", "fail"};
  return kinds[static_cast<int>(verdict)];
}

std::string names_of(const std::vector<Check>& checks, Verdict verdict) {
  std::string names;
  for (const Check& check : checks) {
    if (check.verdict == verdict) names += (names.empty() ? "" : ", ") + check.name;
  }
  return names;
}

namespace {

Verdict worst_of(const std::vector<Check>& checks) {
  Verdict worst = Verdict::pass;
  for (const Check& check : checks) worst = std::max(worst, check.verdict);
  return worst;
}

}  // namespace

std::string trust_line(const std::vector<Check>& checks) {
  const Verdict worst = worst_of(checks);
  const std::string names = names_of(checks, worst);
  if (worst == Verdict::pass) return "Trusted: no check failed.";
  return worst == Verdict::warn
             ? fmt::format("Trusted, with a warning: no check failed; see {}.", names)
             : fmt::format("NOT TRUSTED: {} failed; do not use these numbers.", names);
}

const char* trust_word(const std::vector<Check>& checks) {
  static constexpr const char* words[] = {"yes", "with a warning", "no"};
  return words[static_cast<int>(worst_of(checks))];
}

std::string checks_text(const std::vector<Check>& checks) {
  static constexpr const char* words[] = {"pass", "WARN", "FAIL"};
  std::string text;
  for (const Check& check : checks) {
    text += wrapped(fmt::format("{}  {}: {}", words[static_cast<int>(check.verdict)], check.name,
                                printable(check.detail)),
                    2, 8);
    if (!check.advice.empty()) text += wrapped("-> " + check.advice, 8, 11);
  }
  return text;
}

present::Callout trust_callout(const std::vector<Check>& checks) {
  const Verdict worst = worst_of(checks);
  if (worst == Verdict::pass)
    return {"pass", "Trusted.", fmt::format("All {} checks passed.", checks.size())};
  const std::string names = names_of(checks, worst);
  if (worst == Verdict::warn) {
    return {"warn", "Trusted, with a warning.", fmt::format("No check failed; see {}.", names)};
  }
  std::string advice;
  for (const Check& check : checks) {
    if (check.verdict == Verdict::fail && !check.advice.empty()) advice += " " + check.advice;
  }
  return {"fail", "Not trusted.",
          fmt::format("Do not use these numbers: {} failed.{}", names, advice)};
}

present::Table checks_table(const std::vector<Check>& checks) {
  static constexpr const char* words[] = {"Passed", "Warning", "Failed"};
  present::Table table{"checks",
                       "Every check",
                       {{"Check"}, {"Verdict"}, {"What was found"}, {"What to do"}},
                       {},
                       true};
  for (const Check& check : checks) {
    table.rows.push_back(
        {check.name,
         present::Badge{verdict_kind(check.verdict), words[static_cast<int>(check.verdict)]},
         check.detail, check.advice});
  }
  return table;
}

present::Section checks_section(const std::vector<Check>& checks) {
  present::Section section{"checks", "Checks"};
  section.add(trust_callout(checks));
  section.add(checks_table(checks));
  return section;
}

}  // namespace wearwell
