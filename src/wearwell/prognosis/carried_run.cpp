#include "wearwell/prognosis/carried_run.h"

#include <optional>
#include <utility>

#include "wearwell/prognosis/carry.h"
#include "wearwell/study/posterior_study.h"

namespace wearwell::prognosis {

Result carried_run(const Source& source, const Study& study, const RunOptions& options,
                   const Monitor& monitor) {
  // Before the run: the files may change meanwhile.
  std::optional<Source> carried;
  if (const auto* const of_posterior = dynamic_cast<const PosteriorStudy*>(&study))
    carried = carried_source(source, *of_posterior);
  Result result = study.run(options, monitor);
  if (carried)
    result.files.emplace_back("state.bin",
                              state_bytes(state_of_result(std::move(*carried), result)));
  return result;
}

}  // namespace wearwell::prognosis
