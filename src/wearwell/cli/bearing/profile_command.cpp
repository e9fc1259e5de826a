#include "wearwell/cli/bearing/profile_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <numbers>

#include "wearwell/base/error.h"
#include "wearwell/cli/bearing/bearing_options.h"
#include "wearwell/input/columns.h"
#include "wearwell/input/option_value.h"
#include "wearwell/input/table.h"
#include "wearwell/models/bearing/profile.h"
#include "wearwell/models/bearing/wear_number.h"
#include "wearwell/present/plain.h"

namespace wearwell::bearing {
namespace {

struct ProfileOptions {
  std::string before, after;
  std::string position = "position", height = "height";
  std::string position_unit, height_unit;
  std::string flank;
  BearingInputs bearing;
  bool json = false;
};

/// A column of lengths, in the unit of the option or of the heading.
std::vector<double> read_lengths(const Table& table, const std::string& name, const char* flag,
                                 const std::string& text) {
  std::optional<Unit> given;
  try {
    if (!text.empty()) given = read_unit(text, "m");
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", flag, error.what()));
  }
  const Column& column = table.column(name);
  const Unit unit = column_unit(table, column, "m", given);
  if (unit.text == "1")
    throw InputError(
        fmt::format("{0} is missing, for example {0} um (heading '{1}' of {2} has no unit)", flag,
                    column.name, table.source));
  return si_numbers(table, column.name, unit);
}

Profile read_profile(const char* flag, const std::string& file, const ProfileOptions& options) {
  if (file.empty())
    throw InputError(fmt::format("{} is missing: give a file of two columns", flag));
  const Table table = read_table(file);
  return {read_lengths(table, options.position, "--position-unit", options.position_unit),
          read_lengths(table, options.height, "--height-unit", options.height_unit)};
}

std::optional<double> read_flank(const std::string& text) {
  if (text.empty()) return {};
  return option_value("--flank", text, "m", Allowed::positive);
}

/// A wear rate and the quantities that it follows from.
struct Result {
  WornArea worn;
  std::optional<double> rate, rate_sd,
      rate_half;                ///< m^3/(N m); set when load and revolutions are given
  std::optional<double> depth;  ///< depth of a stationary contact with that area, m
};

/// The inputs other than the area, all exact: k = A/(4 pi r^2 p_a n).
Result evaluate(const ProfileOptions& options) {
  const UncertainBearing given = options.bearing.read();
  if (!given.is_exact()) {
    throw InputError("the interval comes from the profiles; give the bearing without +-");
  }
  const Bearing b = given.mean();
  if (b.depth || b.scar_width || b.rate) {
    throw InputError("--depth, --scar-width and --rate are results here; leave them out");
  }
  if (!b.radius) throw InputError("--radius is missing");
  const bool load = b.pressure || b.force, turns = b.revolutions || b.speed || b.time;
  if (b.pressure && (b.force || b.length)) {
    throw InputError("--pressure and --force or --length are both given; give one or the other");
  }
  if (b.force.has_value() != b.length.has_value()) {
    throw InputError("--force and --length go together: p_a = F/(2 r L)");
  }
  if (b.revolutions && (b.speed || b.time)) {
    throw InputError("--revolutions and --speed or --time are both given; give one or the other");
  }
  if (b.speed.has_value() != b.time.has_value()) throw InputError("--speed and --time go together");
  if (load != turns) {
    throw InputError(
        fmt::format("{} for a wear rate; without load and revolutions only the area follows",
                    load ? "--revolutions (or --speed and --time) is missing"
                         : "--pressure (or --force and --length) is missing"));
  }
  const Profile before = read_profile("--before", options.before, options);
  const Profile after = read_profile("--after", options.after, options);
  const double bore = *b.radius + b.clearance.value_or(0);
  Result result{worn_area(before, after, read_flank(options.flank), 1 / bore), {}, {}, {}, {}};
  const double full = 4 * std::numbers::pi * *b.radius * *b.radius;
  if (load) {
    const double pressure = b.pressure ? *b.pressure : *b.force / (2 * *b.radius * *b.length);
    const double revolutions = b.revolutions ? *b.revolutions : *b.speed * *b.time;
    result.rate = result.worn.area / (full * pressure * revolutions);
    result.rate_sd = result.worn.sd / (full * pressure * revolutions);
    result.rate_half = result.worn.half_width / (full * pressure * revolutions);
  }
  if (b.clearance && result.worn.area > 0) {
    result.depth = *b.radius * depth_for(Contact::stationary, *b.clearance / *b.radius,
                                         result.worn.area / full);
  }
  return result;
}

nlohmann::ordered_json with_interval(double value, double sd, double half, const char* unit) {
  return {
      {"value", value}, {"unit", unit}, {"sd", sd}, {"q05", value - half}, {"q95", value + half}};
}

void print_json(const Result& r) {
  const WornArea& w = r.worn;
  nlohmann::ordered_json json;
  json["quantity"] = "profile";
  json["area"] = with_interval(w.area * 1e6, w.sd * 1e6, w.half_width * 1e6, "mm^2");
  json["rate"] = nullptr;
  if (r.rate) json["rate"] = with_interval(*r.rate, *r.rate_sd, *r.rate_half, "m^3/(N m)");
  json["depth"] = nullptr;
  if (r.depth) json["depth"] = {{"value", *r.depth * 1e3}, {"unit", "mm"}};
  json["alignment"] = {{"shift_um", w.shift * 1e6},
                       {"offset_um", w.offset * 1e6},
                       {"tilt", w.tilt},
                       {"noise_um", w.noise * 1e6},
                       {"correlation", w.correlation}};
  json["worn_place"] = {{"from", w.from * 1e3}, {"to", w.to * 1e3}, {"unit", "mm"}};
  fmt::print("{}\n", json.dump(2));
}

void print_text(const Result& r) {
  const WornArea& w = r.worn;
  const auto interval = [](double value, double half) {
    return plain_range(value - half, value + half);
  };
  fmt::print("Worn area A: {:.6g} mm^2\n{} mm^2 (90 %)\n", w.area * 1e6,
             interval(w.area * 1e6, w.half_width * 1e6));
  if (r.rate) {
    fmt::print("Wear rate k: {} m^3/(N m)\n{} m^3/(N m) (90 %)\n", plain_number(*r.rate, 6),
               interval(*r.rate, *r.rate_half));
  }
  fmt::print("\n");
  print_row("worn region", fmt::format("{:.4g} to {:.4g} mm", w.from * 1e3, w.to * 1e3));
  if (r.depth) {
    print_row("depth of a scar of that area", fmt::format("{:.6g} mm", *r.depth * 1e3));
  }
  print_row("shift along the surface",
            w.shift == 0 ? "none (the flanks have no feature to align by, or need no shift)"
                         : fmt::format("{:.4g} um", w.shift * 1e6));
  print_row("raised by, turned by",
            fmt::format("{:.4g} um, {:.4g} um/mm", w.offset * 1e6, w.tilt * 1e3));
  print_row("noise on the flanks", fmt::format("{:.4g} um, {:.3g} points together count as one",
                                               w.noise * 1e6, w.correlation));
}

void run(const ProfileOptions& options) {
  const Result result = evaluate(options);
  constexpr double loose = 0.25;
  if (result.worn.flank_step > suspicious_step) {
    fmt::print(stderr,
               "warning: the flanks are lower near the worn region than farther out (by {:.2g} "
               "standard deviations): they may be worn too; give a shorter --flank\n",
               result.worn.flank_step);
  }
  if (!(result.worn.sd < loose * result.worn.area)) {
    fmt::print(stderr,
               "warning: the worn area is not distinguishable from the noise; read the rate as an "
               "upper bound\n");
  }
  if (options.json) {
    print_json(result);
  } else {
    print_text(result);
  }
}

}  // namespace

void add_profile_command(CLI::App& bearing) {
  CLI::App* sub = bearing.add_subcommand(
      "profile", "The worn area and wear rate from surface profiles before and after");
  const auto options = std::make_shared<ProfileOptions>();
  sub->add_option("--before", options->before, "File with the profile of the new surface")
      ->type_name("FILE");
  sub->add_option("--after", options->after, "File with the profile of the worn surface")
      ->type_name("FILE");
  sub->add_option("--position", options->position, "Column of positions along the surface")
      ->type_name("COLUMN")
      ->capture_default_str();
  sub->add_option("--height", options->height, "Column of heights, upward out of the material")
      ->type_name("COLUMN")
      ->capture_default_str();
  sub->add_option("--position-unit", options->position_unit,
                  "Unit of the positions, if the heading has none")
      ->type_name("UNIT");
  sub->add_option("--height-unit", options->height_unit,
                  "Unit of the heights, if the heading has none")
      ->type_name("UNIT");
  sub->add_option("--flank", options->flank,
                  "Unworn length at either end (default: a fifth of the profile)")
      ->type_name("'NUMBER m'");
  options->bearing.contact = contact_name(Contact::stationary);
  add_inputs(*sub, options->bearing, {&Bearing::depth, &Bearing::scar_width, &Bearing::rate});
  sub->get_option("--contact")->group("");
  sub->add_flag("--json", options->json, "Print one JSON object");
  sub->footer(
      "The profiles run around the bearing, across the worn region, and begin and end outside it.\n"
      "Their unworn ends align the two profiles; load and revolutions turn the area into a "
      "rate.\n\n"
      "Example:\n"
      "  wearwell bearing profile --before new.csv --after worn.csv --position-unit mm \\\n"
      "    --height-unit um --radius '10 mm' --length '20 mm' --force '800 N' --revolutions 2e5");
  sub->callback([options] { run(*options); });
}

}  // namespace wearwell::bearing
