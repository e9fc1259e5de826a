#include "wearwell/models/bearing/reading_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <limits>

#include "wearwell/base/printable.h"

namespace wearwell::bearing {

ReadingRows::ReadingRows(const TomlReader& root, const BearingData& data, ObservationFamily family)
    : family_(family), contact_(data.common.contact) {
  for (const DataColumn& each : data.columns) {
    column_[each.name] = columns_.size();
    columns_.push_back({each.name, each.unit, each.name == "depth"});
    // A counted axis needs its name beside the unit, even for plain numbers.
    if (each.name == "revolutions" && each.unit.text == "1") columns_.back().unit.text = "rev";
  }
  if (!contact_) labels_.emplace_back("contact");
  if (const auto conditions = root.table("conditions")) {
    static constexpr std::pair<const char*, const char*> inputs[] = {
        {"radius", "m"}, {"clearance", "m"}, {"pressure", "Pa"}, {"force", "N"},
        {"length", "m"}, {"speed", "rev/s"}, {"time", "s"},      {"revolutions", "rev"}};
    for (const auto& [name, si] : inputs) {
      if (const auto constant = positive_quantity(*conditions, name, si))
        constant_[name] = constant->si();
    }
  }
  in_time_ = column_.contains("time");
  const auto along = column_.find(in_time_ ? "time" : "revolutions");
  if (along == column_.end())
    root.required_table("data").required_table("columns").fail(
        "revolutions",
        "is missing, and time too: tracking needs a column for the use of each bearing");
  axis_ = along->second;
}

double ReadingRows::value(const prognosis::Reading& reading, const std::string& name) const {
  if (const auto at = column_.find(name); at != column_.end()) return reading.numbers[at->second];
  const auto at = constant_.find(name);
  return at == constant_.end() ? std::numeric_limits<double>::quiet_NaN() : at->second;
}

std::string ReadingRows::read(const prognosis::Reading& reading, ReadingRow& row) const {
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    const double x = reading.numbers[c];
    const std::string& name = columns_[c].name;
    if (std::isnan(x)) return fmt::format("{} is missing", name);
    if (!std::isfinite(x)) return fmt::format("{} is not finite", name);
    const bool may_be_less = name == "depth" && family_ == ObservationFamily::normal;
    if (!(x > 0) && !may_be_less) return fmt::format("{} must be positive", name);
  }
  std::optional<Contact> contact = contact_;
  if (!contact) contact = contact_named(reading.labels.front());
  if (!contact)
    return fmt::format("'{}' is not a contact: {}", printable(reading.labels.front()),
                       fmt::join(contact_names(), ", "));
  const double radius = value(reading, "radius");
  double pressure = value(reading, "pressure"), revolutions = value(reading, "revolutions");
  if (std::isnan(pressure))
    pressure = value(reading, "force") / (2 * radius * value(reading, "length"));
  row = {};
  if (std::isnan(revolutions)) {
    row.speed = value(reading, "speed");
    revolutions = *row.speed * value(reading, "time");
  }
  row.duty = {*contact, radius, value(reading, "clearance"), pressure, revolutions};
  row.depth = value(reading, "depth");
  row.place = reading.numbers[axis_];
  if (!std::isfinite(pressure * revolutions)) return "its load is not finite";
  if (*contact == Contact::stationary && !(row.depth < 2 * radius))
    return "depth must be less than the journal's diameter";
  if (*contact == Contact::journal && !(row.depth < radius))
    return "depth must be less than the journal's radius";
  return {};
}

}  // namespace wearwell::bearing
