#include "wearwell/models/fatigue/design_request.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/input/option_value.h"

namespace wearwell::fatigue {
namespace {

void refuse_unless_share(const char* option, const std::optional<double>& share, double most) {
  if (share && !(*share >= 0.01 && *share <= most))
    throw InputError(fmt::format("{}: {} is not a share from 0.01 to {}", option, *share, most));
}

DesignQuestion read_question(const DesignRequest& request,
                             const std::vector<WeightedModel>& models) {
  DesignQuestion question;
  const std::string& si = models.front().result.stress_si;
  for (const std::string& text : request.stresses)
    question.alternating.push_back(option_value("--stress", text, si, Allowed::positive));
  std::sort(question.alternating.rbegin(), question.alternating.rend());
  if (question.alternating.empty()) question.alternating = design_stresses(models);
  if (!request.mean_stress.empty()) {
    question.line.mean = option_value("--mean-stress", request.mean_stress, si);
  } else if (!request.stress_ratio.empty()) {
    question.line.ratio = option_value("--stress-ratio", request.stress_ratio, "1");
    if (!(*question.line.ratio < 1))
      throw InputError(
          fmt::format("--stress-ratio {}: smallest over largest stress; it must be less than 1",
                      request.stress_ratio));
  } else {
    question.line = design_line(models);
  }
  question.levels = design_levels();
  if (request.reliability || request.confidence) {
    const double r = request.reliability.value_or(0.9), c = request.confidence.value_or(0.9);
    question.levels = {{fmt::format("{:.6g}/{:.6g}", 100 * r, 100 * c), r, c}};
  }
  return question;
}

}  // namespace

AveragedDesignReport averaged_design_of(const DesignRequest& request, ModelsToAverage models,
                                        const std::stop_token& stop) {
  refuse_unless_share("--reliability", request.reliability, 0.999999);
  refuse_unless_share("--confidence", request.confidence, 0.9999);
  if (!request.mean_stress.empty() && !request.stress_ratio.empty())
    throw InputError("--mean-stress and --stress-ratio say the same in two ways: give one");
  AveragedDesignReport report;
  report.from = std::move(models);
  report.question = read_question(request, report.from.models);
  report.shown_all = !request.stresses.empty();
  report.points = averaged_design(report.from.models, report.question, stop);
  return report;
}

bool is_trusted(const AveragedDesignReport& report) {
  const std::vector<Check> checks = averaged_design_checks(report);
  return std::none_of(checks.begin(), checks.end(),
                      [](const Check& each) { return each.verdict == Verdict::fail; });
}

}  // namespace wearwell::fatigue
