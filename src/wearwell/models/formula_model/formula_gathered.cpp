#include "wearwell/models/formula_model/formula_gathered.h"

#include <map>
#include <optional>
#include <tuple>

#include "wearwell/base/stop_scope.h"
#include "wearwell/models/formula_model/formula_row_columns.h"
#include "wearwell/prob/gathered_responses.h"

namespace wearwell::formula_model {
namespace {

// A gathered row costs what another does.
constexpr std::size_t least_saving = 4;

// Bound rows whose slots are the same whatever the parameters.
struct Alike {
  std::size_t table_row = 0;  // of one of them
  std::vector<Response> responses;
  std::vector<double> counts;
};

// By all that the column's expressions depend on, in the order of their numbers; none where there are too many.
std::optional<std::vector<Alike>> alike_rows(const FormulaModel& model, const BoundColumn& bound) {
  const Measured& measured = *bound.measured;
  std::vector<std::size_t> table_rows;
  for (const std::size_t term : bound.term) table_rows.push_back(measured.observed.rows[term]);
  const RowColumns columns(model, table_rows, measured.program);
  const std::size_t most = bound.unit.size() / (least_saving * 8);
  std::map<std::vector<double>, std::size_t> known;
  std::vector<Alike> groups;
  std::vector<double> key;
  for (std::size_t i = 0; i < table_rows.size(); ++i) {
    check_stop();
    key.clear();
    for (const auto& each : columns.numbers) {
      if (!each.empty()) key.push_back(each[i]);
    }
    for (const auto& each : columns.labels) {
      if (!each.empty()) key.push_back(each[i]);
    }
    const auto [at, is_new] = known.try_emplace(key, groups.size());
    if (is_new) {
      if (groups.size() == most) return {};
      groups.push_back({table_rows[i], {}, {}});
    }
    groups[at->second].responses.push_back(bound.responses.rows[i]);
    groups[at->second].counts.push_back(bound.count[i]);
  }
  return groups;
}

// `which`: rows of the table with the conditions of each response.
BoundColumn few_rows(const FormulaModel& model, const BoundColumn& bound,
                     const std::vector<std::size_t>& which, std::vector<Response> responses,
                     std::vector<double> counts) {
  const formula::Program& program = bound.measured->program;
  BoundColumn few;
  few.measured = bound.measured;
  few.most_rows = bound.most_rows;
  few.unit.assign(which.size(), 0);
  few.term.assign(which.size(), 0);
  few.begin = {0, which.size()};
  few.count = std::move(counts);
  few.data = program.bind(RowColumns(model, which, program).rows);
  few.responses = ResponseColumn(std::move(responses));
  return few;
}

// Equal observations as one: those of a returns triangle depend on the time since the sale alone.
std::optional<BoundColumn> without_repetitions(const FormulaModel& model,
                                               const BoundColumn& bound) {
  const Measured& measured = *bound.measured;
  std::map<std::tuple<Censoring, double, double>, std::size_t> known;
  std::vector<std::size_t> which;
  std::vector<Response> responses;
  std::vector<double> counts;
  for (std::size_t i = 0; i < bound.unit.size(); ++i) {
    const Response& y = bound.responses.rows[i];
    const auto [at, is_new] =
        known.try_emplace(std::tuple(y.seen, y.at, y.until), responses.size());
    if (is_new) {
      which.push_back(measured.observed.rows[bound.term[i]]);
      responses.push_back(y);
      counts.push_back(0);
    }
    counts[at->second] += bound.count[i];
  }
  return few_rows(model, bound, which, std::move(responses), std::move(counts));
}

std::optional<BoundColumn> gathered(const FormulaModel& model, const BoundColumn& bound) {
  const Measured& measured = *bound.measured;
  if (measured.reporting) return without_repetitions(model, bound);
  if (bound.unit.size() < gathered_from || !can_be_gathered(*measured.form) ||
      measured.life.families.size() > 1)
    return {};
  const auto groups = alike_rows(model, bound);
  if (!groups) return {};
  std::vector<std::size_t> which;
  std::vector<Response> responses;
  std::vector<double> counts;
  for (const Alike& group : *groups) {
    for (const WeightedResponse& each :
         gathered_responses(group.responses, group.counts, measured.form->positive)) {
      which.push_back(group.table_row);
      responses.push_back(each.response);
      counts.push_back(each.weight);
    }
    if (which.size() > bound.unit.size() / least_saving) return {};
  }
  return few_rows(model, bound, which, std::move(responses), std::move(counts));
}

}  // namespace

std::vector<BoundColumn> gathered_columns(const FormulaModel& model,
                                          const std::vector<BoundColumn>& columns) {
  if (model.by_unit() || model.units.size() > 1) return {};
  std::vector<BoundColumn> all;
  for (const BoundColumn& bound : columns) {
    if (bound.measured->program.has_paths()) return {};
    auto few = gathered(model, bound);
    if (!few) return {};
    all.push_back(std::move(*few));
  }
  return all;
}

}  // namespace wearwell::formula_model
