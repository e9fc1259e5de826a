#include "wearwell/cli/followed_result.h"

#include "wearwell/cli/carried.h"
#include "wearwell/prognosis/result_lives.h"

namespace wearwell {

std::unique_ptr<const prognosis::Tracker> tracker_of(const prognosis::CarriedState& state,
                                                     const std::filesystem::path& result,
                                                     Models models) {
  return prognosis::required_tracker(state, models, result.string());
}

FollowedResult followed_result(const std::filesystem::path& result, Models models) {
  const prognosis::CarriedState state = read_carried(result);
  return {tracker_of(state, result, models), state.trusted};
}

}  // namespace wearwell
