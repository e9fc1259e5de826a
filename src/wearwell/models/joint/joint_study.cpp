#include "wearwell/models/joint/joint_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "wearwell/input/prior.h"
#include "wearwell/models/joint/archard.h"
#include "wearwell/models/joint/joint_data.h"
#include "wearwell/models/joint/joint_predictions.h"

namespace wearwell {
namespace {

using joint::JointData;

std::vector<Parameter> read_parameters(const TomlReader& root, const JointData& data,
                                       const joint::Archard& law) {
  const auto priors = root.table("prior");
  const joint::LeastSquares guess = joint::least_squares(data.inspections);
  const double largest =
      std::abs(*std::max_element(data.inspections.volume.begin(), data.inspections.volume.end(),
                                 [](double a, double b) { return std::abs(a) < std::abs(b); }));
  // Data on an exact line still get a small scatter.
  const double sigma = std::max({guess.sigma, 1e-3 * largest, std::numeric_limits<double>::min()});
  const double k = guess.k > 0 ? guess.k : sigma / law.reference_work;

  // Defaults: Archard's coefficient of metals and polymers lies between 1e-8 and 1e-2 (Archard and
  // Hirst 1956), which for a hardness of about 1 GPa has the same value in mm^3/(N m); the scatter
  // of a measurement does not exceed the measured value.
  const std::string& unit = data.volume_unit.text;
  const double size = rounded_up(largest);
  const auto read = [&](ParameterSpec spec, DefaultPrior fallback) {
    spec.fallback = std::move(fallback);
    return read_prior(root, priors, spec);
  };
  std::vector<Parameter> parameters;
  parameters.push_back(read({"k", "m^3/(N m)", 0, INFINITY, k},
                            {"lognormal", Lognormal{1e-14, 4.2}, unit + "/(N m)"}));
  parameters.push_back(
      read({"sigma", "m^3", 0, INFINITY, sigma}, {"half-normal", HalfNormal{size}, unit}));
  if (law.has_constant) {
    parameters.push_back(
        read({"V0", "m^3", -INFINITY, INFINITY, 0.1 * sigma}, {"normal", Normal{0, size}, unit}));
  }
  if (law.has_exponent) {
    parameters.push_back(
        read({"exponent", "1", 0, INFINITY, 1}, {"lognormal", Lognormal{1, 0.5}, "1"}));
  }
  return parameters;
}

std::string description(const joint::Archard& law, ObservationFamily family,
                        const JointData& data) {
  std::string mean = "k W";
  if (law.has_exponent) mean += " (W/W_ref)^(exponent - 1)";
  if (law.has_constant) mean = "V0 + " + mean;
  return fmt::format(
      "V = {}, W = {}{}; V measured with {} scatter of standard deviation sigma", mean,
      data.work_text,
      law.has_exponent ? fmt::format(", W_ref = {:.6g} N m", law.reference_work) : "",
      family == ObservationFamily::normal ? "normal" : "lognormal");
}

}  // namespace

ObservationFamily joint::read_family(const TomlReader& root) {
  const TomlReader likelihood = root.required_table("likelihood");
  const auto family_name = likelihood.choice("family", {"normal", "lognormal"});
  if (!family_name) likelihood.fail("family", "is missing: \"normal\" or \"lognormal\"");
  return *family_name == "normal" ? ObservationFamily::normal : ObservationFamily::lognormal;
}

joint::Archard joint::read_law(const TomlReader& root, const JointData& data) {
  const auto priors = root.table("prior");
  const auto& work = data.inspections.work;
  Archard law;
  law.reference_work = *std::max_element(work.begin(), work.end());
  law.has_constant = priors && priors->has("V0");
  law.has_exponent = priors && priors->has("exponent");
  return law;
}

void read_joint_study(const TomlReader& root, const Source& source, PosteriorStudy& study) {
  const ObservationFamily family = joint::read_family(root);
  const JointData data = joint::read_joint_data(root, source, family);
  const auto& work = data.inspections.work;
  const joint::Archard law = joint::read_law(root, data);
  study.parameters = read_parameters(root, data, law);
  study.equation = description(law, family, data);
  study.data_rows = data.cycles.size();
  study.pointwise = data.pointwise;
  study.quantity = "worn volume";
  study.observed = data.inspections.volume;
  study.density = density_unit(data.volume_unit, data.inspections.volume.size());
  study.data_columns = data.columns;
  study.data_layout = data.layout;
  study.meanings = {"wear coefficient", "scatter of one measurement"};
  const std::vector<double>& volumes = data.inspections.volume;
  if (*std::max_element(volumes.begin(), volumes.end()) <= 0) {
    study.nothing_seen = {
        "no-wear",
        fmt::format(
            "no wear was observed: none of {} inspections has a worn volume above zero, so the "
            "data only exclude fast wear, and the upper end of every life rests on the prior",
            volumes.size()),
        "State what you know of k from a tribometer or a similar joint, and inspect again."};
  }
  if (law.has_constant) study.meanings.push_back("volume before any work");
  if (law.has_exponent) study.meanings.push_back("exponent of the work");
  study.likelihood = [=, inspections = data.inspections](std::size_t rows) {
    return joint::archard_likelihood(law, family, inspections, rows);
  };

  study.fit_data = FitData{joint::archard_scores(law, family, data.inspections),
                           {},
                           {{"friction work", work}},
                           Rise{"worn volume increases with friction work",
                                work,
                                data.inspections.volume,
                                {},
                                !law.has_constant},
                           "inspection"};
  for (const double volume : data.inspections.volume) {
    study.fit_data->measured.value.push_back(from_si(data.volume_unit, volume));
    study.fit_data->measured.unit.push_back(data.volume_unit.scale);
  }
  study.fit_data->remedies.scatter =
      family == ObservationFamily::normal
          ? "The scatter grows with the worn volume: try family = \"lognormal\"."
          : "Scatter proportional to the worn volume does not fit: try family = \"normal\".";
  study.fit_data->remedies.offset =
      "Try prior.V0, the volume before any work (running-in, an error of the zero point).";
  joint::add_predictions(root, law, family, data, study);
}

}  // namespace wearwell
