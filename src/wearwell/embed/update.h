#pragma once

#include <string>
#include <vector>

#include "wearwell/base/monitor.h"
#include "wearwell/embed/fitted.h"
#include "wearwell/prognosis/new_data.h"

namespace wearwell::embed {

/// Fits the study of a fit again with new rows, as `wearwell update`: with its method, chains,
/// draws and seed. `repeated` is "once", "another" or empty. The run can be updated again. Texts of
/// messages name arguments, not options. Throws InputError, Cancelled.
Run update(const Fitted& fitted, const std::vector<prognosis::NewRows>& rows,
           const std::string& repeated, bool report, Monitor monitor);

}  // namespace wearwell::embed
