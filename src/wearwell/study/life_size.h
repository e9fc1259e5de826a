#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "wearwell/input/life_status.h"
#include "wearwell/input/table.h"

namespace wearwell {

/// The columns of a table of lives, by heading; an empty text where there is none.
struct LifeHeadings {
  std::string life = {}, lower = {}, upper = {}, count = {}, entry = {}, mode = {};
  std::optional<LifeStatus> status = {};
  std::vector<std::string> runouts = {};  ///< words of the mode column for a part that runs
};

/// The headings that lines of [data.columns] name: life, or lower and upper; status, count, entry, mode. A status
/// that can be read in two ways is left out: the study is refused for it.
LifeHeadings life_headings(const std::string& lines, const Table& table);

/// Where the default prior of a characteristic, median or mean life is centred, and how wide it is.
struct LifeSize {
  double median = 1;  ///< in the unit of the table, not rounded
  double log_sd = 2;
  double failed = 0, parts = 0;  ///< counts
};

/// The centre is the characteristic life of a Weibull distribution with slope 1.5, the median of the default
/// prior of the slope, if only the time on test t and the number r of failures count: (sum t^1.5/r)^(1/1.5)
/// (Weibayes; Nelson 1985, J. Quality Technology 17, 140), but no less than `least`. No age at failure enters
/// but through that sum. If few parts failed it lies beyond the largest life, by an extrapolation that the slope
/// decides: log_sd = 2 sqrt(1 + b^2), b the logarithm of their ratio, to the nearest half, so that slopes from
/// 0.25 to 9, 99 % of their prior, reach their own estimate within 2.6 standard deviations. An interval is
/// taken at its middle; with failure modes r is that of an average mode; without failures r is 1. `rows`:
/// those that count; all if empty. Cells without a number are passed over.
LifeSize life_size(const Table& table, const LifeHeadings& headings, double least,
                   const std::vector<std::size_t>& rows = {});

/// The same of the life at the largest of all these stresses, by the rows under it if a part failed there, else
/// by all rows.
LifeSize life_size_under(const Table& table, const LifeHeadings& headings, double least,
                         const std::vector<std::string>& stresses);

/// "a factor of 27 to either side": the 90 % interval of the prior; and why it is wider, if it is.
std::string words_of(const LifeSize& size);

}  // namespace wearwell
