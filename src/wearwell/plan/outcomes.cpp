#include "wearwell/plan/outcomes.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/stop_scope.h"
#include "wearwell/math/constants.h"
#include "wearwell/math/quadrature.h"
#include "wearwell/plan/count_outcomes.h"
#include "wearwell/plan/outcome_ranges.h"
#include "wearwell/plan/row_densities.h"
#include "wearwell/present/plain.h"

namespace wearwell::plan {
namespace {

using Eigen::Index;

constexpr int panel_nodes = 6;
constexpr double panel_widths = 2.4;  // in standard deviations of the narrowest distribution
constexpr int most_panels = 200;

struct Quadrature {
  std::vector<double> t, log_weight, begin, end;
};

// Composite Gauss-Legendre from low to high.
Quadrature composite(double low, double high, double narrowest) {
  static const GaussLegendre rule = gauss_legendre(panel_nodes);
  const int panels = std::clamp(
      static_cast<int>(std::ceil((high - low) / (panel_widths * narrowest))), 2, most_panels);
  const double half = 0.5 * (high - low) / panels;
  Quadrature all;
  for (int p = 0; p < panels; ++p) {
    const double middle = low + (2 * p + 1) * half;
    for (std::size_t i = 0; i < panel_nodes; ++i) {
      all.t.push_back(middle + half * rule.node[i]);
      all.log_weight.push_back(std::log(half * rule.weight[i]));
      all.begin.push_back(middle + half * rule.cell_edge[i]);
      all.end.push_back(middle + half * rule.cell_edge[i + 1]);
    }
  }
  return all;
}

// The rows of one test's quadrature, and of its run-out.
struct Grid {
  Quadrature quadrature;
  bool runout = false;
  std::size_t first = 0;  // row
  std::size_t size() const { return quadrature.t.size() + (runout ? 1 : 0); }
};

class Chunk {
 public:
  Chunk(const TestStudy& study, const Table& conditions, std::span<const PlannedTest> tests,
        const Points& nodes, std::span<const double> weights)
      : study_(study), conditions_(conditions), tests_(tests), nodes_(nodes), weights_(weights) {}

  void find_ranges() {
    const Scouts scouts = scouts_of(nodes_, weights_);
    ranges_ = outcome_ranges(study_, conditions_, tests_, scouts.nodes, scouts.weights);
    for (std::size_t i = 0; i < tests_.size(); ++i)
      refuse_impossible(conditions_, tests_[i].row, ranges_[i].impossible);
  }

  std::vector<Outcomes> outcomes() const {
    std::vector<Grid> grids;
    std::vector<std::size_t> rows;
    std::vector<TestOutcome> cells;
    const OutcomeScale scale{study_.positive};
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      grids.push_back(grid_of(i, scale));
      grids.back().first = rows.size();
      for (const double t : grids.back().quadrature.t) cells.push_back({scale.value(t), false});
      if (grids.back().runout) cells.push_back({*tests_[i].stop, true});
      rows.resize(cells.size(), tests_[i].row);
    }
    const Points all = row_densities(
        study_, rows_with_outcomes(study_, conditions_, rows, cells, "planned"), nodes_);
    require_independent(rows, cells, all);
    std::vector<Outcomes> found(tests_.size());
    tbb::parallel_for(std::size_t{0}, tests_.size(),
                      [&](std::size_t i) { found[i] = outcomes_of(grids[i], i, all, scale); });
    for (std::size_t i = 0; i < tests_.size(); ++i) refuse_endless(i, found[i]);
    return found;
  }

 private:
  // A few of the rows in reverse order must have the same densities as among all.
  void require_independent(const std::vector<std::size_t>& rows,
                           const std::vector<TestOutcome>& cells, const Points& all) const {
    constexpr std::size_t few = 8;
    const std::size_t every = std::max<std::size_t>(1, rows.size() / few);
    std::vector<std::size_t> chosen, some_rows;
    std::vector<TestOutcome> some_cells;
    for (std::size_t i = rows.size(); i-- > 0;) {
      if (i % every != 0) continue;
      chosen.push_back(i);
      some_rows.push_back(rows[i]);
      some_cells.push_back(cells[i]);
    }
    const Points one = nodes_.row(nodes_.rows() / 2);
    const auto roughly = [&](const std::vector<std::size_t>& of_rows,
                             const std::vector<TestOutcome>& with) {
      return row_densities(study_,
                           rows_with_outcomes(study_, conditions_, of_rows, with, "planned"), one,
                           EffectIntegral::rough);
    };
    const Points again = roughly(some_rows, some_cells);
    // Exact integrals over a new level differ by their tolerance.
    const Points among_all = has_new_levels(study_, conditions_)
                                 ? roughly(rows, cells)
                                 : Points(all.row(nodes_.rows() / 2));
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      const double before = among_all(0, static_cast<Index>(chosen[k]));
      const double now = again(0, static_cast<Index>(k));
      if (!same_factor(before, now)) refuse_dependent_rows();
    }
  }

  Grid grid_of(std::size_t i, const OutcomeScale& scale) const {
    const OutcomeRange& range = ranges_[i];
    Grid grid;
    double low = range.low, high = range.high;
    if (tests_[i].stop) {
      grid.runout = true;
      const double stop = scale.place(*tests_[i].stop);
      high = std::min(high, stop);
      // All that fails earlier is below the range.
      if (!(low < high)) low = stop - 4 * range.narrowest, high = stop;
    }
    grid.quadrature = composite(low, high, range.narrowest);
    return grid;
  }

  Outcomes outcomes_of(const Grid& grid, std::size_t i, const Points& all,
                       const OutcomeScale& scale) const {
    const Quadrature& quadrature = grid.quadrature;
    const std::size_t n = quadrature.t.size();
    Outcomes outcomes;
    outcomes.runout = grid.runout;
    outcomes.log_probability.resize(nodes_.rows(), static_cast<Index>(grid.size()));
    const double log_unit = std::log(study_.measured_unit.scale);  // densities are per SI unit
    std::vector<double> shift;
    for (std::size_t m = 0; m < n; ++m) {
      outcomes.value.push_back(scale.value(quadrature.t[m]));
      outcomes.cell_begin.push_back(quadrature.begin[m]);
      outcomes.cell_end.push_back(quadrature.end[m]);
      shift.push_back(quadrature.log_weight[m] + scale.log_slope(quadrature.t[m]) + log_unit);
    }
    if (grid.runout) {
      outcomes.value.push_back(*tests_[i].stop);
      shift.push_back(0);
    }
    for (Index j = 0; j < nodes_.rows(); ++j) {
      check_stop();
      for (std::size_t m = 0; m < shift.size(); ++m)
        outcomes.log_probability(j, static_cast<Index>(m)) =
            static_cast<float>(all(j, static_cast<Index>(grid.first + m)) + shift[m]);
    }
    scale_to_one(outcomes, weights_);
    return outcomes;
  }

  void refuse_endless(std::size_t i, const Outcomes& outcomes) const {
    constexpr double most = 0.02;
    if (tests_[i].stop || outcomes.defect <= most) return;
    throw InputError(fmt::format(
        "{}: {} of this test {}", row_of(conditions_, tests_[i].row), study_.measured_name,
        study_.is_life
            ? fmt::format("is infinite with a probability of {:.2g} %, so that it may never end: "
                          "give a stop",
                          100 * outcomes.defect)
            : fmt::format("has a distribution that the integration over its outcomes does not "
                          "resolve (error {:.2g})",
                          outcomes.defect)));
  }

  const TestStudy& study_;
  const Table& conditions_;
  std::span<const PlannedTest> tests_;
  const Points& nodes_;
  std::span<const double> weights_;
  std::vector<OutcomeRange> ranges_;
};

// A test that shows only whether it failed.
std::vector<Outcomes> failure_or_runout(const TestStudy& study, const Table& conditions,
                                        std::span<const PlannedTest> tests, const Points& nodes,
                                        std::span<const double> weights) {
  std::vector<std::size_t> rows;
  std::vector<TestOutcome> cells;
  for (const PlannedTest& test : tests) {
    for (const bool runout : {false, true}) {
      rows.push_back(test.row);
      cells.push_back({0, runout});
    }
  }
  const Eigen::MatrixXd all =
      row_densities(study, rows_with_outcomes(study, conditions, rows, cells, "planned"), nodes);
  std::vector<Outcomes> found(tests.size());
  for (std::size_t i = 0; i < tests.size(); ++i) {
    found[i].value = {0, 1};
    found[i].cell_begin = found[i].cell_end = {0};
    found[i].runout = true;
    found[i].log_probability = all.middleCols(static_cast<Index>(2 * i), 2).cast<float>();
    scale_to_one(found[i], weights);
  }
  return found;
}

}  // namespace

void scale_to_one(Outcomes& outcomes, std::span<const double> weights) {
  Eigen::MatrixXf& p = outcomes.log_probability;
  const Index last = outcomes.runout ? p.cols() - 1 : p.cols();
  double defect = 0;
  for (Index j = 0; j < p.rows(); ++j) {
    check_stop();
    double sum = 0;
    for (Index m = 0; m < last; ++m) sum += std::exp(static_cast<double>(p(j, m)));
    const double stopped = outcomes.runout_probability(j);
    defect += weights[static_cast<std::size_t>(j)] * std::abs(sum + stopped - 1);
    if (sum > 0 && stopped < 1) {
      const auto shift = static_cast<float>(std::log1p(-stopped) - std::log(sum));
      // Where almost all run out, the few that fail keep their own sum.
      if (std::abs(shift) < 1) p.row(j).head(last).array() += shift;
    }
  }
  outcomes.defect = defect;
}

std::string row_of(const Table& conditions, std::size_t row) {
  return fmt::format("{}, {}", conditions.source,
                     row_name(row + 1, conditions.lines.empty() ? 0 : conditions.lines[row]));
}

void refuse_impossible(const Table& conditions, std::size_t row, double weight) {
  constexpr double most = 1e-3;
  if (weight <= most) return;
  throw InputError(fmt::format(
      "{}: the model has no value under these conditions with a probability of {} %: they "
      "lie outside the range of its formula",
      row_of(conditions, row), plain_number(100 * weight, 2)));
}

Scouts scouts_of(const Points& nodes, std::span<const double> weights) {
  constexpr Index most = 48;
  const Index every = std::max<Index>(1, nodes.rows() / most);
  Scouts scouts{Points((nodes.rows() + every - 1) / every, nodes.cols()), {}};
  double sum = 0;
  for (Index j = 0; j < nodes.rows(); j += every) {
    scouts.nodes.row(j / every) = nodes.row(j);
    scouts.weights.push_back(weights[static_cast<std::size_t>(j)]);
    sum += scouts.weights.back();
  }
  for (double& each : scouts.weights) each /= sum;
  return scouts;
}

TestOutcome Outcomes::drawn(Index node, double u, bool positive) const {
  double below = 0;
  const std::size_t continuous = cell_begin.size();
  for (std::size_t m = 0; m < continuous; ++m) {
    const double p = std::exp(static_cast<double>(log_probability(node, static_cast<Index>(m))));
    if (u < below + p || (m + 1 == continuous && !runout)) {
      const double part = p > 0 ? std::clamp((u - below) / p, 0.0, 1.0) : 0.5;
      const double t = std::lerp(cell_begin[m], cell_end[m], part);
      if (counted) return {std::round(t) + 0.0, false};  // no -0
      return {positive ? std::exp(t) : t, false};
    }
    below += p;
  }
  return {value.back(), true};
}

std::size_t Outcomes::drawn_index(Index node, double u) const {
  double below = 0;
  for (std::size_t m = 0; m + 1 < size(); ++m) {
    below += std::exp(static_cast<double>(log_probability(node, static_cast<Index>(m))));
    if (u < below) return m;
  }
  return size() - 1;
}

std::vector<Outcomes> possible_outcomes(const TestStudy& study, const Table& conditions,
                                        std::span<const PlannedTest> tests, const Points& nodes,
                                        std::span<const double> weights) {
  // Tests whose rows are read at once: fewer where each has many rows or integrals.
  const bool few = study.counted || has_new_levels(study, conditions);
  const std::size_t together = few ? 10 : 100;
  std::vector<Outcomes> all;
  for (std::size_t at = 0; at < tests.size(); at += together) {
    const auto some = tests.subspan(at, std::min(together, tests.size() - at));
    std::vector<Outcomes> found;
    if (study.measured.empty()) {
      found = failure_or_runout(study, conditions, some, nodes, weights);
    } else if (study.counted) {
      found = count_outcomes(study, conditions, some, nodes, weights);
    } else {
      Chunk chunk(study, conditions, some, nodes, weights);
      chunk.find_ranges();
      found = chunk.outcomes();
    }
    std::move(found.begin(), found.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace wearwell::plan
