#include "wearwell/models/bearing/bearing_scaffold.h"

#include <fmt/format.h>

#include "wearwell/study/column_values.h"
#include "wearwell/study/heading_words.h"

namespace wearwell::bearing {
namespace {

bool speaks_of_bearings(const ColumnRoles& roles) {
  if (roles.has({"clearance"}) || roles.has({"contact"})) return true;
  for (const Column& column : roles.table().columns) {
    for (const char* word : {"bearing", "journal", "lager", "palier", "cojinete"}) {
      if (is_called(column.name, word)) return true;
    }
  }
  return false;
}

}  // namespace

std::optional<Scaffold> scaffold(ColumnRoles& roles) {
  const bool counted = roles.has({"revolutions"}), of_bearings = speaks_of_bearings(roles);
  const bool timed = roles.has({"time"}) && roles.has({"speed"});
  const bool cycled = of_bearings && (roles.has({"cycles"}) || roles.has({"time"}));
  if (!roles.has({"depth"}) || !(counted || timed || cycled)) return {};
  const auto depth = roles.take("depth", {"depth"});
  std::string columns, conditions;
  const auto column = [&](const char* name, std::initializer_list<std::string_view> of) {
    const auto found = roles.take(name, of);
    if (found) columns += ColumnRoles::line(name, *found);
    return found;
  };
  const auto or_state = [&](bool found, const char* name, const char* like, const char* what) {
    if (!found) conditions += roles.unstated_line(name, what, like);
  };
  const auto revolutions = column("revolutions", {"revolutions", "cycles"});
  if (!revolutions) {
    column("time", {"time"});
    const auto speed = column("speed", {"speed"});
    or_state(speed.has_value(), "speed", "60 rpm", "speed of the journal");
  }
  const auto pressure = column("pressure", {"pressure"});
  if (!pressure) {
    const auto force = column("force", {"force"});
    if (force) {
      const auto length = column("length", {"length"});
      or_state(length.has_value(), "length", "20 mm", "length of the bearing");
    } else {
      or_state(false, "pressure", "1 MPa", "pressure, force over projected area");
    }
  }
  const auto clearance = column("clearance", {"clearance"});
  const auto radius = column("radius", {"radius"});
  or_state(radius.has_value(), "radius", "10 mm", "radius of the journal");
  or_state(clearance.has_value(), "clearance", "30 um", "radial clearance");
  const auto contact = column("contact", {"contact"});
  or_state(contact.has_value(), "contact", "stationary",
           "the part that the load rotates with: stationary (a scar in the bushing), journal or "
           "bushing");
  const auto bearing = column("bearing", {"unit"});
  columns += ColumnRoles::line("depth", *depth);
  roles.refuse_status();
  const bool scatter = bearing && repeats(roles.table(), *bearing->column);

  const ReadingFit fit = counted || of_bearings ? ReadingFit::specific : ReadingFit::general;
  return roles.study(
      "wear of a journal bearing", fit,
      fmt::format(
          "title = {}\n"
          "model = \"bearing-wear\"\n\n"
          "{}[data.columns]\n"
          "{}\n"
          "[conditions]                             # the same for all rows\n"
          "{}\n"
          "[likelihood]\n"
          "family = \"normal\"\n"
          "# depth_error = \"2 um\"                   # sd of the gauge, if you know it\n\n"
          "# Without priors of k and sigma, weak defaults apply (docs/reference/priors.md).\n"
          "{}\n"
          "# [predict]                              # a bearing like these, with\n"
          "# pressure = \"1.5 MPa\"\n"
          "# limit = \"80 um\"                        # failure threshold: adds its life\n"
          "# risk = \"1 %\"                           # adds the time of inspection\n",
          toml_text("Wear rate of bearings, from " + roles.file()), roles.data_section(), columns,
          conditions,
          scatter ? "[prior]\n"
                    "k_scatter = { distribution = \"default\" }         # unit-to-unit variation; "
                    "remove if "
                    "all bearings have one wear rate\n"
                  : ""));
}

}  // namespace wearwell::bearing
