#include "wearwell/cli/bearing/chart_command.h"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <boost/algorithm/string/classification.hpp>
#include <boost/algorithm/string/split.hpp>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/staged_file.h"
#include "wearwell/base/unit.h"
#include "wearwell/cli/bearing/bearing_options.h"
#include "wearwell/models/bearing/solve.h"
#include "wearwell/present/html.h"
#include "wearwell/present/page.h"
#include "wearwell/present/plot.h"

namespace wearwell::bearing {
namespace {

struct ChartOptions {
  BearingInputs point;
  std::string sigma = "2e-4,5e-4,10e-4,20e-4";
  std::string delta = "2e-4:20e-4:181";
  std::filesystem::path file;
};

/// One curve per sigma.
struct Chart {
  Contact contact;
  std::vector<double> sigma, delta;
  std::vector<std::vector<double>> wear_number;  ///< [sigma][delta]
  std::optional<Solution> point;
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

/// The position of the user's bearing: by its depth, or by the depth that follows from its rate,
/// load and life.
std::optional<Solution> user_point(const UncertainBearing& bearing) {
  if (bearing.given.empty()) return std::nullopt;
  const Bearing b = bearing.mean();
  return b.rate ? solve(Quantity::depth, b) : geometry(b);
}

Chart compute(const ChartOptions& options) {
  const UncertainBearing bearing = options.point.read();
  Chart chart{bearing.contact,
              read_values("--sigma", options.sigma),
              read_values("--delta", options.delta),
              {},
              user_point(bearing)};
  for (const double sigma : chart.sigma) {
    auto& curve = chart.wear_number.emplace_back();
    for (const double delta : chart.delta) {
      curve.push_back(wear_number(chart.contact, sigma, delta));
    }
  }
  return chart;
}

std::string csv(const Chart& chart) {
  std::string out = "sigma,delta,wear_number,kind\n";
  for (std::size_t s = 0; s < chart.sigma.size(); ++s) {
    for (std::size_t d = 0; d < chart.delta.size(); ++d) {
      out +=
          fmt::format("{},{},{},curve\n", chart.sigma[s], chart.delta[d], chart.wear_number[s][d]);
    }
  }
  if (chart.point) {
    out += fmt::format("{},{},{},point\n", chart.point->sigma, chart.point->delta,
                       chart.point->wear_number);
  }
  return out;
}

std::string page(const Chart& chart) {
  std::vector<plot::Json> marks;
  for (std::size_t s = 0; s < chart.sigma.size(); ++s) {
    // Half the circle of hues, from blue to orange.
    const double share = chart.sigma.size() > 1
                             ? static_cast<double>(s) / static_cast<double>(chart.sigma.size() - 1)
                             : 0;
    marks.push_back(plot::line({{"x", chart.delta},
                                {"y", chart.wear_number[s]},
                                {"delta", chart.delta},
                                {"wear number", chart.wear_number[s]}},
                               {fmt::format("hsl({:.0f}, 60%, 48%)", std::lerp(215, 30, share)),
                                fmt::format("sigma = {}", html::number(chart.sigma[s], 3))}));
  }
  std::string caption =
      "p_a k n, the product of apparent pressure, specific wear rate and revolutions, against "
      "delta "
      "= depth/radius, for each sigma = clearance/radius.";
  if (chart.point) {
    const Solution& p = *chart.point;
    marks.push_back(plot::points({{"x", {p.delta}},
                                  {"y", {p.wear_number}},
                                  {"delta", {p.delta}},
                                  {"wear number", {p.wear_number}}},
                                 {plot::colour::limit, "this bearing", 1, 0, false, 90}));
    caption +=
        fmt::format(" This bearing: sigma {}, delta {}, wear number {}.", html::number(p.sigma),
                    html::number(p.delta), html::number(p.wear_number));
  }
  const std::string title =
      fmt::format("Wear number against depth, contact: {}", contact_name(chart.contact));
  present::Section section{"chart-section", "Chart"};
  section.add(present::Figures{
      {{"chart", title, caption,
        plot::plot(title, {"delta = depth/radius"}, {"p_a k n"}, marks, 480, true)}}});
  return html_page({WEARWELL_VERSION,
                    title,
                    "Ligterink and de Gee, Tribotest 3-1 (1996), Figures 4 and 5",
                    {section}});
}

void run(const ChartOptions& options) {
  const std::string kind = options.file.extension().string();
  if (!options.file.empty() && kind != ".html" && kind != ".csv") {
    throw InputError(fmt::format("--output: {} must end in .html or .csv", options.file.string()));
  }
  const Chart chart = compute(options);
  if (options.file.empty()) {
    fmt::print("{}", csv(chart));
  } else {
    write_file(options.file, kind == ".html" ? page(chart) : csv(chart));
  }
}

}  // namespace

void add_chart_command(CLI::App& bearing) {
  CLI::App* sub = bearing.add_subcommand(
      "chart", "Wear number p_a k n against depth for several clearances, as CSV or HTML");
  const auto options = std::make_shared<ChartOptions>();
  options->point.contact = contact_name(Contact::stationary);
  add_inputs(*sub, options->point);
  sub->add_option("--sigma", options->sigma, "clearance/radius: A,B,C or FROM:TO:COUNT")
      ->type_name("LIST")
      ->capture_default_str();
  sub->add_option("--delta", options->delta, "depth/radius: A,B,C or FROM:TO:COUNT")
      ->type_name("LIST")
      ->capture_default_str();
  sub->add_option("-o,--output", options->file,
                  "Write FILE.html or FILE.csv instead of the terminal")
      ->type_name("FILE");
  sub->footer(
      "By default it prints Figure 4 of Ligterink and de Gee (1996). For their Figure 5 run\n"
      "  wearwell bearing chart --delta 2e-4:100e-4:491\n"
      "and for a picture add -o chart.html.\n"
      "A bearing given by radius, clearance and depth (or rate, pressure and revolutions) becomes "
      "the last\n"
      "row, of kind 'point'.");
  sub->callback([options] { run(*options); });
}

}  // namespace wearwell::bearing
