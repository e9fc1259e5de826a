#pragma once

#include "wearwell/input/study_keys.h"

namespace wearwell {

/// The keys that every study of a posterior has, for any model.
StudyKeys posterior_keys();

}  // namespace wearwell
