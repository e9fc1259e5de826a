#include "wearwell/models/fatigue/counting_choice.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell::fatigue {

std::size_t choice_among(const std::string& option, const std::string& word,
                         const std::vector<std::string>& words) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found == words.end())
    throw InputError(fmt::format("{}: '{}' is not one of {}{}", option, word,
                                 fmt::join(words, ", "), did_you_mean(word, words)));
  return static_cast<std::size_t>(found - words.begin());
}

CountingRule CountingChoice::rule(double class_width) const {
  const bool three = choice_among("--method", method, {"four-point", "three-point"}) == 1;
  const bool repeat = choice_among("--residual", residual, {"half", "repeat"}) == 1;
  return {three ? Counting::three_point : Counting::four_point,
          repeat ? Residual::repeat : Residual::half, class_width};
}

}  // namespace wearwell::fatigue
