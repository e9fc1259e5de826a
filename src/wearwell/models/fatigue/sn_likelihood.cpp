#include "wearwell/models/fatigue/sn_likelihood.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "wearwell/math/constants.h"
#include "wearwell/math/dual.h"
#include "wearwell/models/fatigue/random_limit.h"
#include "wearwell/prob/normal.h"

namespace wearwell::fatigue {
namespace {

constexpr int max_parameters = 8;

// With at least this many tests equal ones are merged.
constexpr std::size_t tests_are_many = 2000;

class SnLikelihood final : public LogDensity {
 public:
  SnLikelihood(const SnLaw& law, LifeTests tests) : law_(law), tests_(std::move(tests)) {
    const bool logarithmic = law_.logarithmic();
    for (const LifeTest& test : tests_) {
      Row row{std::log10(test.stress.alternating), test.life, test.until, 0};
      if (logarithmic) {
        row.at = std::log10(test.life);
        row.until = std::log10(test.until);
        // From the density of log10 life to that of life.
        row.log_measure = -std::log(test.life * std::log(10.0));
      }
      rows_.push_back(row);
    }
    // An integral over the limit is worth the search; without one a short sum keeps its order.
    const bool many = tests_.size() >= tests_are_many;
    const bool summed = many && law_.straight() && law_.standard() == StandardDistribution::normal;
    std::map<std::array<double, 5>, std::size_t> terms, levels;
    for (std::size_t i = 0; i < tests_.size(); ++i) {
      const LifeTest& test = tests_[i];
      if (summed && test.outcome == Outcome::failure) {
        const auto [level, first] =
            levels.try_emplace({test.stress.alternating, test.stress.mean}, levels_.size());
        if (first) levels_.push_back({i});
        levels_[level->second].add(rows_[i].at, test.count, rows_[i].log_measure);
        continue;
      }
      const auto [term, first] =
          terms.try_emplace({test.stress.alternating, test.stress.mean,
                             static_cast<double>(test.outcome), test.life, test.until},
                            terms_.size());
      if (first || !(many || law_.integrated())) {
        terms_.push_back({i, test.count});
      } else {
        terms_[term->second].count += test.count;
      }
    }
  }

  int dimension() const override { return law_.dimension(); }
  bool is_slow() const override { return law_.integrated(); }

  double value(std::span<const double> x) const override { return formula(x.data()); }

  // No density exceeds that of a life with known limit, no probability exceeds 1.
  double value_above(std::span<const double> x, double least) const override {
    if (!law_.integrated() || law_.scatter_grows) return value(x);
    const Shared<double> shared(law_, x.data());
    const double peak = (law_.standard() == StandardDistribution::normal ? -half_log_two_pi : -1) -
                        shared.log_sigma;
    const auto most = [&](const Term& each) {
      return tests_[each.row].outcome == Outcome::failure
                 ? each.count * (peak + rows_[each.row].log_measure)
                 : 0;
    };
    double rest = 0;
    for (const Term& each : terms_) rest += most(each);
    double sum = 0;
    for (const Term& each : terms_) {
      rest -= most(each);
      sum += each.count * term(shared, each.row, log10_reversed(shared, each.row));
      // Rounding of the sums is far below a hundredth.
      if (!(sum + rest > least - 0.01)) return -infinity;
    }
    return sum;
  }

  // The equivalent reversed stresses are constant, unless they depend on the axis.
  std::function<double(double)> along(std::span<const double> x, std::size_t axis) const override {
    if ((law_.has_strength() && axis == static_cast<std::size_t>(law_.strength_index())) ||
        (law_.has_gamma() && axis == static_cast<std::size_t>(law_.gamma_index())))
      return {};
    std::array<double, max_parameters> at{};
    std::copy(x.begin(), x.end(), at.begin());
    Shared<double> shared(law_, at.data());
    std::vector<double> reversed;
    for (const Term& term : terms_) reversed.push_back(log10_reversed(shared, term.row));
    for (const Level& level : levels_) reversed.push_back(log10_reversed(shared, level.row));
    return [this, at, axis, shared, reversed = std::move(reversed)](double value) mutable {
      at[axis] = value;
      shared.x = at.data();
      if (axis == static_cast<std::size_t>(law_.sigma_index())) shared.set_sigma(value);
      return sum(shared, [&](std::size_t i, std::size_t) { return reversed[i]; });
    };
  }

  double value_and_gradient(std::span<const double> x, std::span<double> gradient) const override {
    if (law_.integrated() && !law_.has_strength() && !law_.has_gamma()) return limited(x, gradient);
    return wearwell::value_and_gradient<max_parameters>(
        [this](const auto* p) { return formula(p); }, x, gradient);
  }

  std::vector<double> pointwise(std::span<const double> x) const override {
    const Shared<double> shared(law_, x.data());
    std::vector<double> terms;
    terms.reserve(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i)
      terms.push_back(term(shared, i, log10_reversed(shared, i)));
    return terms;
  }

  std::shared_ptr<const LogDensity> without(std::size_t term) const override {
    LifeTests others = tests_;
    if (--others[term].count == 0) others.erase(others.begin() + static_cast<std::ptrdiff_t>(term));
    return std::make_shared<SnLikelihood>(law_, std::move(others));
  }

  std::vector<int> pointwise_counts() const override {
    std::vector<int> counts;
    for (const LifeTest& test : tests_) counts.push_back(test.count);
    return counts;
  }

 private:
  struct Row {
    double log10_alternating;
    double at, until;  // on the scale on which lives scatter
    double log_measure;
  };

  // The term of tests with equal outcome under one stress: mainly runouts.
  struct Term {
    std::size_t row;
    int count;
  };

  // Failures under one stress: sufficient statistics of the normal distribution.
  struct Level {
    std::size_t row;                                           // of one of them
    double count = 0, mean = 0, squares = 0, log_measure = 0;  // sum of squares about the mean

    void add(double at, int times, double measure) {
      count += times;
      const double off = at - mean;
      mean += times * off / count;
      squares += times * off * (at - mean);
      log_measure += times * measure;
    }
  };

  // The parts common to all rows.
  template <class T>
  struct Shared {
    const T* x;
    T strength, gamma, inverse_sigma, log_sigma;

    Shared(const SnLaw& law, const T* parameters)
        : x(parameters), strength(law.strength_at(x)), gamma(law.gamma_at(x)) {
      set_sigma(x[law.sigma_index()]);
    }
    void set_sigma(const T& sigma) {
      using std::log;
      inverse_sigma = 1.0 / sigma;
      log_sigma = log(sigma);
    }
  };

  template <class T>
  T formula(const T* x) const {
    const Shared<T> shared(law_, x);
    return sum(shared, [&](std::size_t, std::size_t row) { return log10_reversed(shared, row); });
  }

  // Over terms, then levels; `reversed_of` gives log10 of the reversed stress by number and by row.
  template <class T, class Reversed>
  T sum(const Shared<T>& shared, const Reversed& reversed_of) const {
    T sum(0);
    std::size_t i = 0;
    for (const auto& [row, count] : terms_) {
      const T here = term(shared, row, reversed_of(i++, row));
      if (count == 1) {
        sum += here;
      } else {
        sum += static_cast<double>(count) * here;
      }
    }
    for (const Level& level : levels_) {
      const T reversed = reversed_of(i++, level.row);
      if (!std::isfinite(scalar(reversed))) return T(-std::numeric_limits<double>::infinity());
      sum += level.count * normal_log_density(level.mean, location_at(shared, reversed),
                                              shared.inverse_sigma, shared.log_sigma) +
             level.log_measure - 0.5 * level.squares * shared.inverse_sigma * shared.inverse_sigma;
    }
    return sum;
  }

  // With a random limit and a known mean-stress correction: derivatives without dual numbers.
  double limited(std::span<const double> x, std::span<double> gradient) const {
    const Shared<double> shared(law_, x.data());
    std::fill(gradient.begin(), gradient.end(), 0.0);
    double sum = 0;
    for (const auto& [row, count] : terms_) {
      const LifeTest& test = tests_[row];
      const double s = log10_reversed(shared, row);
      if (!std::isfinite(s)) return -std::numeric_limits<double>::infinity();
      const LimitedLife<double> life = limited_life(law_, x.data(), s);
      const LimitedLifeSlopes y =
          log_probability_and_slopes(life, test.outcome, rows_[row].at, rows_[row].until);
      sum += count * (y.value + (test.outcome == Outcome::failure ? rows_[row].log_measure : 0));
      gradient[0] += count * y.by_log10_a;
      gradient[1] += count * y.by_b;
      gradient[2] += count * y.by_sigma;
      gradient[3] += count * y.by_location;
      gradient[4] += count * y.by_scale;
    }
    return sum;
  }

  template <class T>
  T log10_reversed(const Shared<T>& shared, std::size_t i) const {
    return rows_[i].log10_alternating +
           log10_factor(law_.correction, tests_[i].stress, shared.strength, shared.gamma);
  }

  // On the scale on which lives scatter.
  template <class T>
  T location_at(const Shared<T>& shared, const T& reversed) const {
    using std::exp;
    const T location = law_.log10_life(shared.x, reversed);
    if (law_.logarithmic()) return location;
    constexpr double most = 300;  // decades; a longer life overflows
    return scalar(location) < most ? T(exp(location * std::log(10.0))) : T(1e300);
  }

  // The log-likelihood of one test of the row.
  template <class T>
  T term(const Shared<T>& shared, std::size_t i, const T& reversed) const {
    const LifeTest& test = tests_[i];
    const Row& row = rows_[i];
    if (!std::isfinite(scalar(reversed))) {
      return T(-std::numeric_limits<double>::infinity());
    }
    if (law_.integrated()) {
      const LimitedLife<T> life = limited_life(law_, shared.x, reversed);
      const T value = log_probability(life, test.outcome, row.at, row.until);
      return test.outcome == Outcome::failure ? T(value + row.log_measure) : value;
    }
    if (!law_.straight()) return bent(shared, i, reversed, law_.log10_life(shared.x, reversed));
    const T location = location_at(shared, reversed);
    const StandardDistribution standard = law_.standard();
    if (test.outcome == Outcome::failure && standard == StandardDistribution::normal) {
      return normal_log_density(row.at, location, shared.inverse_sigma, shared.log_sigma) +
             row.log_measure;
    }
    const T z = (row.at - location) * shared.inverse_sigma;
    switch (test.outcome) {
      case Outcome::failure:
        return log_density(standard, z) - shared.log_sigma + row.log_measure;
      case Outcome::runout:
        return log_survival(standard, z);
      case Outcome::left:
        return log_cdf(standard, z);
      case Outcome::interval:
        break;
    }
    const T until = (row.until - location) * shared.inverse_sigma;
    return log_between(standard, z, until);
  }

  // For a curved S-N line, or scatter that varies along it; and for a knee with a random limit:
  // life is finite for items whose limit is below the stress.
  template <class T>
  T bent(const Shared<T>& shared, std::size_t i, const T& reversed, const T& location) const {
    using std::log;
    const Row& row = rows_[i];
    const Outcome outcome = tests_[i].outcome;
    if (!std::isfinite(scalar(location))) {
      // Below a common limit life is infinite.
      return T(scalar(location) > 0 && outcome == Outcome::runout ? 0 : -infinity);
    }
    const StandardDistribution standard = law_.standard();
    const T sigma = law_.sigma_at(shared.x, location);
    const T z = (row.at - location) / sigma;
    T reached(0);  // log of the share of items whose limit is below the stress
    if (law_.limit) {
      const T w = law_.limit_place(shared.x, reversed);
      reached = log_cdf(*law_.limit, w);
      if (outcome == Outcome::runout) {
        const T safe = log_survival(*law_.limit, w), later = reached + log_survival(standard, z);
        const bool more = scalar(safe) > scalar(later);
        const T &larger = more ? safe : later, &smaller = more ? later : safe;
        if (scalar(smaller) < scalar(larger) - 700) return larger;
        return larger + log(1.0 + exp(smaller - larger));
      }
    }
    switch (outcome) {
      case Outcome::failure:
        return reached + log_density(standard, z) - log(sigma) + row.log_measure;
      case Outcome::runout:
        return log_survival(standard, z);
      case Outcome::left:
        return reached + log_cdf(standard, z);
      case Outcome::interval:
        break;
    }
    return reached + log_between(standard, z, T((row.until - location) / sigma));
  }

  SnLaw law_;
  LifeTests tests_;
  std::vector<Row> rows_;
  std::vector<Term> terms_;
  std::vector<Level> levels_;
};

}  // namespace

std::shared_ptr<const LogDensity> sn_likelihood(const SnLaw& law, const LifeTests& tests,
                                                std::size_t rows) {
  return std::make_shared<SnLikelihood>(
      law, LifeTests(tests.begin(), tests.begin() + static_cast<std::ptrdiff_t>(rows)));
}

}  // namespace wearwell::fatigue
