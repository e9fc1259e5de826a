#include "wearwell/models/clutch/clutch_result.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "wearwell/base/printable.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_report.h"
#include "wearwell/models/clutch/clutch_summary.h"
#include "wearwell/study/json.h"

namespace wearwell::clutch {
namespace {

std::string fingerprint_of(const Campaign& campaign) {
  std::vector<double> masses;
  for (const Weighing& weighing : campaign.weighings) masses.push_back(weighing.mass);
  return fingerprint("mass of plates", masses);
}

double log_normal_density(double x, double sd) {
  return -0.5 * std::log(2 * std::numbers::pi) - std::log(sd) - 0.5 * x * x / (sd * sd);
}

/// Each point predicted from all others, with the terms and the scatter from all points.
LooSummary leave_one_out(const ClutchResult& found) {
  const LinearFit& fit = found.maps.front().fit;
  const Eigen::VectorXd sd = point_sd(found.scatter_fit().law, found.points, fit.fitted);
  LooSummary summary{"point", {}, "mm^3/MJ"};
  for (Eigen::Index j = 0; j < sd.size(); ++j) {
    const double h = fit.leverages[j];
    summary.loo.terms.push_back(
        {.elpd = log_normal_density(fit.loo_residuals[j], sd[j] / std::sqrt(1 - h)),
         .lpd = log_normal_density(fit.residuals[j], sd[j] * std::sqrt(1 + h))});
  }
  return summary;
}

/// The constants of run-in: estimate and standard error, and their joint normal distribution.
std::vector<ParameterSummary> parameters_of(const RunInFit& fit) {
  constexpr double q95 = 1.6448536269514722;
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  std::vector<ParameterSummary> parameters;
  for (int i = 0; i < RunInFit::size; ++i) {
    const auto& [name, unit, si] = run_in_constants[static_cast<std::size_t>(i)];
    const double value = fit.parameters[i] / si, error = std::sqrt(fit.covariance(i, i)) / si;
    parameters.push_back({.name = name,
                          .unit = unit,
                          .mean = value,
                          .sd = error,
                          .mcse = none,
                          .q05 = value - q95 * error,
                          .q50 = value,
                          .q95 = value + q95 * error,
                          .ess_bulk = none,
                          .ess_tail = none,
                          .rhat = none,
                          .exact = {},
                          .drawn = false});
  }
  return parameters;
}

}  // namespace

Result result_of(const ClutchStudy& study, const ClutchResult& found, bool report) {
  Result result;
  Header& header = result.header;
  header.version = found.version;
  header.title = study.title;
  header.model = "clutch-wear";
  header.equation =
      "volume of one cycle = g(Ec) w E, with g(Ec) = 1 + w1/w0 exp(-Ec/eps1) + w2/w0 "
      "exp(-Ec/eps2); w = a cubic in ds = omega0^r t2^q, Td and Mz, or any submodel of it";
  for (const auto& file : study.files) header.data.files.push_back(file.filename().string());
  header.data.rows = study.campaign.weighings.size();
  header.data.fingerprint = fingerprint_of(study.campaign);
  for (std::size_t i = 0; i < study.layouts.size(); ++i) {
    for (const std::string& remark : study.layouts[i].remarks)
      header.data.remarks.push_back(fmt::format("{}: {}", header.data.files[i], remark));
  }
  header.seed = study.seed;
  header.trusted = found.trusted;
  header.checks = found.checks;
  result.body = summary_body(study, found);
  result.body["parameters"] = to_json(parameters_of(found.run_in));
  result.body["loo"] = to_json(leave_one_out(found));
  result.files.emplace_back("model.json", printable_json(to_json(found.model).dump(1)) + "\n");
  result.files.emplace_back("predictions.csv", sequences_csv(found));
  if (report) result.sections = report_sections(study, found);
  result.text = [text = summary_text(study, found)](const TerminalStyle&) { return text; };
  return result;
}

}  // namespace wearwell::clutch
