#pragma once

#include "wearwell/http/served_page.h"

namespace wearwell::monitor {

/// The fleet and its units. `token`: whether the viewer has signed in, and may sign out.
ServedPage fleet_page(bool token);

/// Asks for the token, and reports a wrong one.
ServedPage login_page(bool wrong);

}  // namespace wearwell::monitor
