#pragma once

#include <cstdio>
#include <mutex>

#include "wearwell/regress/subset_search.h"

namespace wearwell {

/// A line on a terminal with the progress of a subset search, updated in place and erased at the
/// end.
class SearchLine {
 public:
  SearchLine(std::FILE* terminal, Criterion criterion)
      : terminal_(terminal), criterion_(criterion) {}
  ~SearchLine();
  SearchLine(const SearchLine&) = delete;
  SearchLine& operator=(const SearchLine&) = delete;

  void show(const SearchProgress& progress);

 private:
  std::FILE* terminal_;
  Criterion criterion_;
  bool shown_ = false;
};

/// "1.2 s left, ...": best so far, bound, speed, and the remaining time if known.
std::string describe(const SearchProgress& progress, Criterion criterion);

}  // namespace wearwell
