#include "wearwell/study/posterior_study.h"

#include <limits>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/input/as_read.h"
#include "wearwell/input/fingerprint.h"
#include "wearwell/study/describe.h"
#include "wearwell/study/posterior_result.h"
#include "wearwell/study/run_study.h"

namespace wearwell {
namespace {

std::optional<int> whole(const TomlReader& table, const char* key, int least, int most) {
  const auto value = table.integer(key, least, most);
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

void read_sampler(const TomlReader& root, PosteriorStudy& study) {
  const auto sampler = root.table("sampler");
  if (!sampler) return;
  if (const auto method = sampler->choice("method", {"exact", "nuts", "metropolis"})) {
    study.sampler.method = *method == "exact"  ? Method::exact
                           : *method == "nuts" ? Method::nuts
                                               : Method::metropolis;
  }
  study.sampler.chains = whole(*sampler, "chains", 1, max_chains);
  study.sampler.warmup = whole(*sampler, "warmup", 0, max_iterations);
  study.sampler.draws = whole(*sampler, "draws", min_draws, max_iterations);
  if (const auto seed = sampler->integer("seed", 0, std::numeric_limits<long long>::max())) {
    study.sampler.seed = static_cast<std::uint64_t>(*seed);
  }
  study.nuts.max_treedepth =
      whole(*sampler, "max_treedepth", 1, 20).value_or(study.nuts.max_treedepth);
  if (const auto metric = sampler->choice("metric", {"diagonal", "dense"})) {
    study.nuts.dense_metric = *metric == "dense";
  }
  if (const auto target = sampler->quantity("target_accept", "1")) {
    if (!(target->si() > 0 && target->si() < 1)) {
      sampler->fail("target_accept", "must lie between 0 and 1");
    }
    study.nuts.target_accept = target->si();
  }
  if (const auto half_width = sampler->table("half_width")) {
    Eigen::VectorXd widths(static_cast<Eigen::Index>(study.parameters.size()));
    for (std::size_t i = 0; i < study.parameters.size(); ++i) {
      const Parameter& parameter = study.parameters[i];
      // A width is a difference; the difference of logarithms is a plain number.
      const bool logarithm = is_logarithm(parameter.si);
      const Quantity width =
          half_width->required_quantity(parameter.name, logarithm ? "1" : parameter.si);
      if (!(width.si() > 0)) half_width->fail(parameter.name, "must be positive");
      try {
        if (!logarithm) refuse_two_readings(width, parameter.unit);
      } catch (const InputError& error) {
        half_width->fail(parameter.name, error.what());
      }
      widths[static_cast<Eigen::Index>(i)] = width.si();
    }
    study.metropolis.half_width = widths;
  }
}

}  // namespace

std::string PosteriorStudy::description() const {
  require_posterior(*this);
  return study_description(*this);
}

Result PosteriorStudy::run(const RunOptions& options, const Monitor& monitor) const {
  return posterior_result(run_study(*this, options.sampler, monitor, options.report));
}

std::unique_ptr<const Study> read_posterior_study(const TomlReader& root, const Source& source,
                                                  ReadPreset read_preset) {
  auto study = std::make_unique<PosteriorStudy>();
  study->file = source.study;
  study->title = root.text("title").value_or(valid_utf8(source.study.path.stem().string()));
  study->model = root.required_text("model");
  const TomlReader data = root.required_table("data");
  study->data_file = data.required_text("file");
  if (const auto update = root.table("update"))
    study->stages = update->choice("stages", {"row"}).has_value();
  const ReadFile data_read(source.folder() / study->data_file);
  read_preset(root, source, *study);
  if (!table_in_memory(data, source)) study->data_sha1 = data_read.sha1();
  read_sampler(root, *study);
  return study;
}

}  // namespace wearwell
