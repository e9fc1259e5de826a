#include "wearwell/models/formula_model/formula_hidden_path.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "wearwell/math/constants.h"
#include "wearwell/models/formula_model/hidden_step.h"

// Longer than others: one lattice, its forward and backward passes, and their results.
namespace wearwell::formula_model {
namespace {

// of a row: a row that reaches farther is outside the range of this method
constexpr int most_nodes = 20'000;
constexpr double usual_widths = 3, log_two = 0.693147180559945309;

using Line = Eigen::Map<Eigen::ArrayXd>;
using FixedLine = Eigen::Map<const Eigen::ArrayXd>;

// Of one row: the lattice from `low` to `high`, in widths, of which `begin` to `end` are used.
struct Row {
  int low = 0, high = 0, begin = 0, end = 0;
  double step_mean = 0, scale = 0, noise = 0, reading = 0;
  HiddenStep step;
  std::vector<double> predicted, density, filtered;
  double factor = 0;

  int size() const { return high - low + 1; }
  double share(int place) const { return filtered[static_cast<std::size_t>(place - low)]; }
};

// Positions of a row that one position of the previous row can reach.
struct Reached {
  int from, count;  // of the row's positions
  std::size_t lag;  // of the first
  Reached(const Row& row, int place) {
    const int first = place + row.step.first;
    const int last = first + static_cast<int>(row.step.lag.size()) - 1;
    from = std::max(row.low, first);
    count = std::max(std::min(row.high, last) - from + 1, 0);
    lag = static_cast<std::size_t>(std::max(from - first, 0));
  }
};

class HiddenPath {
 public:
  // False if the density is zero or not finite.
  bool filter(const ProcessForm& form, const ProcessRows& rows, double per_width = usual_widths) {
    process_ = form.process;
    return read(rows) && place(per_width) && pass();
  }
  // After `filter`.
  void slopes(std::span<double> slope);

  void place_step(Row& row, int least, int most) const {
    if (row.step_mean > 0) {
      row.step.rebuild(process_, row.step_mean, row.scale, h_, least, most);
    } else {
      row.step.place_nothing();
    }
  }
  const Row* row_before(std::size_t i) const { return i > 0 ? &rows_[i - 1] : nullptr; }

  std::size_t count_ = 0;
  std::vector<Row> rows_;
  double h_ = 0;

 private:
  bool read(const ProcessRows& rows);
  bool place(double per_width);
  void smooth();
  double usual_step(const Row& row) const;
  bool pass();
  void fill_density(Row& row) const;
  bool meet_reading(Row& row) const;

  Process process_ = Process::gamma;
  // The normal path with these variances, given all readings.
  std::vector<double> at_, variance_, next_, next_variance_;
};

// Before the first row the path is at 0.
Row start_row() {
  Row row;
  row.filtered = {1};
  row.end = 1;
  return row;
}

const Row& or_start(const Row* before) {
  static const Row start = start_row();
  return before ? *before : start;
}

bool HiddenPath::read(const ProcessRows& rows) {
  count_ = rows.reading.size();
  if (rows_.size() < count_) rows_.resize(count_);
  for (std::size_t i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    row.step_mean = rows.mean[i] - (i > 0 ? rows.mean[i - 1] : 0);
    row.scale = rows.spread[i];
    row.noise = rows.noise[i];
    row.reading = rows.reading[i];
    const bool right = row.step_mean >= 0 && row.scale > 0 && row.noise > 0 &&
                       std::isfinite(row.step_mean + row.scale + row.noise + row.reading);
    if (!right) return false;
  }
  return true;
}

// Kalman's filter and the smoother of Rauch, Tung and Striebel.
void HiddenPath::smooth() {
  for (auto* each : {&at_, &variance_, &next_, &next_variance_}) each->resize(count_);
  double a = 0, v = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Row& row = rows_[i];
    next_[i] = a + row.step_mean;
    next_variance_[i] = v + row.step_mean * row.scale;
    const double gain = next_variance_[i] / (next_variance_[i] + row.noise * row.noise);
    at_[i] = a = next_[i] + gain * (row.reading - next_[i]);
    variance_[i] = v = next_variance_[i] * (1 - gain);
  }
  for (std::size_t i = count_ - 1; i-- > 0;) {
    const double gain = next_variance_[i + 1] > 0 ? variance_[i] / next_variance_[i + 1] : 1;
    at_[i] += gain * (at_[i + 1] - next_[i + 1]);
    variance_[i] += gain * gain * (variance_[i + 1] - next_variance_[i + 1]);
  }
}

// The square of a typical step over its mean: for a small shape much less than its variance.
// (Approximately the median of a gamma distribution, and the shape of an inverse Gaussian one;
// continuous at shape 1.)
double HiddenPath::usual_step(const Row& row) const {
  const double shape = row.step_mean / row.scale;
  if (!(shape < 1)) return row.scale;
  const double usual = process_ == Process::gamma
                           ? row.scale * std::exp((std::lgamma(1 + shape) - log_two) / shape +
                                                  log_two * std::pow(shape, 4))
                           : row.step_mean * shape;
  return usual * usual / row.step_mean;
}

// The lattice and the range of each row: from its reading, and from all readings as if the path
// were normal.
bool HiddenPath::place(double per_width) {
  constexpr double reach = 7, own_reach = 7;
  smooth();
  // From the last row back: the likelihood of later rows.
  double finest = infinity, known = infinity;
  for (std::size_t i = count_; i-- > 0;) {
    const Row& row = rows_[i];
    known = 1 / (1 / (row.noise * row.noise) + 1 / known);
    finest = std::min(finest, known);
    if (row.step_mean > 0) known += row.step_mean * usual_step(row);
  }
  h_ = std::sqrt(finest) / per_width;
  if (!std::isfinite(h_)) return false;
  for (std::size_t i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    const double off = reach * row.noise, own = own_reach * std::sqrt(std::max(variance_[i], 0.0));
    const double low = std::min(row.reading - off, at_[i] - own);
    const double high = std::max(row.reading + off, at_[i] + own);
    if (!(std::abs(low) < 1e9 * h_ && std::abs(high) < 1e9 * h_)) return false;
    row.low = std::max(static_cast<int>(std::floor(low / h_)), 0) - HiddenStep::before;
    row.high = std::max(static_cast<int>(std::ceil(high / h_)), 0) + HiddenStep::before + 1;
    if (row.size() > most_nodes) return false;
  }
  return true;
}

// Of the reading at each position. Away from the center by the ratio of neighbours, which itself
// changes by a constant ratio.
void HiddenPath::fill_density(Row& row) const {
  const double width = h_ / row.noise, falls = std::exp(-width * width);
  const int middle = std::clamp(
      static_cast<int>(std::lround(std::clamp(row.reading / h_, -1e9, 1e9))), row.low, row.high);
  const double z = (row.reading - middle * h_) / row.noise;
  const double there = std::exp(-0.5 * (z * z + log_two_pi)) / row.noise;
  for (const int way : {1, -1}) {
    double density = there, ratio = std::exp((way * z - 0.5 * width) * width);
    for (int place = middle; place >= row.low && place <= row.high; place += way) {
      row.density[static_cast<std::size_t>(place - row.low)] = density;
      density *= ratio;
      ratio *= falls;
    }
  }
}

bool HiddenPath::meet_reading(Row& row) const {
  constexpr double negligible = 1e-12;
  const auto n = static_cast<std::size_t>(row.size());
  row.density.resize(n);
  row.filtered.resize(n);
  row.factor = 0;
  double largest = 0;
  fill_density(row);
  for (std::size_t k = 0; k < n; ++k) {
    row.filtered[k] = row.predicted[k] * row.density[k];
    row.factor += row.filtered[k];
    largest = std::max(largest, std::abs(row.filtered[k]));
  }
  if (!(row.factor > 0) || !std::isfinite(row.factor)) return false;
  for (double& each : row.filtered) each /= row.factor;
  row.begin = row.low;
  row.end = row.high + 1;
  const double least = negligible * largest / row.factor;
  while (row.end - row.begin > 1 && std::abs(row.share(row.begin)) < least) ++row.begin;
  while (row.end - row.begin > 1 && std::abs(row.share(row.end - 1)) < least) --row.end;
  return true;
}

bool HiddenPath::pass() {
  for (std::size_t i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    const Row& earlier = or_start(row_before(i));
    // Polynomials at positions near 0 extend below it.
    if (row.low < 0) row.low = std::min(row.low, earlier.begin - HiddenStep::before);
    place_step(row, row.low - earlier.end + 1, row.high - earlier.begin);
    row.predicted.assign(static_cast<std::size_t>(row.size()), 0.0);
    for (int j = earlier.begin; j < earlier.end; ++j) {
      const Reached to(row, j);
      Line(&row.predicted[0] + (to.from - row.low), to.count) +=
          earlier.share(j) * FixedLine(row.step.lag.data() + to.lag, to.count);
    }
    if (!meet_reading(row)) return false;
  }
  return true;
}

void HiddenPath::slopes(std::span<double> slope) {
  static thread_local std::vector<double> after, behind, meets;
  std::fill(slope.begin(), slope.end(), 0.0);
  after.assign(rows_[count_ - 1].predicted.size(), 1.0);
  for (std::size_t i = count_; i-- > 0;) {
    const Row& row = rows_[i];
    double by_noise = 0;
    for (std::size_t k = 0; k < after.size(); ++k) {
      const double z = (row.reading - (row.low + static_cast<int>(k)) * h_) / row.noise;
      after[k] *= row.density[k] / row.factor;
      by_noise += row.predicted[k] * after[k] * (z * z - 1) / row.noise;
    }
    slope[2 * count_ + i] = by_noise;
    const Row& earlier = or_start(row_before(i));
    behind.assign(static_cast<std::size_t>(earlier.size()), 0.0);
    meets.assign(row.step.lag.size(), 0.0);
    for (int j = earlier.begin; j < earlier.end; ++j) {
      const Reached to(row, j);
      const FixedLine beyond(after.data() + (to.from - row.low), to.count);
      Line(meets.data() + to.lag, to.count) += earlier.share(j) * beyond;
      behind[static_cast<std::size_t>(j - earlier.low)] =
          (FixedLine(row.step.lag.data() + to.lag, to.count) * beyond).sum();
    }
    if (row.step_mean > 0) {
      const HiddenStep::Slopes by = row.step.slopes(meets);
      slope[i] += by.by_mean;
      if (i > 0) slope[i - 1] -= by.by_mean;
      slope[count_ + i] = by.by_scale;
    }
    std::swap(after, behind);
  }
}

HiddenPath& mine() {
  static thread_local HiddenPath path;
  return path;
}

}  // namespace

bool is_hidden(const ProcessForm& form, const ProcessRows& rows) {
  // Negligible errors count as none, for searches that reach that bound.
  constexpr double nothing = 1e-6;
  if (form.process == Process::wiener || rows.noise.empty()) return false;
  double before = 0, least = infinity, most = 0;
  for (std::size_t i = 0; i < rows.reading.size(); ++i) {
    least = std::min(least, std::abs(rows.reading[i] - before));
    before = rows.reading[i];
    most = std::max(most, rows.noise[i]);
  }
  return most > nothing * least;
}

void hidden_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope, double per_width) {
  HiddenPath& path = mine();
  if (!path.filter(form, rows, per_width)) {
    std::fill(value.begin(), value.end(), 0.0);
    value[0] = -infinity;
    std::fill(slope.begin(), slope.end(), 0.0);
    return;
  }
  for (std::size_t i = 0; i < path.count_; ++i) value[i] = std::log(path.rows_[i].factor);
  if (!slope.empty()) path.slopes(slope);
}

Standing hidden_standing(const ProcessForm& form, const ProcessRows& rows) {
  HiddenPath& path = mine();
  Standing stands;
  if (rows.reading.empty()) return stands;
  stands.mean = rows.mean.back();
  if (!path.filter(form, rows)) {
    stands.at = stands.variance = std::nan("");
    return stands;
  }
  const Row& last = path.rows_[path.count_ - 1];
  constexpr int of_cell = 3;
  double first = 0, second = 0;
  stands.width = of_cell * path.h_;
  for (int low = last.begin; low < last.end; low += of_cell) {
    double share = 0, moment = 0;
    for (int k = low; k < std::min(low + of_cell, last.end); ++k) {
      const double x = k * path.h_;
      share += last.share(k);
      moment += last.share(k) * x;
      second += last.share(k) * x * x;
    }
    first += moment;
    // Near 0 weights may be slightly negative, as interpolation weights are.
    if (share > 1e-7) stands.cells.push_back({std::max(moment / share, 0.0), share});
  }
  double sum = 0;
  for (const Standing::Cell& each : stands.cells) sum += each.share;
  for (Standing::Cell& each : stands.cells) each.share /= sum;
  stands.at = first;
  stands.variance = std::max(second - first * first, 0.0);
  return stands;
}

void hidden_scores(const ProcessForm& form, const ProcessRows& rows,
                   std::vector<NormalScore>& scores) {
  scores.assign(rows.reading.size(), {-infinity, infinity});
  HiddenPath& path = mine();
  if (!path.filter(form, rows)) return;
  for (std::size_t i = 0; i < path.count_; ++i) {
    Row& row = path.rows_[i];
    const Row& earlier = or_start(path.row_before(i));
    // All steps that do not end far beyond the reading.
    path.place_step(row, 0, row.high - earlier.begin);
    double below = 0;
    for (int j = earlier.begin; j < earlier.end; ++j) {
      const double share = earlier.share(j);
      if (std::abs(share) < 1e-10) continue;
      double sum = 0;
      for (std::size_t k = 0; k < row.step.lag.size(); ++k) {
        const double x = (j + row.step.first + static_cast<int>(k)) * path.h_;
        const double z = (row.reading - x) / row.noise;
        if (z > -9) sum += row.step.lag[k] * (z > 9 ? 1 : normal_cdf(z));
      }
      below += share * sum;
    }
    below = std::clamp(below, 1e-300, 1 - 1e-16);
    const double z = normal_score(std::log(below), std::log1p(-below));
    scores[i] = {z, z};
  }
}

double hidden_unsettled(const ProcessForm& form, const ProcessRows& rows) {
  std::vector<double> value(rows.reading.size());
  double off = 0;
  for (const double per_width : {usual_widths, 1.5 * usual_widths}) {
    if (value.empty()) break;
    hidden_terms(form, rows, value, {}, per_width);
    double sum = 0;
    for (const double each : value) sum += each;
    off = sum - off;
  }
  return std::isnan(off) ? 0 : std::abs(off);
}

}  // namespace wearwell::formula_model
