#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/study/bearing_study.h"
#include "wearwell/study/fingerprint.h"
#include "wearwell/study/joint_study.h"
#include "wearwell/study/sn_study.h"
#include "wearwell/study/study.h"
#include "wearwell/study/toml_reader.h"

namespace wearwell {
namespace {

std::optional<int> whole(const TomlReader& table, const char* key, int least, int most) {
  const auto value = table.integer(key, least, most);
  return value ? std::optional(static_cast<int>(*value)) : std::nullopt;
}

void read_sampler(const TomlReader& root, Study& study) {
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
      // A width is a difference: of a logarithm a plain number.
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

Study read_study(const std::filesystem::path& file) {
  return read_study(read_text_file(file));
}

Study read_study(const TextFile& text) {
  const std::filesystem::path& file = text.path;
  const TomlReader root = TomlReader::parse(text);
  Study study;
  study.file = file;
  study.file_text = text.text;
  study.title = root.text("title").value_or(valid_utf8(file.stem().string()));
  const auto model = root.choice("model", {"archard-joint", "bearing-wear", "sn"});
  if (!model) root.fail("model", "is missing: \"archard-joint\", \"bearing-wear\" or \"sn\"");
  study.model = *model;
  const TomlReader data = root.required_table("data");
  study.data_file = data.required_text("file");
  if (const auto update = root.table("update")) {
    study.stages = update->choice("stages", {"row"}).has_value();
  }
  const ReadFile data_read(file.parent_path() / study.data_file);
  if (*model == "archard-joint") {
    read_joint_study(root, file.parent_path(), study);
  } else if (*model == "sn") {
    read_sn_study(root, file.parent_path(), study);
  } else {
    read_bearing_study(root, file.parent_path(), study);
  }
  study.data_sha1 = data_read.sha1();
  read_sampler(root, study);
  root.finish();
  return study;
}

}  // namespace wearwell
