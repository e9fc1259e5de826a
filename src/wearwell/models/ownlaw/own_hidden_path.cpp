#include "wearwell/models/ownlaw/own_hidden_path.h"

#include <algorithm>
#include <boost/math/special_functions/digamma.hpp>
#include <cmath>

#include "wearwell/math/constants.h"

// Longer than others: a lattice, the law of a step on it, and the passes there and back.
namespace wearwell::ownlaw {
namespace {

constexpr int stencil = 6;
constexpr int most_nodes = 20'000;  // of a row: what looks farther is no density to compute with

constexpr double gauss_x[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                              0.9602898564975363};
constexpr double gauss_w[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                              0.1012285362903763};

// The law of one step, and its derivatives by its mean and by scale.
struct StepLaw {
  bool gamma;
  double mean, scale;
  double shape = 0, log_scale = 0, rest = 0, digamma = 0;

  StepLaw(bool of_gamma, double dm, double u) : gamma(of_gamma), mean(dm), scale(u) {
    log_scale = std::log(u);
    if (gamma) {
      shape = dm / u;
      rest = -std::lgamma(shape);
      digamma = boost::math::digamma(shape);
    } else {
      rest = std::log(dm) - 0.5 * (log_two_pi + log_scale);
    }
  }

  double density(double x, double log_x) const {
    if (gamma) {
      return std::exp((shape - 1) * (log_x - log_scale) - x / scale - log_scale + rest);
    }
    return std::exp(rest - 1.5 * log_x - (x - mean) * (x - mean) / (2 * scale * x));
  }
  // Of the log density.
  double by_mean(double x, double log_x) const {
    if (gamma) return (log_x - log_scale - digamma) / scale;
    return 1 / mean + (x - mean) / (scale * x);
  }
  double by_scale(double x, double slope_by_mean) const {
    if (gamma) return -shape * slope_by_mean + (x / scale - shape) / scale;
    const double off = x - mean;
    return -0.5 / scale + off * off / (2 * scale * scale * x);
  }
  double below(double x) const { return below(x, mean, scale); }
  double below(double x, double dm, double u) const {
    const ResponseFamily family = gamma ? ResponseFamily::gamma : ResponseFamily::inverse_gaussian;
    const double slots[most_response_slots] = {gamma ? dm / u : dm, gamma ? u : dm * dm / u};
    return std::exp(log_cdf(family, x, slots));
  }
};

// Places of a step with what they count, and the derivatives of that.
struct StepNodes {
  std::vector<double> x, weight, by_mean, by_scale;

  void clear() {
    for (auto* each : {&x, &weight, &by_mean, &by_scale}) each->clear();
  }
  void add(double at, double w, double dm, double du) {
    x.push_back(at);
    weight.push_back(w);
    by_mean.push_back(dm);
    by_scale.push_back(du);
  }
  void add_panel(const StepLaw& law, double from, double to) {
    const double middle = 0.5 * (from + to), half = 0.5 * (to - from);
    for (int i = 0; i < 4; ++i) {
      for (const double side : {-1.0, 1.0}) {
        const double at = middle + side * half * gauss_x[i];
        const double log_at = std::log(at), w = half * gauss_w[i] * law.density(at, log_at);
        if (!(w > 0)) continue;
        const double slope = law.by_mean(at, log_at);
        add(at, w, w * slope, w * law.by_scale(at, slope));
      }
    }
  }
};

// Between `from` and `to`, of functions that change by lengths of `smooth`.
void fill(const StepLaw& law, double from, double to, double smooth, StepNodes& nodes) {
  nodes.clear();
  const double sd = std::sqrt(law.mean * law.scale), wide = std::max(sd, law.scale);
  const double width = std::min(smooth, 1.5 * wide);
  double at = std::max(from, law.mean - 38 * sd);
  const double end = std::min(to, law.mean + 38 * sd + 700 * law.scale);
  if (!(at < end)) return;
  const double nothing = 2e-4 * width;
  if (at < nothing) {
    const double mass = law.below(nothing);
    if (mass > 0) {
      constexpr double step = 1e-5;
      const auto slope = [&](double dm, double du) {
        return law.below(nothing, law.mean * (1 + dm), law.scale * (1 + du)) -
               law.below(nothing, law.mean * (1 - dm), law.scale * (1 - du));
      };
      const double inside = law.gamma ? law.shape / (law.shape + 1) : 0.7;
      nodes.add(inside * nothing, mass, slope(step, 0) / (2 * step * law.mean),
                slope(0, step) / (2 * step * law.scale));
    }
    at = nothing;
  }
  // As wide as where they begin, so that a pole at 0 is far from each.
  while (at < end) {
    const double next = std::min(end, at + std::min(at, width));
    nodes.add_panel(law, at, next);
    at = next;
  }
}

// Weights of the polynomial through six neighbouring places -2 .. 3, at t in [0, 1).
void interpolate(double t, double* w) {
  const double a = t + 2, b = t + 1, c = t, d = t - 1, e = t - 2, f = t - 3;
  w[0] = -b * c * d * e * f / 120;
  w[1] = a * c * d * e * f / 24;
  w[2] = -a * b * d * e * f / 12;
  w[3] = a * b * c * e * f / 12;
  w[4] = -a * b * c * d * f / 24;
  w[5] = a * b * c * d * e / 120;
}

// Of one row: the lattice from `low` to `high`, in steps.
struct Row {
  int low = 0, high = 0;
  double step_mean = 0, scale = 0, noise = 0, reading = 0;
  StepNodes nodes;
  int first_lag = 0;
  std::vector<double> lag;  // what a step of so many steps counts
  std::vector<double> predicted, density, filtered;
  double factor = 0;

  int size() const { return high - low + 1; }
  bool still() const { return step_mean == 0; }
};

class HiddenPath {
 public:
  // False where there is no density.
  bool filter(const ProcessForm& form, const ProcessRows& rows) {
    gamma_ = form.process == Process::gamma;
    return read(rows) && place() && pass();
  }
  // After `filter`.
  void slopes(std::span<double> slope);

  std::size_t count_ = 0;
  std::vector<Row> rows_;
  double h_ = 0;

  // The law of steps between two lags, on the lattice.
  void lay_step(Row& row, int first, int last) const {
    row.first_lag = std::max(first, 0) - 3;
    row.lag.assign(static_cast<std::size_t>(std::max(last, 0) + 4 - row.first_lag), 0.0);
    if (row.still()) {
      row.lag[static_cast<std::size_t>(0 - row.first_lag)] = first <= 0 ? 1 : 0;
      return;
    }
    fill(StepLaw(gamma_, row.step_mean, row.scale), std::max(first, 0) * h_, std::max(last, 0) * h_,
         4 * h_, row.nodes);
    double w[stencil];
    for (std::size_t q = 0; q < row.nodes.x.size(); ++q) {
      double* at = &row.lag[place_of(row, row.nodes.x[q], w)];
      for (int k = 0; k < stencil; ++k) at[k] += row.nodes.weight[q] * w[k];
    }
  }

 private:
  std::size_t place_of(const Row& row, double x, double* w) const {
    const double steps = x / h_, whole = std::floor(steps);
    interpolate(steps - whole, w);
    return static_cast<std::size_t>(static_cast<int>(whole) - 2 - row.first_lag);
  }
  bool read(const ProcessRows& rows);
  bool place();
  bool pass();

  bool gamma_ = false;
};

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

// The lattice, and how far each row looks: by its reading, and by what all readings say of the path were it normal
// (Kalman's filter and the smoother of Rauch, Tung and Striebel).
bool HiddenPath::place() {
  constexpr double reach = 6.5, per_scale = 4;
  static thread_local std::vector<double> at, variance, next, next_variance, grown;
  for (auto* each : {&at, &variance, &next, &next_variance, &grown}) each->resize(count_);
  double a = 0, v = 0, sum = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    const Row& row = rows_[i];
    sum += row.step_mean * row.scale;
    grown[i] = sum;
    next[i] = a + row.step_mean;
    next_variance[i] = v + row.step_mean * row.scale;
    const double gain = next_variance[i] / (next_variance[i] + row.noise * row.noise);
    at[i] = a = next[i] + gain * (row.reading - next[i]);
    variance[i] = v = next_variance[i] * (1 - gain);
  }
  for (std::size_t i = count_ - 1; i-- > 0;) {
    const double gain = next_variance[i + 1] > 0 ? variance[i] / next_variance[i + 1] : 1;
    at[i] += gain * (at[i + 1] - next[i + 1]);
    variance[i] += gain * gain * (variance[i + 1] - next_variance[i + 1]);
  }
  double finest = infinity;
  for (std::size_t i = 0; i < count_; ++i) {
    double known = 0;
    for (std::size_t j = 0; j < count_; ++j) {
      known += 1 / (rows_[j].noise * rows_[j].noise + std::abs(grown[i] - grown[j]));
    }
    finest = std::min(finest, 1 / std::sqrt(known));
  }
  h_ = finest / per_scale;
  for (std::size_t i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    const double off = reach * row.noise, own = reach * std::sqrt(std::max(variance[i], 0.0));
    const double low = std::min(row.reading - off, at[i] - own);
    const double high = std::max(row.reading + off, at[i] + own);
    if (!(std::abs(low) < 1e9 * h_ && std::abs(high) < 1e9 * h_)) return false;
    row.low = std::max(static_cast<int>(std::floor(low / h_)), 0) - 3;
    row.high = std::max(static_cast<int>(std::ceil(high / h_)), 0) + 3;
    if (row.size() > most_nodes) return false;
  }
  return true;
}

bool HiddenPath::pass() {
  static const std::vector<double> start = {1};
  for (std::size_t i = 0; i < count_; ++i) {
    Row& row = rows_[i];
    const int low = i > 0 ? rows_[i - 1].low : 0, high = i > 0 ? rows_[i - 1].high : 0;
    const std::vector<double>& before = i > 0 ? rows_[i - 1].filtered : start;
    lay_step(row, row.low - high, row.high - low);
    const auto n = static_cast<std::size_t>(row.size());
    row.predicted.assign(n, 0.0);
    const int lags = static_cast<int>(row.lag.size());
    for (int j = low; j <= high; ++j) {
      const double share = before[static_cast<std::size_t>(j - low)];
      const int from = std::max(row.low, j + row.first_lag);
      const int to = std::min(row.high, j + row.first_lag + lags - 1);
      if (to < from) continue;
      const double* lag = row.lag.data() + (from - j - row.first_lag);
      double* out = row.predicted.data() + (from - row.low);
      for (int k = 0; k <= to - from; ++k) out[k] += share * lag[k];
    }
    row.density.resize(n);
    row.filtered.resize(n);
    row.factor = 0;
    for (std::size_t k = 0; k < n; ++k) {
      const double z = (row.reading - (row.low + static_cast<int>(k)) * h_) / row.noise;
      row.density[k] = std::exp(-0.5 * (z * z + log_two_pi)) / row.noise;
      row.filtered[k] = row.predicted[k] * row.density[k];
      row.factor += row.filtered[k];
    }
    if (!(row.factor > 0) || !std::isfinite(row.factor)) return false;
    for (double& each : row.filtered) each /= row.factor;
  }
  return true;
}

void HiddenPath::slopes(std::span<double> slope) {
  static thread_local std::vector<double> after, before, meets;
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
    const int low = i > 0 ? rows_[i - 1].low : 0, high = i > 0 ? rows_[i - 1].high : 0;
    const int lags = static_cast<int>(row.lag.size());
    before.assign(static_cast<std::size_t>(high - low + 1), 0.0);
    meets.assign(row.lag.size(), 0.0);
    for (int j = low; j <= high; ++j) {
      const double share = i > 0 ? rows_[i - 1].filtered[static_cast<std::size_t>(j - low)] : 1.0;
      const int from = std::max(row.low, j + row.first_lag);
      const int to = std::min(row.high, j + row.first_lag + lags - 1);
      if (to < from) continue;
      const std::size_t shift = static_cast<std::size_t>(from - j - row.first_lag);
      const double* lag = row.lag.data() + shift;
      const double* behind = after.data() + (from - row.low);
      double sum = 0;
      for (int k = 0; k <= to - from; ++k) {
        sum += lag[k] * behind[k];
        meets[shift + static_cast<std::size_t>(k)] += share * behind[k];
      }
      before[static_cast<std::size_t>(j - low)] = sum;
    }
    if (!row.still()) {
      double w[stencil], by_mean = 0, by_scale = 0;
      for (std::size_t q = 0; q < row.nodes.x.size(); ++q) {
        const double* at = &meets[place_of(row, row.nodes.x[q], w)];
        double met = 0;
        for (int k = 0; k < stencil; ++k) met += w[k] * at[k];
        by_mean += row.nodes.by_mean[q] * met;
        by_scale += row.nodes.by_scale[q] * met;
      }
      slope[i] += by_mean;
      if (i > 0) slope[i - 1] -= by_mean;
      slope[count_ + i] = by_scale;
    }
    std::swap(after, before);
  }
}

HiddenPath& mine() {
  static thread_local HiddenPath path;
  return path;
}

}  // namespace

void hidden_terms(const ProcessForm& form, const ProcessRows& rows, std::span<double> value,
                  std::span<double> slope) {
  HiddenPath& path = mine();
  if (!path.filter(form, rows)) {
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
  double first = 0, second = 0;
  for (int k = 0; k < last.size(); ++k) {
    const double x = (last.low + k) * path.h_, share = last.filtered[static_cast<std::size_t>(k)];
    first += share * x;
    second += share * x * x;
  }
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
    const int low = i > 0 ? path.rows_[i - 1].low : 0, high = i > 0 ? path.rows_[i - 1].high : 0;
    // All steps that do not end far beyond the reading.
    path.lay_step(row, 0, row.high - low);
    double below = 0;
    for (int j = low; j <= high; ++j) {
      const double share =
          i > 0 ? path.rows_[i - 1].filtered[static_cast<std::size_t>(j - low)] : 1;
      if (std::abs(share) < 1e-12) continue;
      double sum = 0;
      for (std::size_t k = 0; k < row.lag.size(); ++k) {
        const double x = (j + row.first_lag + static_cast<int>(k)) * path.h_;
        if (row.lag[k] != 0) sum += row.lag[k] * normal_cdf((row.reading - x) / row.noise);
      }
      below += share * sum;
    }
    below = std::clamp(below, 1e-300, 1 - 1e-16);
    const double z = normal_score(std::log(below), std::log1p(-below));
    scores[i] = {z, z};
  }
}

}  // namespace wearwell::ownlaw
