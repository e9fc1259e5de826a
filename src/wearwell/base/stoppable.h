#pragma once

#include <functional>
#include <stop_token>

namespace wearwell {

/// Does `work` so that `check_stop` (base/stop_scope.h) throws `Cancelled` in it once a stop is
/// requested: on this thread, and on the threads of TBB while they work for this one.
void stoppable(std::stop_token stop, const std::function<void()>& work);

}  // namespace wearwell
