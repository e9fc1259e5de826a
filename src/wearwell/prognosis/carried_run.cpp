#include "wearwell/prognosis/carried_run.h"

#include <utility>

#include "wearwell/prognosis/carry.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

std::optional<Source> source_to_carry(const Source& source, const Study& study) {
  const auto* const of_posterior = dynamic_cast<const PosteriorStudy*>(&study);
  if (!of_posterior) return {};
  return carried_source(source, *of_posterior);
}

Result carried_run(std::optional<Source> carried, const Study& study, const RunOptions& options,
                   const Monitor& monitor) {
  Result result = study.run(options, monitor);
  if (carried)
    result.files.emplace_back("state.bin",
                              state_bytes(state_of_result(std::move(*carried), result)));
  return result;
}

}  // namespace wearwell::prognosis
