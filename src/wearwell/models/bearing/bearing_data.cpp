#include "wearwell/models/bearing/bearing_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/table.h"

namespace wearwell {
namespace {

using bearing::Contact;

// One input of every inspection: from its column, or the same for all from [conditions].
struct Series {
  std::vector<double> values;  // SI
  std::optional<Quantity> constant;
  Unit unit;
};

// Reads the inputs of all inspections from columns or conditions.
class Inputs {
 public:
  Inputs(const TomlReader& root, const Source& source)
      : data_(root.required_table("data")),
        columns_(data_.required_table("columns")),
        conditions_(root.table("conditions")),
        table_(with_counts(columns_, read_table(data_, source))) {}

  const Table& table() const { return table_; }
  const TomlReader& columns() const { return columns_; }

  std::optional<Series> optional(const std::string& name, const std::string& si) {
    const auto column = read_column(columns_, name, si, table_);
    const auto constant = conditions_ ? positive_quantity(*conditions_, name, si) : std::nullopt;
    refuse_both(name);
    if (constant) {
      return Series{std::vector<double>(table_.rows, constant->si()), constant, constant->unit};
    }
    if (!column) return {};
    Series series{si_numbers(table_, *column), {}, column->unit};
    for (std::size_t i = 0; i < table_.rows; ++i) {
      require(series.values[i] > 0, table_, *column, i, "positive");
    }
    const bool grows = name == "revolutions" || name == "time";
    read_.push_back({name, si, series.unit, series.values, !grows});
    return series;
  }

  Series required(const std::string& name, const std::string& si) {
    auto series = optional(name, si);
    if (!series) {
      columns_.fail(name, fmt::format("is missing; give it here, or in [conditions] if it is the "
                                      "same for all: {} = \"NUMBER {}\"",
                                      name, si));
    }
    return *series;
  }

  // One of two ways to state a quantity.
  bool first_of(const std::string& first, const std::string& second,
                const std::string& third) const {
    const bool one = has(first), other = has(second) || has(third);
    if (one == other) {
      columns_.fail(one && has(second) ? second
                    : one              ? third
                                       : first,
                    fmt::format("{}; give {}, or {} with {}",
                                one ? fmt::format("is given, and so is {}", first) : "is missing",
                                first, second, third));
    }
    return one;
  }

  std::vector<Contact> contacts() const {
    const auto choice = read_word_column(columns_, "contact", table_);
    const auto constant = contact_in(conditions_);
    refuse_both("contact");
    if (constant) return std::vector<Contact>(table_.rows, *constant);
    if (!choice) {
      columns_.fail("contact",
                    fmt::format("is missing; give a column of text, or conditions.contact: {}",
                                fmt::join(bearing::contact_names(), ", ")));
    }
    const Column& column = table_.column(choice->column);
    std::vector<Contact> contacts;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      const std::string word = cell_word(column, i);
      const auto contact = bearing::contact_named(word);
      if (!contact) {
        throw InputError(fmt::format("{}: '{}' is not a contact; it is one of {} (nearest: '{}')",
                                     place(table_, choice->column, i), word,
                                     fmt::join(bearing::contact_names(), ", "),
                                     nearest_name(word, bearing::contact_names())));
      }
      contacts.push_back(*contact);
    }
    return contacts;
  }

  // The bearing of each row; without a column each row is its own.
  std::vector<std::size_t> bearings(std::vector<std::string>& names) const {
    std::vector<std::size_t> numbers(table_.rows);
    const auto choice = read_word_column(columns_, "bearing", table_);
    std::map<std::string, std::size_t> known;
    for (std::size_t i = 0; i < table_.rows; ++i) {
      std::string name = fmt::format("row {}", i + 1);
      if (choice) {
        name = label_word(table_, table_.column(choice->column), i);
      }
      numbers[i] = known.emplace(name, known.size()).first->second;
      if (known.size() > names.size()) names.push_back(name);
    }
    return numbers;
  }

  std::optional<Contact> constant_contact() const { return contact_in(conditions_); }

  const std::vector<DataColumn>& read() const { return read_; }

 private:
  bool has(const std::string& name) const {
    return columns_.has(name) || (conditions_ && conditions_->has(name));
  }
  void refuse_both(const std::string& name) const {
    if (!conditions_ || !conditions_->has(name) || !columns_.has(name)) return;
    conditions_->fail(name, fmt::format("is given here and as data.columns.{}; keep one", name));
  }

  TomlReader data_, columns_;
  std::optional<TomlReader> conditions_;
  Table table_;
  std::vector<DataColumn> read_;
};

// Depths below the size of an atom indicate a wrong unit in the study. The prior of k is then so
// far from the data that the quadrature does not converge.
void require_depths(const BearingData& data, const ColumnChoice& depth, const Table& table) {
  constexpr double atom = 1e-10;                 // m
  constexpr double shallow = 1e-7, deep = 1e-2;  // of measured depths with wear, m
  double largest = 0;
  for (const double each : data.inspections.depth) largest = std::max(largest, std::abs(each));
  if (largest == 0 || largest >= atom) return;
  const double number = from_si(data.depth_unit, largest);
  std::string likely;
  for (const auto& [name, size] : {std::pair("um", 1e-6), {"mm", 1e-3}, {"m", 1.0}}) {
    const double meant = number * size;
    if (meant < shallow || meant > deep) continue;
    likely = fmt::format("in {} it would be {:.3g} um: check the unit", name, meant / 1e-6);
    break;
  }
  if (likely.empty()) likely = "no unit of length makes it a wear depth: check these cells";
  throw InputError(
      fmt::format("{}: column '{}' (data.columns.depth): the largest depth is {:.4g} {}, less than "
                  "the size of an atom (1e-10 m); {}",
                  table.source, depth.column, number, data.depth_unit.text, likely));
}

}  // namespace

std::optional<Quantity> positive_quantity(const TomlReader& table, const std::string& name,
                                          const std::string& si) {
  auto quantity = table.quantity(name, si);
  if (!quantity) return {};
  if (!(quantity->si() > 0)) table.fail(name, "must be positive");
  return quantity;
}
std::optional<Contact> contact_in(const std::optional<TomlReader>& table) {
  const auto word = table ? table->choice("contact", bearing::contact_names()) : std::nullopt;
  return word ? bearing::contact_named(*word) : std::nullopt;
}

BearingData read_bearing_data(const TomlReader& root, const Source& source,
                              ObservationFamily family) {
  Inputs inputs(root, source);
  const Table& table = inputs.table();
  const Series radius = inputs.required("radius", "m");
  const Series clearance = inputs.required("clearance", "m");
  const std::vector<Contact> contacts = inputs.contacts();
  BearingData data;
  data.source = table.source;
  data.layout = table.layout;
  data.pressure_unit = read_unit("MPa", "Pa");
  std::vector<double> pressures, revolutions;
  if (inputs.first_of("pressure", "force", "length")) {
    const Series pressure = inputs.required("pressure", "Pa");
    pressures = pressure.values;
    data.pressure_unit = pressure.unit;
    data.common.pressure = pressure.constant;
  } else {
    const Series force = inputs.required("force", "N"), length = inputs.required("length", "m");
    for (std::size_t i = 0; i < table.rows; ++i) {
      pressures.push_back(force.values[i] / (2 * radius.values[i] * length.values[i]));
    }
    if (force.constant && length.constant && radius.constant) {
      data.common.pressure =
          Quantity{from_si(data.pressure_unit, pressures.front()), data.pressure_unit};
    }
  }
  if (inputs.first_of("revolutions", "speed", "time")) {
    revolutions = inputs.required("revolutions", "rev").values;
  } else {
    const Series speed = inputs.required("speed", "rev/s"), time = inputs.required("time", "s");
    for (std::size_t i = 0; i < table.rows; ++i) {
      revolutions.push_back(speed.values[i] * time.values[i]);
    }
    data.common.speed = speed.constant;
    data.speed = speed.values;
  }
  data.common.contact = inputs.constant_contact();
  data.common.radius = radius.constant;
  data.common.clearance = clearance.constant;

  const ColumnChoice depth = required_column(inputs.columns(), "depth", "m", table);
  data.depth_unit = depth.unit;
  data.inspections.depth = si_numbers(table, depth);
  require_depths(data, depth, table);
  data.columns = inputs.read();
  data.columns.push_back({"depth", "m", depth.unit, data.inspections.depth});
  for (std::size_t i = 0; i < table.rows; ++i) {
    const double d = data.inspections.depth[i];
    require(family == ObservationFamily::normal || d > 0, table, depth, i,
            "positive for the lognormal likelihood (or use family = \"normal\")");
    require(contacts[i] != Contact::stationary || d < 2 * radius.values[i], table, depth, i,
            "less than the journal's diameter");
    require(contacts[i] != Contact::journal || d < radius.values[i], table, depth, i,
            "less than the journal's radius");
    data.inspections.duty.push_back(
        {contacts[i], radius.values[i], clearance.values[i], pressures[i], revolutions[i]});
  }
  data.inspections.bearing = inputs.bearings(data.names);
  data.bearings = data.names.size();
  return data;
}

}  // namespace wearwell
