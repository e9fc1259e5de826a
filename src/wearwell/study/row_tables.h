#pragma once

#include "wearwell/present/table.h"
#include "wearwell/study/posterior_summary.h"

namespace wearwell {

/// The tables of a report with a row for each row of the data.

present::Table coverage_table(const CoverageTable& coverage);
present::Table pointwise_table(const PointwiseTable& pointwise);
present::Table loo_table(const LooSummary& summary);

}  // namespace wearwell
