#include "wearwell/infer/lattice_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace wearwell::lattice {
namespace {

constexpr int directions = 27;     // directions of the outer axes, with opposites and zero
constexpr double shell_depth = 3;  // of log density

// The assessed mass, first and second moments, relative to their sizes.
using Terms = Eigen::Array<double, 2 * d + 1, 1>;

// The error of a lattice sum is the Fourier transform of its terms at the lattice's frequencies.
// Half and quarter lattices give the transform at a half and a quarter of these; its decay between
// them, exp(-c frequency), is extrapolated. Smooth terms decay faster. The terms of one parameter
// are assessed together, because a single one may vanish at a sign change.
ErrorEstimate beyond_lattice(const Terms& quarter, const Terms& half) {
  ErrorEstimate worst;
  for (int i = 1; i <= d; ++i) {
    const double at_quarter = std::max(quarter[0], quarter[i]),
                 at_half = std::max(half[0], half[i]);
    const double decay = at_quarter > at_half ? at_half / at_quarter : 1;
    const double lacks = std::max(at_half, half[i + d]) * decay * decay;
    if (lacks > worst.lacks) worst = {lacks, decay};
  }
  return worst;
}

// The direction of a wave: -1, 0 or 1 along each outer axis.
std::array<int, outer> way_of(int direction) {
  return {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 % 3 - 1};
}

// For one line: its sum, the sum with alternating signs, the sums at a quarter of the frequency,
// and the two outermost shells.
struct LineSums {
  Terms all = Terms::Zero(), half = all, quarter[2] = {all, all}, shell[2] = {all, all};
};

LineSums sum_of(const Lines& lines, const Line& line, const Eigen::Vector4d& middle, bool moments) {
  LineSums sums;
  for (std::size_t j = 0; j < line.values.size(); ++j) {
    const int t = line.first + static_cast<int>(j);
    const double mass = std::exp(line.values[j]) * line.width;
    if (mass == 0) continue;
    Terms here = Terms::Zero();
    here[0] = mass;
    if (moments) {
      const Eigen::Array4d x = (lines.located(line, j).natural - middle).array();
      here.segment<d>(1) = mass * x;
      here.segment<d>(1 + d) = mass * x * x;
    }
    sums.all += here;
    sums.half += (t & 1) != 0 ? Terms(-here) : here;
    sums.quarter[t & 1] += (t & 2) != 0 ? Terms(-here) : here;
    const double over_end = lines.above_end(line.values[j]);
    if (over_end > 0 && over_end < 2 * shell_depth)
      sums.shell[over_end < shell_depth ? 0 : 1] += here;
  }
  return sums;
}

// Terms about the mean, scaled; first moments by the scale of the second.
std::vector<LineSums> line_sums(const Lines& lines, bool moments) {
  const Eigen::Vector4d middle = lines.natural(lines.at(lines.all().front(), 0));
  std::vector<LineSums> sums(lines.all().size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines.all().size(), 64),
                    [&](const auto& part) {
                      for (std::size_t i = part.begin(); i != part.end(); ++i)
                        sums[i] = sum_of(lines, lines.all()[i], middle, moments);
                    });
  Terms all = Terms::Zero();
  for (const LineSums& line : sums) all += line.all;
  const Eigen::Array4d mean = all.segment<d>(1) / all[0];
  const auto about_mean = [&](Terms& terms) {
    terms.segment<d>(1 + d) += mean * (mean * terms[0] - 2 * terms.segment<d>(1));
    terms.segment<d>(1) -= mean * terms[0];
  };
  Terms size = all;
  about_mean(size);
  size.segment<d>(1) = (all[0] * size.segment<d>(1 + d)).sqrt();
  for (int i = 0; i < 2 * d + 1; ++i) {
    if (!(size[i] > 0)) size[i] = INFINITY;
  }
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, sums.size(), 256), [&](const auto& part) {
    for (std::size_t i = part.begin(); i != part.end(); ++i) {
      LineSums& line = sums[i];
      for (Terms* terms : {&line.all, &line.half, &line.quarter[0], &line.quarter[1],
                           &line.shell[0], &line.shell[1]}) {
        about_mean(*terms);
        *terms /= size;
      }
    }
  });
  return sums;
}

}  // namespace

ErrorEstimates error_estimates(const Lines& lines, bool moments) {
  const std::vector<LineSums> sums = line_sums(lines, moments);
  ErrorEstimates found;
  // Each axis and each diagonal once.
  std::array<ErrorEstimate, directions> each;
  tbb::parallel_for(directions / 2 + 1, directions, [&](int direction) {
    const std::array<int, outer> way = way_of(direction);
    Terms real = Terms::Zero(), imaginary = real, half = real;
    for (std::size_t l = 0; l < lines.all().size(); ++l) {
      int phase = 0;
      for (std::size_t a = 0; a < outer; ++a) phase += way[a] * lines.all()[l].index[a];
      const Terms& line = sums[l].all;
      ((phase & 1) != 0 ? imaginary : real) += (phase & 2) != 0 ? Terms(-line) : line;
      half += (phase & 1) != 0 ? Terms(-line) : line;
    }
    each[static_cast<std::size_t>(direction)] =
        beyond_lattice((real.square() + imaginary.square()).sqrt(), half.abs());
  });
  for (int direction = directions / 2 + 1; direction < directions; ++direction) {
    const ErrorEstimate& here = each[static_cast<std::size_t>(direction)];
    found.steps += here.lacks;
    for (std::size_t a = 0; a < outer; ++a) {
      if (way_of(direction)[a] != 0 && here.lacks > found.along[a].lacks) found.along[a] = here;
    }
  }
  Terms quarter[2] = {Terms::Zero(), Terms::Zero()}, half = Terms::Zero(), shell[2] = {half, half};
  for (const LineSums& line : sums) {
    for (const int i : {0, 1}) {
      quarter[i] += line.quarter[i];
      shell[i] += line.shell[i];
    }
    half += line.half;
  }
  found.along[outer] =
      beyond_lattice((quarter[0].square() + quarter[1].square()).sqrt(), half.abs());
  found.steps += found.along[outer].lacks;
  // The mass of the outer shells decreases; the ratio of the last two is extrapolated.
  for (const int i : {0, 5, 6, 7, 8}) {
    if (!(shell[0][i] > 0)) continue;
    const double falls = std::min(shell[0][i] / shell[1][i], 0.98);
    found.beyond = std::max(found.beyond, shell[0][i] * falls / (1 - falls));
  }
  return found;
}

}  // namespace wearwell::lattice
