#include "wearwell/infer/judged_counts.h"

#include <algorithm>
#include <cmath>

namespace wearwell {

std::vector<int> judged_counts(const std::vector<int>& counts, std::size_t rows,
                               std::size_t sampled, double& share) {
  constexpr double most_of_row = 1000, most_of_all = 60'000;
  if (counts.empty()) return std::vector<int>(rows, 1);
  double sum = 0;
  for (const int each : counts) sum += each;
  sum *= std::min(1.0, static_cast<double>(sampled) / static_cast<double>(rows));
  const double largest = *std::max_element(counts.begin(), counts.end());
  share = std::min({1.0, most_of_row / largest, most_of_all / sum});
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

}  // namespace wearwell
