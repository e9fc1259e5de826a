#include "wearwell/study/terminal_histogram.h"

#include <fmt/format.h>

#include <algorithm>

#include "wearwell/present/plain.h"
#include "wearwell/study/terminal_rows.h"

namespace wearwell {
namespace {

// The draws of one parameter between their smallest and largest 0.5 %, in block characters of eight
// heights.
std::string histogram(const Draws& draws, Eigen::Index parameter) {
  static constexpr const char* blocks[] = {"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  constexpr std::size_t bins = 32;
  std::vector<double> values;
  for (const Chain& chain : draws) {
    for (const double value : chain.values.col(parameter)) values.push_back(value);
  }
  std::sort(values.begin(), values.end());
  const std::size_t cut = values.size() / 200;
  const double low = values[cut], high = values[values.size() - 1 - cut];
  std::vector<int> counts(bins, 0);
  for (const double value : values) {
    if (value < low || value > high) continue;
    const double share = high > low ? (value - low) / (high - low) : 0;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(share * bins))];
  }
  const int highest = *std::max_element(counts.begin(), counts.end());
  std::string bars;
  for (const int count : counts) bars += blocks[count * 7 / highest];
  return fmt::format("{:>10} {} {}", plain_number(low), bars, plain_number(high));
}

}  // namespace

std::string histogram_lines(const PosteriorSummary& result) {
  std::size_t width = 0;
  for (const ParameterSummary& p : result.parameters) {
    width = std::max(width, printable_heading(p.name, p.unit).size());
  }
  std::string out;
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    const ParameterSummary& p = result.parameters[i];
    out += fmt::format("  {:<{}}  {}\n", printable_heading(p.name, p.unit), width,
                       histogram(result.posterior_draws, static_cast<Eigen::Index>(i)));
  }
  return out;
}

}  // namespace wearwell
