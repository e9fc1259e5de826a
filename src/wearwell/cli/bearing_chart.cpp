#include "wearwell/cli/bearing_chart.h"

#include <fmt/format.h>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/unit.h"
#include "wearwell/bearing/solve.h"
#include "wearwell/cli/bearing_options.h"

namespace wearwell::bearing {
namespace {

struct ChartOptions {
  BearingOptions point;
  std::string sigma = "2e-4,5e-4,10e-4,20e-4";
  std::string delta = "2e-4:20e-4:181";
};

double read_number(const std::string& text) {
  return read_quantity(text, "1").si();
}

/// "A,B,C", or "FROM:TO:COUNT" for evenly spaced values.
std::vector<double> read_values(const char* flag, const std::string& text) {
  try {
    std::vector<std::string> parts;
    std::vector<double> values;
    if (text.find(':') == text.npos) {
      boost::algorithm::split(parts, text, boost::algorithm::is_any_of(","));
      for (const std::string& part : parts) values.push_back(read_number(part));
      return values;
    }
    boost::algorithm::split(parts, text, boost::algorithm::is_any_of(":"));
    if (parts.size() != 3) throw InputError(fmt::format("'{}' is not FROM:TO:COUNT", text));
    const double from = read_number(parts[0]), to = read_number(parts[1]);
    const double count = read_number(parts[2]);
    if (!(from < to) || !(count >= 2 && count <= 1e6) || count != std::floor(count)) {
      throw InputError(fmt::format(
          "'{}' is not FROM:TO:COUNT with FROM below TO and 2 to 1000000 values", text));
    }
    for (int i = 0; i < count; ++i) values.push_back(std::lerp(from, to, i / (count - 1)));
    return values;
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", flag, error.what()));
  }
}

/// Where the user's bearing lies: by its depth, or by the depth that its rate, load and life make.
std::optional<Solution> user_point(const UncertainBearing& bearing) {
  if (bearing.given.empty()) return std::nullopt;
  const Bearing b = bearing.mean();
  return b.rate ? solve(Quantity::depth, b) : geometry(b);
}

void run(const ChartOptions& options) {
  const std::vector<double> sigmas = read_values("--sigma", options.sigma);
  const std::vector<double> deltas = read_values("--delta", options.delta);
  const UncertainBearing bearing = options.point.read();
  // All rows before the first is printed: a value out of range must leave nothing half-written.
  std::string csv = "sigma,delta,wear_number,kind\n";
  for (const double sigma : sigmas) {
    for (const double delta : deltas) {
      csv +=
          fmt::format("{},{},{},curve\n", sigma, delta, wear_number(bearing.contact, sigma, delta));
    }
  }
  if (const auto point = user_point(bearing))
    csv += fmt::format("{},{},{},point\n", point->sigma, point->delta, point->wear_number);
  fmt::print("{}", csv);
}

}  // namespace

void add_chart_command(CLI::App& bearing) {
  CLI::App* sub = bearing.add_subcommand(
      "chart", "wear number p_a k n against depth for several clearances, as CSV");
  const auto options = std::make_shared<ChartOptions>();
  options->point.contact = contact_name(Contact::stationary);
  options->point.add_to(*sub);
  sub->add_option("--sigma", options->sigma, "clearance/radius: A,B,C or FROM:TO:COUNT")
      ->type_name("LIST")
      ->capture_default_str();
  sub->add_option("--delta", options->delta, "depth/radius: A,B,C or FROM:TO:COUNT")
      ->type_name("LIST")
      ->capture_default_str();
  sub->footer(
      "As it stands it prints Figure 4 of Ligterink and de Gee (1996); for their Figure 5 say\n"
      "  wearwell bearing chart --delta 2e-4:100e-4:491\n"
      "A bearing given by radius, clearance and depth (or rate, pressure and revolutions) becomes "
      "a last\n"
      "row, of the kind 'point'.");
  sub->callback([options] { run(*options); });
}

}  // namespace wearwell::bearing
