#include "wearwell/cli/followed_result.h"

#include <fmt/format.h>

#include "wearwell/base/error.h"
#include "wearwell/base/printable.h"
#include "wearwell/cli/carried.h"
#include "wearwell/prognosis/result_lives.h"

namespace wearwell {

std::unique_ptr<const prognosis::Tracker> tracker_of(const prognosis::CarriedState& state,
                                                     const std::filesystem::path& result,
                                                     Models models) {
  if (auto tracker = prognosis::tracker_where_possible(state, models)) return tracker;
  throw InputError(fmt::format("{}: single units of this study of model \"{}\" cannot be followed",
                               result.string(), printable(state.model)));
}

FollowedResult followed_result(const std::filesystem::path& result, Models models) {
  const prognosis::CarriedState state = read_carried(result);
  return {tracker_of(state, result, models), state.trusted};
}

}  // namespace wearwell
