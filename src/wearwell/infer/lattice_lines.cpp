#include "wearwell/infer/lattice_lines.h"

#include <fmt/format.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <span>
#include <utility>

#include "wearwell/bayes/posterior_along.h"

namespace wearwell::lattice {
namespace {

constexpr int farthest = 3000;   // steps along an axis; with more, the mass is considered unbounded
constexpr int most_across = 80;  // steps along a line on either side of its mode

std::uint64_t key(const Index& index) {
  std::uint64_t packed = 0;
  for (const std::int16_t i : index) packed = packed << 16 | static_cast<std::uint16_t>(i);
  return packed;
}

}  // namespace

double node_mass(const Line& line, int t) {
  const int j = t - line.first;
  if (j < 0 || j >= static_cast<int>(line.values.size())) return 0;
  return std::exp(line.values[static_cast<std::size_t>(j)]) * line.width;
}

double mass_of(const Line& line) {
  double mass = 0;
  for (const double v : line.values) mass += std::exp(v) * line.width;
  return mass;
}

Lines::Lines(const Posterior& posterior, const LatticeChart& chart, const Axes& axes,
             const Steps& steps)
    : posterior_(posterior), chart_(chart), axes_(axes), steps_(steps) {
  reference_ = density(place({}, -1, 0, 0));
}

// Freeing tens of thousands of lines takes time.
Lines::~Lines() {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 256), [&](const auto& part) {
    for (std::size_t l = part.begin(); l != part.end(); ++l) lines_[l] = {};
  });
}

double Lines::log_of(double mass) const {
  for (const double step : steps_) mass *= step;
  return reference_ + std::log(mass) + chart_.log_scale();
}

std::string Lines::fill(double log_negligible, long most, Progress* progress) {
  log_negligible_ = log_negligible;
  std::vector<Line> ring;
  if (lines_.empty()) {
    ring.resize(1);
    known_.emplace(key(ring.front().index), 0);
  } else {
    lengthen(progress);
    if (const std::string failure = surround(0, ring); !failure.empty()) return failure;
  }
  while (!ring.empty()) {
    const std::size_t before = lines_.size();
    add(std::move(ring), progress);
    ring.clear();
    if (highest_ > 300 && !set_reference()) return "the density is unbounded";
    if (const std::string failure = surround(before, ring); !failure.empty()) return failure;
    if (nodes_ > most) return fmt::format("no convergence in {} evaluations", nodes_);
  }
  return {};
}

Axes Lines::stretched_axes() const {
  Axes axes;
  for (std::size_t a = 0; a < outer; ++a) {
    std::map<int, double> marginal;
    double all = 0;
    for (const Line& line : lines_) {
      const double mass = mass_of(line);
      marginal[line.index[a]] += mass;
      all += mass;
    }
    const auto quantile = [&](double p) {
      double below = 0;
      for (const auto& [index, mass] : marginal) {
        if (below + mass >= p * all) return steps_[a] * (index - 0.5 + (p * all - below) / mass);
        below += mass;
      }
      return steps_[a] * marginal.rbegin()->first;
    };
    constexpr double central = 0.9, normal = 1.645;
    const double sd = (quantile(0.5 + central / 2) - quantile(0.5 - central / 2)) / (2 * normal);
    axes[a] = {.center = quantile(0.5), .far = 5 * std::max(sd, 0.5 * steps_[a])};
  }
  return axes;
}

// Fills these lines.
void Lines::add(std::vector<Line> ring, Progress* progress) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, ring.size(), 8), [&](const auto& part) {
    Sides sides;
    for (std::size_t i = part.begin(); i != part.end(); ++i) integrate(ring[i], sides);
  });
  std::move(ring.begin(), ring.end(), std::back_inserter(lines_));
  count(lines_.size() - ring.size(), progress);
}

// Continues lines that ended at a higher density than is negligible now.
void Lines::lengthen(Progress* progress) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, lines_.size(), 8), [&](const auto& part) {
    Sides sides;
    for (std::size_t i = part.begin(); i != part.end(); ++i) lengthen(lines_[i], sides);
  });
  nodes_ = 0;
  count(0, progress);
}

// Counts the nodes of lines from `first` on.
void Lines::count(std::size_t first, Progress* progress) {
  constexpr long most_kept = 1'500'000;  // some tens of megabytes
  for (std::size_t i = first; i < lines_.size(); ++i) {
    nodes_ += static_cast<long>(lines_[i].values.size());
    highest_ = std::max(highest_, lines_[i].highest);
  }
  if (progress && nodes_ > reported_) progress->advance(nodes_ - std::exchange(reported_, nodes_));
  if (!keeps_ || nodes_ <= most_kept) return;
  keeps_ = false;
  for (Line& line : lines_) std::vector<Located>().swap(line.kept);
}

// Adds to `ring` the unknown neighbours of lines from `first` on with mass that matters. Empty, or
// the reason for stopping.
std::string Lines::surround(std::size_t first, std::vector<Line>& ring) {
  for (std::size_t i = first; i < lines_.size(); ++i) {
    const Line& line = lines_[i];
    if (line.highest < highest_ + log_negligible_) continue;
    for (std::size_t a = 0; a < outer; ++a) {
      for (const int way : {-1, 1}) {
        Line next;
        next.index = line.index;
        next.index[a] = static_cast<std::int16_t>(next.index[a] + way);
        if (std::abs(next.index[a]) > farthest)
          return "its mass is unbounded: the posterior is improper or far too wide";
        if (!known_.emplace(key(next.index), lines_.size() + ring.size()).second) continue;
        next.middle = line.middle;
        next.width = line.width;
        // Modes of neighbours lie nearly in a line.
        const Line& opposite = neighbour(line, static_cast<int>(a), -way);
        next.middle += std::clamp(line.middle - opposite.middle, -line.width, line.width);
        ring.push_back(std::move(next));
      }
    }
  }
  return {};
}

// The three coordinates: step (index + shift along one axis).
Place Lines::place(const Index& index, int axis, double shift, double on_line) const {
  Eigen::Vector4d along;
  double slopes = 1;
  for (int i = 0; i < outer; ++i) {
    const auto a = static_cast<std::size_t>(i);
    const Axis::Place there = axes_[a].at(steps_[a] * (index[a] + (i == axis ? shift : 0)));
    along[i] = there.u;
    slopes *= there.slope;
  }
  along[outer] = on_line;
  Place place;
  place.log_jacobian = chart_.to_real(along, place.z) + std::log(slopes);
  return place;
}
Place Lines::at(const Line& line, double t) const {
  return place(line.index, -1, 0, line.middle + line.width * steps_[outer] * t);
}
double Lines::density(const Place& there) const {
  return posterior_.value(there.z) + there.log_jacobian;
}
Place Lines::between(const Line& line, const Line& other, const Line& opposite, int axis,
                     double shift, int t) const {
  const auto half_way = [](double here, double there, double back) {
    return 0.375 * there + 0.75 * here - 0.125 * back;
  };
  return place(line.index, axis, shift,
               half_way(line.middle, other.middle, opposite.middle) +
                   half_way(line.width, other.width, opposite.width) * steps_[outer] * t);
}

Eigen::Vector4d Lines::natural(const Place& there) const {
  Eigen::Vector4d x;
  posterior_.to_natural(there.z, std::span<double>(x.data(), d));
  return x;
}

const Line& Lines::neighbour(const Line& line, int axis, int way) const {
  Index index = line.index;
  index[axis] = static_cast<std::int16_t>(index[axis] + way);
  const auto found = known_.find(key(index));
  return found == known_.end() || found->second >= lines_.size() ? line : lines_[found->second];
}

Located Lines::located(const Line& line, std::size_t j) const {
  if (!line.kept.empty()) return line.kept[j];
  const Place there = at(line, line.first + static_cast<int>(j));
  return {natural(there), there.log_jacobian};
}

// Makes the highest density so far the reference, if the walk began far below the mode. False if
// it was moved so often that the density is unbounded.
bool Lines::set_reference() {
  constexpr int most = 20;
  if (++moves_ > most || !std::isfinite(highest_)) return false;
  for (Line& line : lines_) {
    line.highest -= highest_;
    for (double& value : line.values) value -= highest_;
  }
  reference_ += highest_;
  highest_ = 0;
  return true;
}

// The density along one line, and the positions of its points.
class Lines::Walk {
 public:
  Walk(const Lines& lattice, const Line& line) : lattice_(lattice), index_(line.index) {
    const auto parameter = lattice.chart_.line_parameter();
    if (!parameter) return;
    there_ = lattice.place(index_, -1, 0, line.middle);
    along_.emplace(lattice.posterior_, there_.z, *parameter);
    others_ = there_.log_jacobian - lattice.chart_.on_line(line.middle).log_slope;
  }

  double value(double on_line) {
    if (!along_) {
      there_ = lattice_.place(index_, -1, 0, on_line);
      return lattice_.density(there_) - lattice_.reference_;
    }
    const LatticeChart::OnLine here = lattice_.chart_.on_line(on_line);
    there_.log_jacobian = others_ + here.log_slope;
    return along_->value(here.z) + there_.log_jacobian - lattice_.reference_;
  }
  // Of the last evaluated point.
  Located located() const {
    if (!along_) return {lattice_.natural(there_), there_.log_jacobian};
    return {Eigen::Map<const Eigen::Vector4d>(along_->natural().data()), there_.log_jacobian};
  }

 private:
  const Lines& lattice_;
  Index index_;
  Place there_;
  std::optional<PosteriorAlong> along_;
  double others_ = 0;  // log Jacobian of the fixed parameters
};

// Finds the line's mode by parabolas, starting from its neighbor's mode, then walks outward on
// both sides.
void Lines::integrate(Line& line, Sides& sides) const {
  Walk walk(*this, line);
  double middle = walk.value(line.middle);
  Located at_mode = walk.located();
  for (int iteration = 0; iteration < 6; ++iteration) {
    const double reach = 0.7 * line.width;
    const double below = walk.value(line.middle - reach), above = walk.value(line.middle + reach);
    const double bend = 2 * middle - below - above;
    if (!std::isfinite(bend) || !(bend > 1e-8)) break;
    const double slope = 0.5 * (above - below);
    const double width = reach / std::sqrt(bend);
    // Far from the mode the parabola is only a direction.
    const double move = std::clamp(slope / bend * reach, -8 * line.width, 8 * line.width);
    const double there = walk.value(line.middle + move);
    if (!(there >= middle)) break;
    line.middle += move;
    line.width = std::clamp(width, 0.25 * line.width, 4 * line.width);
    middle = there;
    at_mode = walk.located();
    if (std::abs(move) < 0.05 * line.width) break;
  }
  line.values.push_back(middle);
  line.highest = middle;
  if (keeps_) line.kept.push_back(at_mode);
  walk_outward(walk, line, sides);
}

// Nodes of a line beyond its present ones.
void Lines::lengthen(Line& line, Sides& sides) const {
  const double end = std::max(line.highest, highest_) + log_negligible_;
  if (!(line.values.front() > end) && !(line.values.back() > end)) return;
  Walk walk(*this, line);
  walk_outward(walk, line, sides);
}

void Lines::walk_outward(Walk& walk, Line& line, Sides& sides) const {
  const auto farther = [&](double value) {
    return value > std::max(line.highest, highest_) + log_negligible_;
  };
  const int last = line.first + static_cast<int>(line.values.size()) - 1;
  for (const int way : {-1, 1}) {
    std::vector<double>& values = sides.values[way < 0 ? 0 : 1];
    std::vector<Located>& kept = sides.kept[way < 0 ? 0 : 1];
    values.clear();
    kept.clear();
    double v = way < 0 ? line.values.front() : line.values.back();
    const bool first = line.values.size() == 1;
    for (int t = (way < 0 ? line.first : last) + way;
         std::abs(t) <= most_across && (farther(v) || (first && values.empty())); t += way) {
      v = walk.value(line.middle + t * steps_[outer] * line.width);
      values.push_back(v);
      if (keeps_) kept.push_back(walk.located());
      line.highest = std::max(line.highest, v);
    }
  }
  const auto join = [](auto& here, const auto& both) {
    here.reserve(here.size() + both[0].size() + both[1].size());
    here.insert(here.begin(), both[0].rbegin(), both[0].rend());
    here.insert(here.end(), both[1].begin(), both[1].end());
  };
  line.first -= static_cast<int>(sides.values[0].size());
  join(line.values, sides.values);
  if (keeps_) join(line.kept, sides.kept);
}

}  // namespace wearwell::lattice
