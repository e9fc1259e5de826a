#include "wearwell/in_service/reading_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/prognosis/change_watch.h"

namespace wearwell::in_service {
namespace {

// Texts first, then the numbers that the table has; rows by unit, and along the axis of life.
struct ReadingQuery {
  std::string text;
  std::size_t texts = 0;
};

ReadingQuery reading_query_of(const fleet::Engine& engine, const ReadingColumns& columns,
                              std::size_t axis) {
  const fleet::Dialect dialect = engine.dialect();
  const auto name = [&](const std::string& column) {
    return "t." + fleet::identifier(dialect, column);
  };
  std::vector<std::string> cells, order, others;
  // Names, since places in `order by` are constants in older ClickHouse.
  const auto add = [&](const std::string& cell) {
    const std::string alias = fmt::format("wearwell_{}", cells.size() + 1);
    cells.push_back(fmt::format("{} as {}", cell, alias));
    return alias;
  };
  order.push_back(add(fleet::text(dialect, name(columns.unit))));
  for (const std::string& each : columns.labels)
    others.push_back(add(fleet::text(dialect, name(each))));
  const std::size_t texts = cells.size();
  for (std::size_t i = 0; i < columns.numbers.size(); ++i) {
    if (columns.numbers[i].column.empty()) continue;
    const std::string alias = add(fleet::real(
        dialect, fleet::number_cell(name(columns.numbers[i].column), columns.text_decimal)));
    if (i == axis) {
      order.push_back(alias);
    } else {
      others.push_back(alias);
    }
  }
  order.insert(order.end(), others.begin(), others.end());
  return {fmt::format("select {} from {} as t order by {}", fmt::join(cells, ", "), engine.table(),
                      fmt::join(order, ", ")),
          texts};
}

class ReadingReader {
 public:
  ReadingReader(const fleet::Engine& engine, const ReadingColumns& columns,
                const prognosis::Tracker& tracker, const StudyReadings& study,
                const ReadReadings& how, ReadingRows& rows,
                const std::function<void(UnitReadings&& unit)>& take)
      : source_(engine.source()),
        columns_(columns),
        tracker_(tracker),
        study_(study),
        how_(how),
        rows_(rows),
        take_(take),
        axis_(prognosis::watched_columns(tracker).axis) {}

  void add(const fleet::Row& row) {
    constexpr double between_checks = 4096;
    if (std::fmod(rows_.rows, between_checks) == 0 && how_.stop.stop_requested()) throw Cancelled();
    ++rows_.rows;
    const std::string& unit = row.texts.front();
    const prognosis::Reading reading = reading_of(row);
    if (unit.empty()) return leave_out(unit, "it has no unit", reading);
    if (const std::string problem = problem_of(reading); !problem.empty())
      return leave_out(unit, problem, reading);
    if (study_.has(unit)) {
      const StudyReadings::Place place = study_.place(unit, reading);
      if (place == StudyReadings::Place::unclear) return leave_out(unit, unclear(unit), reading);
      if (place == StudyReadings::Place::same) {
        ++rows_.in_study;
        begin(unit);
        return;
      }
    }
    begin(unit);
    now_.readings.push_back(reading);
  }

  void finish() {
    if (!now_.unit.empty()) take_(std::move(now_));
    now_ = {};
  }

 private:
  prognosis::Reading reading_of(const fleet::Row& row) const {
    prognosis::Reading reading;
    std::size_t number = 0;
    for (const fleet::UnitColumn& each : columns_.numbers)
      reading.numbers.push_back(each.column.empty() ? std::nan("")
                                                    : to_si(each.unit, row.numbers[number++]));
    reading.labels.assign(row.texts.begin() + 1, row.texts.end());
    return reading;
  }

  std::string problem_of(const prognosis::Reading& reading) const {
    for (std::size_t i = 0; i < reading.numbers.size(); ++i) {
      const prognosis::ReadingColumn& column = tracker_.columns()[i];
      if (std::isinf(reading.numbers[i]) || (std::isnan(reading.numbers[i]) && !column.carried))
        return column.name + " is missing or not a number";
    }
    for (std::size_t i = 0; i < reading.labels.size(); ++i)
      if (reading.labels[i].empty()) return tracker_.labels()[i] + " is missing";
    return tracker_.problem(reading);
  }

  std::string unclear(const std::string& unit) const {
    return fmt::format(
        "the study has readings of it up to {} = {:.6g} {}, and this is not one of them: it may be "
        "a late reading, or one of the study with other digits; fit with it (wearwell update), or "
        "leave it out; rename the unit if it is another one",
        tracker_.axis().name, from_si(tracker_.axis().unit, study_.last(unit)),
        tracker_.axis().unit.text);
  }

  void leave_out(const std::string& unit, const std::string& problem,
                 const prognosis::Reading& reading) {
    const double at = reading.numbers[axis_];
    if (!how_.skip_bad)
      throw InputError(fmt::format(
          "{}: row of {} '{}'{}: {}; --skip-bad leaves such rows out and reports them", source_,
          tracker_.noun(), printable(unit),
          std::isfinite(at)
              ? fmt::format(" at {} = {:.6g} {}", tracker_.axis().name,
                            from_si(tracker_.axis().unit, at), tracker_.axis().unit.text)
              : "",
          printable(problem)));
    rows_.leave_out({printable(unit), problem, at});
  }

  void begin(const std::string& unit) {
    if (now_.unit == unit) return;
    finish();
    if (!rows_.units.insert(unit).second)
      throw InputError(
          fmt::format("{}: {} '{}' has rows in another table as well: give all its readings in one",
                      source_, tracker_.noun(), printable(unit)));
    if (const std::string why = tracker_.refusal(unit); !why.empty())
      throw InputError(fmt::format("{}: {}", source_, why));
    now_ = {unit, study_.has(unit)};
  }

  const std::string source_;
  const ReadingColumns& columns_;
  const prognosis::Tracker& tracker_;
  const StudyReadings& study_;
  const ReadReadings& how_;
  ReadingRows& rows_;
  const std::function<void(UnitReadings&& unit)>& take_;
  const std::size_t axis_;
  UnitReadings now_;
};

}  // namespace

void for_each_unit(fleet::Engine& engine, const ReadingColumns& columns,
                   const prognosis::Tracker& tracker, const StudyReadings& study,
                   const ReadReadings& how, ReadingRows& rows,
                   const std::function<void(UnitReadings&& unit)>& take) {
  const ReadingQuery query =
      reading_query_of(engine, columns, prognosis::watched_columns(tracker).axis);
  ReadingReader reader(engine, columns, tracker, study, how, rows, take);
  engine.begin();
  engine.rows(query.text, query.texts, [&](const fleet::Row& row) { reader.add(row); });
  engine.commit();
  reader.finish();
}

}  // namespace wearwell::in_service
