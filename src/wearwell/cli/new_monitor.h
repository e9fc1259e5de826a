#pragma once

#include "wearwell/cli/new_from.h"

namespace wearwell {

/// The preset of `wearwell new` that is not a study.
inline constexpr const char* monitor_preset = "monitor";

/// `wearwell new monitor DIR --from RESULT`: writes DIR/monitor.toml, a commented configuration for
/// the units of a result, and prints how to check it. Throws InputError: no result whose units can
/// be followed, or a folder that is not new or empty.
void run_new_monitor(const NewOptions& options, Models models);

}  // namespace wearwell
