#include "wearwell/models/bearing/bearing_first.h"

#include <fmt/format.h>

#include <set>

#include "wearwell/input/columns.h"

namespace wearwell::bearing {
namespace {

bool repeats(const Column& column) {
  std::set<std::string> seen;
  const std::size_t rows = column.is_number ? column.numbers.size() : column.text.size();
  for (std::size_t i = 0; i < rows; ++i) seen.insert(cell_word(column, i));
  return seen.size() > 1 && seen.size() < rows;
}

}  // namespace

std::optional<FirstStudy> first_study(const Table& table, const std::string& file) {
  HeadingGuesses headings(table);
  const auto depth =
      headings.take("depth", "m", "um",
                    {"wear depth", "depth", "linear wear", "wear", "verschleisstiefe",
                     "verschleißtiefe", "verschleiss", "verschleiß", "usure"});
  if (!depth) return {};
  std::string columns, conditions;
  const auto column = [&](const char* name, const char* si, const char* usual,
                          const std::vector<std::string_view>& names, bool numbers = true) {
    const auto found = headings.take(name, si, usual, names, numbers);
    if (found) columns += HeadingGuesses::line(name, *found);
    return found;
  };
  const auto or_state = [&](bool found, const char* name, const char* like, const char* what) {
    if (!found) conditions += headings.unstated_line(name, what, like);
  };
  const auto revolutions = column("revolutions", "rev", "1",
                                  {"revolutions", "turns", "umdrehungen", "rev", "cycles", "giri"});
  std::optional<HeadingGuesses::Found> time, speed;
  if (!revolutions) {
    time = column("time", "s", "h",
                  {"time", "duration", "hours", "zeit", "laufzeit", "stunden", "temps"});
    if (!time) return {};
    speed = column("speed", "rev/s", "rpm", {"speed", "drehzahl", "rpm", "vitesse"});
    or_state(speed.has_value(), "speed", "60 rpm", "speed of the journal");
  }
  const auto pressure =
      column("pressure", "Pa", "MPa", {"pressure", "flächenpressung", "pressung", "pression"});
  if (!pressure) {
    const auto force =
        column("force", "N", "N", {"radial force", "force", "load", "kraft", "last", "charge"});
    if (force) {
      const auto length =
          column("length", "m", "mm", {"bearing length", "length", "width", "länge", "breite"});
      or_state(length.has_value(), "length", "20 mm", "length of the bearing");
    } else {
      or_state(false, "pressure", "1 MPa", "pressure, force over projected area");
    }
  }
  const auto clearance =
      column("clearance", "m", "um", {"radial clearance", "clearance", "spiel", "lagerspiel"});
  const auto radius =
      column("radius", "m", "mm", {"journal radius", "radius", "shaft radius", "wellenradius"});
  or_state(radius.has_value(), "radius", "10 mm", "radius of the journal");
  or_state(clearance.has_value(), "clearance", "30 um", "radial clearance");
  const auto contact = column("contact", "1", "1", {"contact", "kontakt"}, false);
  or_state(contact.has_value(), "contact", "stationary",
           "what the load turns with: stationary (a scar in the bushing), journal or bushing");
  const auto bearing = column("bearing", "1", "1",
                              {"bearing", "bearing id", "lager", "specimen", "probe", "id"}, false);
  columns += HeadingGuesses::line("depth", *depth);
  const bool scatter = bearing && repeats(*bearing->column);

  return headings.study(fmt::format(
      "title = {}\n"
      "model = \"bearing-wear\"\n\n"
      "[data]\nfile = {}\n[data.columns]\n{}\n"
      "[conditions]                             # what is the same for all rows\n{}\n"
      "[likelihood]\nfamily = \"normal\"\n# depth_error = \"2 um\"                   # of the "
      "gauge, if you know it\n\n"
      "# Weak defaults (docs/priors.md) stand in for what you do not say of k and sigma.\n{}\n"
      "# [predict]                              # of a bearing like these, with\n"
      "# pressure = \"1.5 MPa\"\n# limit = \"80 um\"                        # when is it worn so "
      "deep?\n"
      "# risk = \"1 %\"                           # and when to inspect it?\n",
      toml_text("Wear rate of bearings, from " + file), toml_text(file), columns, conditions,
      scatter ? "[prior]\nk_scatter = { law = \"default\" }         # bearings differ; leave it "
                "out if all have one wear rate\n"
              : ""));
}

}  // namespace wearwell::bearing
