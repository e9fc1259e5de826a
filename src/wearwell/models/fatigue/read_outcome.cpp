#include "wearwell/models/fatigue/read_outcome.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/base/error.h"

namespace wearwell {

using fatigue::Outcome;

namespace {

Outcome outcome_of(Censoring seen) {
  switch (seen) {
    case Censoring::none:
      return Outcome::failure;
    case Censoring::right:
      return Outcome::runout;
    case Censoring::left:
      return Outcome::left;
    case Censoring::interval:
      return Outcome::interval;
  }
  return Outcome::failure;
}

}  // namespace

Outcome read_outcome(const Table& table, const LifeStatus& status, std::size_t row) {
  return outcome_of(seen_in(table, status, row));
}

Outcome read_outcome(const Table& table, const std::optional<LifeStatus>& status,
                     const ColumnChoice& life, Censoring seen, std::size_t row) {
  if (!status || seen == Censoring::none)
    return status ? read_outcome(table, *status, row) : outcome_of(seen);
  if (seen_in(table, *status, row) != seen)
    throw InputError(
        fmt::format("{}: '{}' is a limit, but column '{}' has '{}'; correct one of them",
                    place(table, life.column, row), cell_word(table.column(life.column), row),
                    status->column, cell_word(table.column(status->column), row)));
  return outcome_of(seen);
}

double read_interval_end(const Table& table, const ColumnChoice& until, std::size_t row,
                         const fatigue::LifeTest& test) {
  const double end = to_si(until.unit, cell_number(table, table.column(until.column), row));
  if (test.outcome == Outcome::interval) {
    if (std::isnan(end)) {
      throw InputError(fmt::format("{}: no value; an interval ends at a second life",
                                   place(table, until.column, row)));
    }
    require(end > test.life && std::isfinite(end), table, until, row,
            "more than the life at its start, and finite");
    return end;
  }
  const bool harmless =
      std::isnan(end) || end == test.life || (test.outcome == Outcome::runout && end == INFINITY);
  if (!harmless) {
    throw InputError(
        fmt::format("{}: {} would end an interval, but the row's status is {}: write interval "
                    "there, or leave this cell empty",
                    place(table, until.column, row), cell_word(table.column(until.column), row),
                    test.outcome == Outcome::failure ? "a failure (the default)" : "none"));
  }
  return 0;
}

}  // namespace wearwell
