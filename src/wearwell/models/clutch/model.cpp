#include "wearwell/models/clutch/model.h"

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_describe.h"
#include "wearwell/models/clutch/clutch_keys.h"
#include "wearwell/models/clutch/clutch_result.h"
#include "wearwell/prognosis/carried_state.h"

namespace wearwell {
namespace resource {

std::string_view clutch_study();
std::string_view clutch_design();
std::string_view clutch_truth();

}  // namespace resource

namespace clutch {
namespace {

/// The study and its data, to which `wearwell update` joins rows. There is no posterior to carry
/// on.
std::string state_of(const ClutchStudy& study, bool trusted) {
  return prognosis::state_bytes(
      {"clutch-wear", trusted, {{study.file.filename(), study.file_text}, study.tables}, {}, {}});
}

/// A chain of least squares, exact searches and likelihoods: it has no posterior.
class CampaignStudy : public Study {
 public:
  explicit CampaignStudy(ClutchStudy study) : study_(std::move(study)) {}

  std::string description() const override { return study_description(study_); }

  Result run(const RunOptions& options, const Monitor& monitor) const override {
    if (options.sampler.any())
      throw InputError(
          "--method, --chains, --draws, --warmup and --seed are for studies that sample a "
          "posterior; a clutch study has its seeds in the study file");
    Progress progress(monitor, "exact searches");
    Result result =
        result_of(study_, run_clutch_study(study_, monitor.threads, &progress), options.report);
    if (study_.carried && !study_.simulated)
      result.files.emplace_back("state.bin", state_of(study_, result.header.trusted));
    return result;
  }

 private:
  ClutchStudy study_;
};

}  // namespace

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::clutch_study},
                                            {"design.csv", resource::clutch_design},
                                            {"truth.toml", resource::clutch_truth}};
  return {.key = "clutch-wear",
          .preset = "clutch",
          .example = example,
          .read = [](const TomlReader& root, const Source& source) -> std::unique_ptr<const Study> {
            return std::make_unique<CampaignStudy>(read_clutch_study(root, source));
          },
          .keys = study_keys};
}

}  // namespace clutch
}  // namespace wearwell
