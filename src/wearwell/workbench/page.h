#pragma once

#include "wearwell/http/served_page.h"

namespace wearwell::workbench {

/// The page of the workbench. It holds no data: it asks for them with the token in its address.
ServedPage workbench_page();

}  // namespace wearwell::workbench
