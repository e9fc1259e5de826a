#include "wearwell/selection/search_line.h"

#include <fmt/format.h>

#include <cmath>

#include "wearwell/selection/result.h"

namespace wearwell {

SearchLine::~SearchLine() {
  if (!shown_) return;
  std::fputs("\r\033[K", terminal_);
  std::fflush(terminal_);
}

void SearchLine::show(const SearchProgress& progress) {
  shown_ = true;
  std::fputs(fmt::format("\r  {}\033[K", describe(progress, criterion_)).c_str(), terminal_);
  std::fflush(terminal_);
}

std::string describe(const SearchProgress& progress, Criterion criterion) {
  const bool exhaustive = progress.share > 0;
  std::string text = fmt::format(
      "{} {:.6g}, {} {:.6g}; {:.3g} {}, {:.3g} a second", criterion_title(criterion), progress.best,
      criterion == Criterion::adjr2 ? "at most" : "at least", progress.lower_bound, progress.nodes,
      exhaustive ? "models" : "nodes", progress.nodes / progress.seconds);
  if (exhaustive)
    text += fmt::format(", {:.0f} %, {:.0f} s left", 100 * progress.share,
                        std::ceil(progress.seconds * (1 / progress.share - 1)));
  return text;
}

}  // namespace wearwell
