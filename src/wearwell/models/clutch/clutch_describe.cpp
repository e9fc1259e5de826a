#include "wearwell/models/clutch/clutch_describe.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "wearwell/base/printable.h"
#include "wearwell/models/clutch/clutch_tables.h"
#include "wearwell/study/data_in_words.h"

namespace wearwell::clutch {
namespace {

std::string point_text(const OperatingPoint& at) {
  return fmt::format("{:.6g} rpm, {:.6g} N m, {:.6g} degC, {:.6g} s", at.slip_speed / rpm,
                     at.torque, at.temperature, at.closing_time);
}

std::string data_text(const ClutchStudy& study, const ClutchResult& prepared) {
  const Campaign& campaign = study.campaign;
  int points[3] = {};
  for (const DesignPoint& point : campaign.design) ++points[static_cast<int>(point.role)];
  std::set<int> plates;
  for (const Cycle& cycle : campaign.cycles) plates.insert(cycle.plate);
  std::string out = study.simulated ? "\n"
                                      "Data, simulated from a known truth, not measured\n"
                                    : "\nData\n";
  std::vector<std::string> files;
  for (const auto& file : study.files) files.push_back(file.filename().string());
  if (study.layouts.empty()) out += fmt::format("  {}\n", fmt::join(files, ", "));
  for (std::size_t i = 0; i < study.layouts.size(); ++i)
    out += fmt::format("  {}: {}\n", files[i], study.layouts[i].text);
  out += columns_text(study.data_columns.empty() ? cycle_columns(campaign) : study.data_columns);
  out += fmt::format("  {} points of the factorial, {} beyond it, {} held out\n", points[0],
                     points[1], points[2]);
  out += fmt::format("  {} cycles of {} plates, {} weighings, {} samples of raw traces\n",
                     campaign.cycles.size(), plates.size(), campaign.weighings.size(),
                     study.traces.size());
  out += fmt::format(
      "  lining of {:.6g} kg/m^3, worn-out volume {:.6g} mm^3; balance with standard deviation "
      "{:.6g} mg\n",
      campaign.density, study.worn_out / mm3, campaign.balance_sd * 1e6);
  for (const std::string& each : campaign.filled) out += fmt::format("  {}\n", each);
  for (const std::string& flag : prepared.blocks.flags) out += fmt::format("  {}\n", flag);
  return out;
}

}  // namespace

std::string study_description(const ClutchStudy& study) {
  std::set<int> run_in_plates;
  std::set<std::string> sequences;
  for (const Weighing& weighing : study.campaign.weighings) {
    if (weighing.block == Block::run_in) run_in_plates.insert(weighing.plate);
    if (weighing.block == Block::sequence) sequences.insert(weighing.sequence);
  }
  std::string out = fmt::format(
      "{}\n"
      "  volume of one cycle = g(Ec) w E, with g(Ec) = 1 + w1/w0 exp(-Ec/eps1) + w2/w0 "
      "exp(-Ec/eps2)\n"
      "  w = a cubic in ds = omega0^r t2^q, Td and Mz, or any submodel of it\n",
      study.title);
  out += data_text(study, prepare_campaign(study));
  out += "\nUnknowns\n";
  out += fmt::format(
      "  w0, w1, w2 [mm^3/MJ], eps1, eps2 [MJ]  run-in of {} plates together, with a factor for "
      "each\n",
      run_in_plates.size());
  const auto& e = study.exponents;
  out += fmt::format(
      "  terms of w [mm^3/MJ], r, q               the best of 1048575 submodels by leave-one-out "
      "at each of {} pairs of r and q in {:g}..{:g}\n",
      e.size() * e.size(), e.front(), e.back());
  std::vector<std::string> laws;
  for (const ScatterKind kind : scatter_kinds) laws.push_back(formula_of(kind));
  out += fmt::format(
      "  sigma_w [mm^3/MJ]                        scatter of one cycle, selected by AIC from: {}\n",
      fmt::join(laws, "; "));
  out +=
      "\n"
      "Predictions\n";
  if (!sequences.empty())
    out += fmt::format("  worn volume [mm^3] along the sequences {}\n", fmt::join(sequences, ", "));
  std::vector<double> levels;
  for (const double level : study.levels) levels.push_back(100 * level);
  for (const auto& [name, at] : study.life_points)
    out += fmt::format("  cycles to {:g} % worn, {}: {}\n", fmt::join(levels, ", "), name,
                       point_text(at));
  out += fmt::format(
      "  with 95 % intervals from the scatter of cycles only, and including {} simulated "
      "repetitions of the fit (seed {})\n",
      study.replicates, study.seed);
  return printable_lines(out);
}

}  // namespace wearwell::clutch
