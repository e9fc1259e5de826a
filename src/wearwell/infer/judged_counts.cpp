#include "wearwell/infer/judged_counts.h"

#include <algorithm>
#include <cmath>

#include "wearwell/infer/row_sample.h"

namespace wearwell {
namespace {

// This share of each count, spread evenly over them: the sum is rounded, not each.
std::vector<int> thinned_counts(const std::vector<int>& counts, double share) {
  if (!(share < 1)) return counts;
  std::vector<int> judged;
  double before = 0;
  for (const int each : counts) {
    const double after = before + each;
    judged.push_back(
        static_cast<int>(std::floor(share * after + 0.5) - std::floor(share * before + 0.5)));
    before = after;
  }
  return judged;
}

}  // namespace

std::vector<int> judged_counts(const std::vector<int>& counts, std::size_t rows,
                               std::size_t sampled, double& share) {
  constexpr double most_of_row = 1000, most_of_all = 60'000;
  if (counts.empty()) return std::vector<int>(rows, 1);
  double sum = 0;
  for (const int each : counts) sum += each;
  sum *= std::min(1.0, static_cast<double>(sampled) / static_cast<double>(rows));
  const double largest = *std::max_element(counts.begin(), counts.end());
  share = std::min({1.0, most_of_row / largest, most_of_all / sum});
  return thinned_counts(counts, share);
}

std::vector<std::size_t> judged_items(const std::vector<int>& counts, std::size_t most,
                                      const Rng& lots) {
  std::vector<std::size_t> row, one, several;
  for (std::size_t i = 0; i < counts.size(); ++i) (counts[i] > 1 ? several : one).push_back(i);
  const double share =
      std::min(1.0, static_cast<double>(most) / static_cast<double>(counts.size()));
  const auto chosen =
      static_cast<std::size_t>(std::lround(share * static_cast<double>(one.size())));
  for (const std::size_t i : row_sample(one.size(), chosen, lots))
    row.insert(row.end(), static_cast<std::size_t>(counts[one[i]]), one[i]);
  std::vector<int> blocks;
  for (const std::size_t i : several) blocks.push_back(counts[i]);
  blocks = thinned_counts(blocks, share);
  for (std::size_t i = 0; i < several.size(); ++i)
    row.insert(row.end(), static_cast<std::size_t>(blocks[i]), several[i]);
  std::sort(row.begin(), row.end());
  return row;
}

}  // namespace wearwell
