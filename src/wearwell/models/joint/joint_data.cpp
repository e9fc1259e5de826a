#include "wearwell/models/joint/joint_data.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/table.h"
#include "wearwell/models/joint/inspection.h"

namespace wearwell::joint {
namespace {

// A profile of force and slip over one cycle: work per cycle.
double read_profile(const TomlReader& profile, const Source& source) {
  const auto rule = profile.choice("rule", {"rectangle", "trapezoid"});
  if (!rule) profile.fail("rule", "is missing: \"rectangle\" (sum of F_i ds_i) or \"trapezoid\"");
  const TomlReader columns = profile.required_table("columns");
  const Table table = read_table(profile, source);
  const ColumnChoice force = required_column(columns, "force", "N", table);
  const ColumnChoice slip = required_column(columns, "slip_increment", "m", table);
  try {
    return work_per_cycle(si_numbers(table, force), si_numbers(table, slip),
                          *rule == "rectangle" ? WorkRule::rectangle : WorkRule::trapezoid);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", table.source, error.what()));
  }
}

// k = V/(F s), for each measurement alone.
PointwiseTable pointwise_table(const Table& table, const std::vector<double>& cycles,
                               const ColumnChoice& volume, const ColumnChoice& force,
                               const ColumnChoice& slip) {
  PointwiseTable result{
      volume.unit.text,
      force.unit.text,
      slip.unit.text,
      fmt::format("{}/({} {})", volume.unit.text, force.unit.text, slip.unit.text),
      {}};
  const auto v = si_numbers(table, volume), f = si_numbers(table, force),
             s = si_numbers(table, slip);
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(f[i] > 0, table, force, i, "positive");
    require(s[i] > 0, table, slip, i, "positive");
    const double fv = from_si(force.unit, f[i]), sv = from_si(slip.unit, s[i]),
                 vv = from_si(volume.unit, v[i]);
    result.rows.push_back({cycles[i], fv, sv, vv, vv / (fv * sv)});
  }
  return result;
}

// The friction work of each inspection, from the source that the study names.
void read_work(const TomlReader& root, const TomlReader& columns, const Source& source,
               const Table& table, JointData& data) {
  const auto conditions = root.table("conditions");
  const auto constant =
      conditions ? conditions->quantity("work_per_cycle", "N m/cycle") : std::nullopt;
  const auto profile = conditions ? conditions->table("profile") : std::nullopt;
  const auto work = read_column(columns, "work", "N m", table);
  const auto force = read_column(columns, "force", "N", table);
  const auto slip = read_column(columns, "slip", "m", table);
  if (force.has_value() != slip.has_value()) {
    columns.fail(force ? "slip" : "force", "is missing: force and slip go together");
  }
  if (constant.has_value() + profile.has_value() + work.has_value() > 1) {
    root.fail("conditions",
              "the work is given twice; keep one of conditions.work_per_cycle, conditions.profile "
              "and data.columns.work");
  }

  if (constant || profile) {
    data.work_per_cycle = constant ? constant->si() : read_profile(*profile, source);
    if (!(*data.work_per_cycle > 0)) conditions->fail("work_per_cycle", "must be positive");
    data.work_text =
        constant ? fmt::format("cycles x {:.6g} {}", constant->value, constant->unit.text)
                 : fmt::format("cycles x {:.6g} N m (from the profile)", *data.work_per_cycle);
    for (const double c : data.cycles) data.inspections.work.push_back(c * *data.work_per_cycle);
  } else if (work) {
    data.work_text = fmt::format("column '{}'", work->column);
    data.inspections.work = si_numbers(table, *work);
    for (std::size_t i = 0; i < table.rows; ++i) {
      require(data.inspections.work[i] >= 0, table, *work, i, "0 or more");
    }
    data.columns.push_back({"work", "N m", work->unit, data.inspections.work});
  } else if (force) {
    data.work_text = fmt::format("'{}' x '{}'", force->column, slip->column);
    const auto f = si_numbers(table, *force), s = si_numbers(table, *slip);
    for (std::size_t i = 0; i < table.rows; ++i) data.inspections.work.push_back(f[i] * s[i]);
    data.columns.push_back({"force", "N", force->unit, f, true});
    data.columns.push_back(
        {.name = "slip", .si = "m", .unit = slip->unit, .values = s, .endless = true});
  } else {
    root.fail("conditions",
              "the friction work is missing; give conditions.work_per_cycle, conditions.profile, "
              "data.columns.work, or data.columns.force and slip");
  }
  if (force && data.inspections.volume.size() == table.rows) {
    data.pointwise = pointwise_table(table, data.cycles,
                                     *read_column(columns, "volume", "m^3", table), *force, *slip);
  }
}

// Worn volume from pin positions: rows are angles, inspections are the distinct numbers of cycles.
void read_pin_positions(const TomlReader& root, const TomlReader& columns, const Table& table,
                        JointData& data) {
  if (columns.has("force") || columns.has("work")) {
    columns.fail(columns.has("force") ? "force" : "work",
                 "pin positions (dx, dy) have many rows per inspection; give "
                 "conditions.work_per_cycle or profile");
  }
  const ColumnChoice dx = required_column(columns, "dx", "m", table),
                     dy = required_column(columns, "dy", "m", table);
  const TomlReader conditions = root.required_table("conditions");
  const Quantity pin = conditions.required_quantity("pin_radius", "m");
  const Quantity bushing = conditions.required_quantity("bushing_radius", "m");
  const Quantity length = conditions.required_quantity("length", "m");
  if (!(pin.si() > 0 && bushing.si() > pin.si())) {
    conditions.fail("bushing_radius", "must be larger than pin_radius, and both positive");
  }
  if (!(length.si() > 0)) conditions.fail("length", "must be positive");
  data.volume_unit = read_unit("mm^3", "m^3");
  data.columns.push_back({"dx", "m", dx.unit, si_numbers(table, dx)});
  data.columns.push_back({"dy", "m", dy.unit, si_numbers(table, dy)});
  WornVolume worn = worn_volume({pin.si(), bushing.si(), length.si()}, data.cycles,
                                (data.columns.end() - 2)->values, data.columns.back().values);
  data.cycles = std::move(worn.cycles);
  data.inspections.volume = std::move(worn.volume);
}

}  // namespace

JointData read_joint_data(const TomlReader& root, const Source& source, ObservationFamily family) {
  const TomlReader data_table = root.required_table("data");
  const TomlReader columns = data_table.required_table("columns");
  const bool positions = columns.has("dx") || columns.has("dy");
  if (positions && columns.has("volume")) {
    columns.fail("volume", "is given, and so are pin positions (dx, dy); keep one of the two");
  }

  const Table table = with_counts(columns, read_table(data_table, source));
  const ColumnChoice cycles = required_column(columns, "cycles", "cycle", table);
  JointData data;
  data.layout = table.layout;
  data.name = data_table.text("joint").value_or("joint");
  data.cycles = si_numbers(table, cycles);
  for (std::size_t i = 0; i < table.rows; ++i) {
    require(data.cycles[i] >= 0, table, cycles, i, "0 or more");
  }
  data.columns.push_back({"cycles", "cycle", cycles.unit, data.cycles});
  if (positions) {
    read_pin_positions(root, columns, table, data);
  } else {
    const ColumnChoice volume = required_column(columns, "volume", "m^3", table);
    data.volume_unit = volume.unit;
    data.inspections.volume = si_numbers(table, volume);
    data.columns.push_back({"volume", "m^3", volume.unit, data.inspections.volume});
    if (family == ObservationFamily::lognormal) {
      for (std::size_t i = 0; i < table.rows; ++i) {
        require(data.inspections.volume[i] > 0, table, volume, i,
                "positive for the lognormal likelihood (or use family = \"normal\")");
      }
    }
  }
  read_work(root, columns, source, table, data);

  const std::size_t rows = data.cycles.size();
  if (rows < 2) {
    throw InputError(
        fmt::format("{} has {} inspection; a wear coefficient and its scatter need at least 2",
                    table.source, rows));
  }
  const auto& work = data.inspections.work;
  if (*std::max_element(work.begin(), work.end()) <= 0) {
    throw InputError(
        fmt::format("{}: no inspection has any friction work before it", table.source));
  }
  if (family == ObservationFamily::lognormal) {
    for (std::size_t i = 0; i < rows; ++i) {
      if (work[i] <= 0 || data.inspections.volume[i] <= 0) {
        throw InputError(
            fmt::format("{}, inspection {}: work and volume must be positive for the lognormal "
                        "likelihood (or use family = \"normal\")",
                        table.source, i + 1));
      }
    }
  }
  return data;
}

}  // namespace wearwell::joint
