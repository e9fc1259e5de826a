#include "wearwell/cli/life_against.h"

#include <fmt/format.h>

#include "wearwell/base/printable.h"
#include "wearwell/cli/carried.h"
#include "wearwell/prognosis/lives_against_report.h"

namespace wearwell {

int run_life_against(const LifeAgainstOptions& options, Models models) {
  const prognosis::LivesAgainstReport report = prognosis::lives_against_report(
      {options.unit, options.horizon, options.confidence},
      {read_carried(options.result), options.result.string()},
      {read_carried(options.against), options.against.string()}, models);
  fmt::print("{}", options.json ? printable_json(lives_against_json(report).dump(2)) + "\n"
                                : lives_against_text(report));
  return report.not_trusted.empty() ? 0 : 1;
}

}  // namespace wearwell
