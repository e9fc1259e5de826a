#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace wearwell::in_service {

/// A row that was left out, the first reason for it, and its place on the axis of life, SI.
struct LeftOutRow {
  std::string unit, reason;
  double age = 0;
};

/// Rows left out that are listed.
inline constexpr std::size_t most_left_out_listed = 1000;

/// How many rows of a table were read, and which were left out.
struct RowsRead {
  double rows = 0;
  double left_out = 0;
  std::map<std::string, double> reasons;  ///< of rows left out
  std::vector<LeftOutRow> first_left_out;

  void leave_out(LeftOutRow row) {
    ++left_out;
    ++reasons[row.reason];
    if (first_left_out.size() < most_left_out_listed) first_left_out.push_back(std::move(row));
  }
};

}  // namespace wearwell::in_service
