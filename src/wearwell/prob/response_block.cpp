#include "wearwell/prob/response_block.h"

#include <cmath>

#include "wearwell/prob/families.h"

namespace wearwell {
namespace {

using Rows = void (*)(const ResponseColumn&, std::size_t begin,
                      std::span<const ParameterValues> family_parameters, std::span<double> value,
                      std::span<double> slope);

// For a row with an invalid slot.
void refuse(std::size_t i, std::size_t family_parameters, std::span<double> value,
            std::span<double> slope) {
  const std::size_t n = value.size();
  value[i] = -infinity;
  for (std::size_t s = 0; s < (slope.empty() ? 0 : family_parameters); ++s) slope[s * n + i] = 0;
}

// Exact observations of a family of two slots, by its row formula.
template <class F, bool sloped>
void exact_rows(const ResponseColumn& column, std::size_t begin,
                std::span<const ParameterValues> family_parameters, std::span<double> value,
                std::span<double> slope) {
  const std::size_t n = value.size();
  const double* at = (F::positive ? column.log_at : column.at).data() + begin;
  double log_s[2] = {};
  for (std::size_t i = 0; i < n; ++i) {
    const double s[] = {family_parameters[0][i], family_parameters[1][i]};
    if (i == 0 || !family_parameters[0].uniform) log_s[0] = F::log_of_first(s[0]);
    if (i == 0 || !family_parameters[1].uniform) log_s[1] = F::log_of_second(s[1]);
    if (!families::allowed<F>(s)) {
      refuse(i, family_parameters.size(), value, slope);
      continue;
    }
    const families::Row row = F::template row<sloped>(at[i], s, log_s);
    value[i] = row.value;
    if constexpr (sloped) {
      slope[i] = row.slope[0];
      slope[n + i] = row.slope[1];
    }
  }
}

struct Exact {
  Rows value, sloped;
};

constexpr families::FamilyTable<Exact> table = [] {
  families::FamilyTable<Exact> all{};
  families::for_each_family([&all]<class F>(std::size_t i) {
    if constexpr (requires { &F::template row<true>; }) {
      all[i] = {exact_rows<F, false>, exact_rows<F, true>};
    }
  });
  return all;
}();

}  // namespace

ResponseColumn::ResponseColumn(std::vector<Response> responses) : rows(std::move(responses)) {
  plain = true;
  bool all_positive = true;
  for (const Response& each : rows) {
    plain = plain && each.seen == Censoring::none && each.entry == -infinity && each.trials == 0;
    all_positive = all_positive && each.at > 0;
  }
  if (!plain) return;
  for (const Response& each : rows) at.push_back(each.at);
  if (!all_positive) return;
  for (const Response& each : rows) log_at.push_back(std::log(each.at));
}

void log_responses(ResponseFamily family, const ResponseColumn& column, std::size_t begin,
                   std::span<const ParameterValues> family_parameters, std::span<double> value,
                   std::span<double> slope) {
  const std::size_t n = value.size();
  const bool sloped = !slope.empty();
  const Exact& exact = table[static_cast<std::size_t>(family)];
  const bool logs = column.log_at.size() == column.rows.size();
  if (exact.value && column.plain && (logs || !form_of(family).positive)) {
    return (sloped ? exact.sloped : exact.value)(column, begin, family_parameters, value, slope);
  }
  double s[most_response_parameters] = {};
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < family_parameters.size(); ++k) s[k] = family_parameters[k][i];
    if (!sloped) {
      value[i] = log_response_value(family, column.rows[begin + i], s);
      continue;
    }
    const ResponseTerm term = log_response(family, column.rows[begin + i], s);
    if (!(term.value > -infinity)) {
      refuse(i, family_parameters.size(), value, slope);
      continue;
    }
    value[i] = term.value;
    for (std::size_t k = 0; k < family_parameters.size(); ++k) slope[k * n + i] = term.slope[k];
  }
}

}  // namespace wearwell
