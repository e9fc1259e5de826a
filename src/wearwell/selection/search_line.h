#pragma once

#include <cstdio>
#include <mutex>

#include "wearwell/regress/subset_search.h"

namespace wearwell {

/// A line on a terminal that says how a subset search stands, rewritten in place and wiped at the
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

/// "1.2 s left, ..." in words: best so far, bound, speed, and the time left where it is known.
std::string describe(const SearchProgress& progress, Criterion criterion);

}  // namespace wearwell
