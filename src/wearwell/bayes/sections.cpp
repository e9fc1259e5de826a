#include "wearwell/bayes/sections.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <numeric>

#include "wearwell/math/constants.h"

namespace wearwell {

namespace {

constexpr std::size_t section_length = 256;

}  // namespace

std::vector<std::size_t> in_sections(std::vector<SpreadPoint>& points) {
  constexpr std::size_t oversampled = 8, most_sections = 256;
  const std::size_t n = points.size(),
                    sections = std::min(std::bit_floor(n / section_length + 1), most_sections);
  if (sections < 2) return {n};
  const std::size_t stride = n / (sections * oversampled);
  std::vector<double> sample;
  for (std::size_t i = 0; i < n; i += stride) sample.push_back(points[i].center);
  std::sort(sample.begin(), sample.end());
  std::vector<double> begins = {-infinity};
  for (std::size_t s = 1; s < sections; ++s) begins.push_back(sample[s * sample.size() / sections]);
  std::vector<std::uint8_t> section_of(n);
  std::vector<std::size_t> ends(sections, 0);
  for (std::size_t i = 0; i < n; ++i) {
    // Branchless binary search, because positions are unpredictable.
    std::size_t at = 0;
    for (std::size_t half = sections / 2; half > 0; half /= 2)
      at += begins[at + half] <= points[i].center ? half : 0;
    section_of[i] = static_cast<std::uint8_t>(at);
    ++ends[at];
  }
  std::exclusive_scan(ends.begin(), ends.end(), ends.begin(), std::size_t{0});
  std::vector<SpreadPoint> placed(n);
  for (std::size_t i = 0; i < n; ++i) placed[ends[section_of[i]]++] = points[i];
  points = std::move(placed);
  return ends;
}

std::vector<std::size_t> sorted_sections(std::vector<SpreadPoint>& points) {
  std::sort(points.begin(), points.end(),
            [](const SpreadPoint& a, const SpreadPoint& b) { return a.center < b.center; });
  std::vector<std::size_t> ends;
  for (std::size_t end = section_length; end < points.size(); end += section_length)
    ends.push_back(end);
  ends.push_back(points.size());
  return ends;
}

}  // namespace wearwell
