#include "wearwell/study/bound_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/present/html.h"

namespace wearwell {

std::vector<std::string> bound_headings(const std::string& level, BoundSides sides) {
  if (sides == BoundSides::both) return {level + " from", "to"};
  return {(sides == BoundSides::lower ? "at least, " : "at most, ") + level};
}

std::string bound_sentence(const std::vector<QuantitySummary>& quantities, const std::string& level,
                           BoundSides sides) {
  if (sides == BoundSides::both)
    return fmt::format(
        "{0} from, to: the two-sided interval. With {0} confidence (Bayesian: credible) the true "
        "value of the population lies in it.",
        level);
  const bool lower = sides == BoundSides::lower;
  const bool failing =
      std::any_of(quantities.begin(), quantities.end(), [&](const QuantitySummary& each) {
        return each.best().predictive && each.safe_end.value_or(0) > 0.5;
      });
  return fmt::format(
      "{}. With {} confidence (Bayesian: credible) the true value of the population lies {} it.{}",
      lower ? "at least: the lower bound to design with" : "at most: the upper bound", level,
      lower ? "above" : "below",
      lower && failing
          ? " Of shares that fail, design with the upper bound: predict.sides = \"upper\" or "
            "\"both\"."
          : "");
}

std::vector<std::string> bound_columns(double level, BoundSides sides) {
  const std::string percent = html::given(100 * level) + " %";
  if (sides == BoundSides::both) return {percent + " interval, from", percent + " interval, to"};
  return {fmt::format("{}, {} confidence", sides == BoundSides::lower ? "At least" : "At most",
                      percent)};
}

const QuantitySummary* first_bounded(const std::vector<QuantitySummary>& quantities) {
  const auto found = std::find_if(
      quantities.begin(), quantities.end(),
      [](const QuantitySummary& each) { return each.is_bounded() && !each.best().predictive; });
  return found == quantities.end() ? nullptr : &*found;
}

}  // namespace wearwell
