#include "wearwell/prognosis/warranty_text.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/present/plain.h"
#include "wearwell/prognosis/decisions_tables.h"
#include "wearwell/prognosis/plural.h"
#include "wearwell/study/numerical_error.h"

namespace wearwell::prognosis {
namespace {

std::string error_text(const Warranty& warranty) {
  if (!std::isfinite(warranty.sure)) return "";
  const std::string error =
      warranty.error ? plain_number(100 * *warranty.error, 2) + " %" : std::string("unknown");
  if (warranty.populations > 0)
    return fmt::format(" (of {} possible populations; Monte Carlo error {})", warranty.populations,
                       error);
  if (warranty.error.value_or(0) > least_numerical_error)
    return fmt::format(" (numerical error {})", error);
  return "";
}

}  // namespace

std::string share_text(double share) {
  if (share > 0 && share < 0.0001) return "< 0.01 %";
  return fmt::format("{:.3g} %", 100 * share);
}

std::string warranty_text(const DecisionsReport& report) {
  const Shown shown{report};
  const Warranty& warranty = *report.decisions.warranty;
  const std::string share = share_text(warranty.share);
  if (!std::isfinite(warranty.length))
    return fmt::format("A warranty of any length has claims for less than {} of new {}.", share,
                       plural(report.lives.noun));
  const auto length = [&](double si) {
    return std::isfinite(si) ? shown.age(si) : std::string("any length");
  };
  std::string text = fmt::format("A warranty of {} has claims for {} of new {} on average",
                                 length(warranty.length), share, plural(report.lives.noun));
  if (report.lives.fresh.lives.size() > 1)
    text += fmt::format("; {} has at most that share with probability 95 %{}",
                        length(warranty.sure), error_text(warranty));
  return text + fmt::format(". At {} each, claims cost {} for each unit sold.",
                            shown.money(report.question.costs.failure),
                            shown.money(warranty.share * report.question.costs.failure));
}

}  // namespace wearwell::prognosis
