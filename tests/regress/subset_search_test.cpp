#include "wearwell/regress/subset_search.h"

#include <gtest/gtest.h>

#include <Eigen/QR>
#include <algorithm>
#include <bit>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/rng.h"
#include "wearwell/math/constants.h"
#include "wearwell/regress/terms.h"

namespace wearwell {
namespace {

struct Problem {
  Eigen::MatrixXd columns;
  Eigen::VectorXd response, weights;
  std::vector<int> forced;
};

/// Rows and terms drawn at random; a constant first; some columns dependent in one of several ways.
Problem random_problem(std::uint64_t seed, int most_terms) {
  Rng rng(seed, 0);
  const auto below = [&](int n) { return static_cast<int>(rng.uniform() * n); };
  const int terms = 2 + below(most_terms - 1), rows = terms + 3 + below(12);
  Problem problem{Eigen::MatrixXd(rows, terms), Eigen::VectorXd(rows), {}, {}};
  auto& x = problem.columns;
  for (double& value : x.reshaped()) value = rng.uniform();
  x.col(0).setOnes();
  if (seed % 2 == 0 && terms > 4) {  // linear dependence
    const int to = 2 + below(terms - 2), a = below(to), b = below(to);
    switch (below(4)) {
      case 0:
        x.col(to) = 3 * x.col(a);
        break;
      case 1:
        x.col(to) = x.col(a) - 2 * x.col(b);
        break;
      case 2:
        x.col(to).setConstant(0.3);
        break;
      case 3:
        x.col(to) = (x.col(1) + x.col(a)) / 2 + x.col(b);
        break;
    }
  }
  if (seed % 5 == 0) {  // a term that one row alone determines
    x.col(terms - 1).setZero();
    x(below(rows), terms - 1) = 1;
  }
  if (seed % 7 == 0) x.col(terms / 2).setZero();
  for (double& y : problem.response) y = 0.3 * rng.normal();
  for (int t = 0; t < terms; t += 2) problem.response += rng.uniform(-2, 2) * x.col(t);
  if (seed % 3 == 0) {
    problem.weights.resize(rows);
    for (double& w : problem.weights) w = rng.uniform(0.2, 4);
  }
  if (seed % 4 == 1) problem.forced = {below(terms)};
  return problem;
}

/// A least-squares fit written for this test: QR with pivoting on columns of unit length, rows
/// multiplied by the root of their weights. Empty when the columns are dependent.
std::optional<Eigen::VectorXd> solve(Eigen::MatrixXd x, const Eigen::VectorXd& y) {
  const Eigen::VectorXd lengths = x.colwise().norm();
  if (x.cols() > x.rows() || (lengths.array() == 0).any()) return {};
  x *= lengths.cwiseInverse().asDiagonal();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(1e-6);
  qr.compute(x);
  if (qr.rank() < x.cols()) return {};
  return qr.solve(y).cwiseQuotient(lengths);
}

struct Errors {
  double rss = 0, press = 0;
};

/// Refits the model, and refits it again without each row in turn.
std::optional<Errors> refit(const Problem& problem, const std::vector<int>& terms) {
  const Eigen::Index n = problem.columns.rows();
  Eigen::VectorXd root = Eigen::VectorXd::Ones(n);
  if (problem.weights.size() != 0) root = problem.weights.cwiseSqrt();
  const Eigen::MatrixXd x = root.asDiagonal() * problem.columns(Eigen::all, terms);
  const Eigen::VectorXd y = root.cwiseProduct(problem.response);
  const auto all = solve(x, y);
  if (!all) return {};
  Errors errors;
  errors.rss = (y - x * *all).squaredNorm();
  std::vector<Eigen::Index> others(n - 1);
  for (Eigen::Index out = 0; out < n; ++out) {
    for (Eigen::Index i = 0, j = 0; i < n; ++i) {
      if (i != out) others[j++] = i;
    }
    const auto without = solve(x(others, Eigen::all), y(others));
    errors.press += without ? std::pow(y[out] - x.row(out).dot(*without), 2) : infinity;
  }
  return errors;
}

struct Reference {
  std::vector<int> terms;
  TermSet set;
  Errors errors;
};

std::vector<Reference> refit_all(const Problem& problem) {
  TermSet forced = 0;
  for (const int term : problem.forced) forced |= bit(term);
  std::vector<Reference> all;
  for (TermSet set = 1; set < bit(static_cast<int>(problem.columns.cols())); ++set) {
    if ((set & forced) != forced) continue;
    const auto terms = terms_of(set);
    if (const auto errors = refit(problem, terms)) all.push_back({terms, set, *errors});
  }
  return all;
}

/// The criterion to minimize, from its textbook formula.
double criterion_of(Criterion criterion, const Problem& problem, const Errors& errors, int terms) {
  const auto n = static_cast<double>(problem.columns.rows()), k = static_cast<double>(terms);
  const double logs = problem.weights.size() == 0 ? 0 : problem.weights.array().log().sum();
  const double deviance = n * std::log(2 * M_PI * errors.rss / n) + n - logs;
  switch (criterion) {
    case Criterion::loo:
      return errors.press;
    case Criterion::aic:
      return deviance + 2 * (k + 1);
    case Criterion::aicc:
      return n - k - 2 > 0 ? deviance + 2 * (k + 1) * n / (n - k - 2) : infinity;
    case Criterion::bic:
      return deviance + std::log(n) * (k + 1);
    case Criterion::cp: {
      Eigen::MatrixXd x = problem.columns;
      Eigen::VectorXd y = problem.response;
      if (problem.weights.size() != 0) {
        x = problem.weights.cwiseSqrt().asDiagonal() * x;
        y = problem.weights.cwiseSqrt().cwiseProduct(y);
      }
      // The decomposition whose solve() leaves dependent columns out.
      Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> all;
      all.setThreshold(1e-6);
      all.compute(x);
      const double s2 =
          (y - x * all.solve(y)).squaredNorm() / (n - static_cast<double>(all.rank()));
      return errors.rss / s2 - n + 2 * k;
    }
    case Criterion::adjr2: {
      Eigen::VectorXd w = problem.weights;
      if (w.size() == 0) w.setOnes(problem.columns.rows());
      const double mean = w.dot(problem.response) / w.sum();
      const double tss = (w.array() * (problem.response.array() - mean).square()).sum();
      return -(1 - errors.rss / (n - k) / (tss / (n - 1)));
    }
  }
  return infinity;
}

struct Ranked {
  double value;
  std::vector<int> terms;
  TermSet set;
};

/// The order that the search promises: ties by fewer terms, then the first term that differs.
std::vector<Ranked> rank(Criterion criterion, const Problem& problem,
                         const std::vector<Reference>& all) {
  std::vector<Ranked> ranked;
  for (const auto& model : all) {
    const double value =
        criterion_of(criterion, problem, model.errors, static_cast<int>(model.terms.size()));
    if (value < infinity) ranked.push_back({value, model.terms, model.set});
  }
  std::sort(ranked.begin(), ranked.end(),
            [](const auto& a, const auto& b) { return a.value < b.value; });
  for (auto first = ranked.begin(); first != ranked.end();) {
    auto last = first;
    while (last != ranked.end() && last->value - first->value <= 1e-9 * std::abs(first->value))
      ++last;
    std::sort(first, last, [](const auto& a, const auto& b) {
      return std::pair(a.terms.size(), a.terms) < std::pair(b.terms.size(), b.terms);
    });
    first = last;
  }
  return ranked;
}

constexpr Criterion every_criterion[] = {Criterion::loo, Criterion::aic, Criterion::aicc,
                                         Criterion::bic, Criterion::cp,  Criterion::adjr2};

void expect_ranking(const SearchResult& result, const std::vector<Ranked>& expected, int keep,
                    double sign) {
  ASSERT_EQ(result.models.size(), std::min<std::size_t>(keep, expected.size()));
  for (std::size_t i = 0; i < result.models.size(); ++i) {
    EXPECT_EQ(result.models[i].terms, expected[i].terms) << "rank " << i;
    EXPECT_NEAR(sign * result.models[i].criterion, expected[i].value,
                1e-8 * (1 + std::abs(expected[i].value)));
  }
  EXPECT_TRUE(result.certified);
  EXPECT_EQ(result.lower_bound, result.models.front().criterion);
}

void expect_sizes(const SearchResult& result, const std::vector<Ranked>& expected, bool all) {
  std::vector<const Ranked*> best(result.by_size.size(), nullptr);
  for (const auto& model : expected) {
    auto& first = best[model.terms.size()];
    if (!first) first = &model;
  }
  for (std::size_t size = 0; size < best.size(); ++size) {
    const auto& found = result.by_size[size];
    EXPECT_TRUE(found.proven || !all) << "size " << size;
    if (!found.proven) continue;
    ASSERT_EQ(found.model.has_value(), best[size] != nullptr) << "size " << size;
    if (found.model) {
      EXPECT_EQ(found.model->terms, best[size]->terms);
    }
  }
}

/// 200 problems in shards, so that they run side by side.
class BruteForce : public testing::TestWithParam<int> {};

TEST_P(BruteForce, AgreesWithRefittingEveryModelWithoutEachRow) {
  for (int i = 0; i < 10; ++i) {
    const auto seed = static_cast<std::uint64_t>(10 * GetParam() + i);
    const Problem problem = random_problem(seed, 12);
    const auto all = refit_all(problem);
    for (const Criterion criterion : every_criterion) {
      SCOPED_TRACE(testing::Message() << "problem " << seed << ", " << name_of(criterion));
      const auto expected = rank(criterion, problem, all);
      const double sign = criterion == Criterion::adjr2 ? -1 : 1;
      SearchSettings settings;
      settings.criterion = criterion;
      settings.keep = 7;
      settings.forced = problem.forced;
      settings.threads = 1 + static_cast<int>(seed % 2);
      const auto search = [&] {
        return search_subsets(problem.columns, problem.response, problem.weights, settings);
      };
      if (expected.empty()) {  // a forced term that cannot be fitted
        EXPECT_THROW(search(), InputError);
        continue;
      }
      const auto bounded = search();
      expect_ranking(bounded, expected, settings.keep, sign);
      expect_sizes(bounded, expected, false);
      settings.prove_sizes = true;
      const auto by_size = search();
      expect_ranking(by_size, expected, settings.keep, sign);
      expect_sizes(by_size, expected, true);
      settings.cloud = CloudKind::points;
      const auto exhaustive = search();
      expect_ranking(exhaustive, expected, settings.keep, sign);
      expect_sizes(exhaustive, expected, true);
      EXPECT_EQ(exhaustive.cloud.models, static_cast<double>(all.size()));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Problems, BruteForce, testing::Range(0, 20));

/// A cubic in `inputs` random inputs, some of its terms true.
Problem cubic_problem(std::uint64_t seed, int inputs, int rows) {
  Rng rng(seed, 1);
  std::vector<std::string> names;
  for (int i = 0; i < inputs; ++i) names.push_back(std::string(1, static_cast<char>('a' + i)));
  Eigen::MatrixXd values(rows, inputs);
  for (double& value : values.reshaped()) value = rng.uniform(1, 3);
  Problem problem{
      make_design(polynomial_terms(names, 3), values).columns, Eigen::VectorXd::Zero(rows), {}, {}};
  for (int t = 0; t < problem.columns.cols(); t += 3)
    problem.response += rng.uniform(-2, 2) * problem.columns.col(t);
  for (double& y : problem.response) y += 0.2 * rng.normal();
  return problem;
}

SearchResult search(const Problem& problem, const SearchSettings& settings) {
  return search_subsets(problem.columns, problem.response, problem.weights, settings);
}

TEST(SubsetSearch, BoundsAgreeWithLookingAtEveryModel) {
  const auto problem = cubic_problem(1, 3, 60);  // 20 terms: 2^20 - 1 models
  for (const Criterion criterion : {Criterion::loo, Criterion::bic}) {
    SearchSettings settings;
    settings.criterion = criterion;
    settings.keep = 50;
    settings.prove_sizes = true;
    const auto bounded = search(problem, settings);
    settings.cloud = CloudKind::bins;
    const auto exhaustive = search(problem, settings);
    EXPECT_EQ(exhaustive.cloud.models, 1048575);
    EXPECT_LT(bounded.nodes, 200'000);
    ASSERT_EQ(bounded.models.size(), 50);
    for (int i = 0; i < 50; ++i) {
      EXPECT_EQ(bounded.models[i].terms, exhaustive.models[i].terms) << i;
      EXPECT_EQ(bounded.models[i].criterion, exhaustive.models[i].criterion) << i;
    }
    for (int size = 1; size <= 20; ++size) {
      EXPECT_TRUE(bounded.by_size[size].proven);
      EXPECT_EQ(bounded.by_size[size].model->terms, exhaustive.by_size[size].model->terms) << size;
    }
  }
}

TEST(SubsetSearch, TheSameWhateverTheThreads) {
  const auto problem = cubic_problem(2, 4, 90);
  for (const Criterion criterion : {Criterion::loo, Criterion::aic}) {
    SearchSettings settings;
    settings.criterion = criterion;
    settings.near = criterion == Criterion::loo ? 0.01 : 1;
    settings.seconds = infinity;
    SCOPED_TRACE(name_of(criterion));
    settings.threads = 1;
    const auto one = search(problem, settings);
    ASSERT_TRUE(one.certified);
    for (const int threads : {2, 0}) {
      settings.threads = threads;
      const auto many = search(problem, settings);
      ASSERT_EQ(many.models.size(), one.models.size());
      for (std::size_t i = 0; i < one.models.size(); ++i) {
        EXPECT_EQ(many.models[i].terms, one.models[i].terms);
        EXPECT_EQ(many.models[i].criterion, one.models[i].criterion);
      }
      for (std::size_t size = 0; size < one.by_size.size(); ++size) {
        EXPECT_EQ(many.by_size[size].proven, one.by_size[size].proven);
        ASSERT_EQ(many.by_size[size].model.has_value(), one.by_size[size].model.has_value());
        if (one.by_size[size].model) {
          EXPECT_EQ(many.by_size[size].model->terms, one.by_size[size].model->terms);
        }
      }
    }
  }
}

TEST(SubsetSearch, CloudDoesNotDependOnThreads) {
  const auto problem = cubic_problem(3, 2, 40);  // 10 terms and 2^10 - 1 models
  SearchSettings settings;
  settings.cloud = CloudKind::points;
  settings.threads = 1;
  const auto one = search(problem, settings);
  settings.threads = 3;
  const auto three = search(problem, settings);
  ASSERT_EQ(one.cloud.points.size(), 1024);
  for (std::size_t i = 1; i < 1024; ++i) {
    EXPECT_EQ(one.cloud.points[i].r2, three.cloud.points[i].r2);
    EXPECT_EQ(one.cloud.points[i].r2p, three.cloud.points[i].r2p);
    const auto fit = fit_least_squares(problem.columns(Eigen::all, terms_of(i)), problem.response);
    EXPECT_NEAR(one.cloud.points[i].r2, fit.r2, 1e-6 * (1 + std::abs(fit.r2)));
    EXPECT_NEAR(one.cloud.points[i].r2p, fit.r2p, 1e-6 * (1 + std::abs(fit.r2p)));
  }
  for (int size = 1; size <= 10; ++size) {
    std::size_t count = 0, high = 0;
    for (const auto n : one.cloud.sizes[size].r2p) count += n;
    for (int bin = Cloud::bins / 2; bin < Cloud::bins; ++bin)
      high += one.cloud.sizes[size].r2p[bin];
    const std::size_t binomial[] = {1, 10, 45, 120, 210, 252, 210, 120, 45, 10, 1};
    EXPECT_EQ(count, binomial[size]);
    std::size_t high_points = 0;
    for (std::size_t i = 1; i < 1024; ++i)
      high_points += std::popcount(i) == size && one.cloud.points[i].r2p >= 0.5F;
    EXPECT_EQ(high, high_points);
  }
}

/// However early it is stopped, the optimum lies between its lower bound and its best.
TEST(SubsetSearch, StoppedEarlyItStatesAnHonestGap) {
  const auto problem = cubic_problem(4, 4, 80);
  for (const Criterion criterion : {Criterion::loo, Criterion::bic}) {
    SCOPED_TRACE(name_of(criterion));
    SearchSettings settings;
    settings.criterion = criterion;
    settings.threads = 2;
    const auto all = search(problem, settings);
    ASSERT_TRUE(all.certified);
    const double optimum = all.models.front().criterion;
    int stopped = 0;
    for (const double seconds : {0.0, 1e-3, 3e-3, 1e-2, 3e-2, 0.1}) {
      settings.seconds = seconds;
      const auto part = search(problem, settings);
      EXPECT_LE(part.lower_bound, optimum);
      EXPECT_GE(part.models.front().criterion, optimum);
      if (part.certified) {
        EXPECT_EQ(part.lower_bound, optimum);
      }
      for (const auto& of_size : part.by_size) {
        if (!of_size.proven) continue;
        EXPECT_TRUE(part.certified || of_size.model->criterion <= part.lower_bound);
      }
      stopped += !part.certified;
    }
    EXPECT_GE(stopped, 1);
    std::atomic<bool> stop = true;
    settings.seconds = infinity;
    settings.stop = &stop;
    const auto none = search(problem, settings);
    EXPECT_FALSE(none.certified);
    EXPECT_LT(none.lower_bound, optimum);
  }
}

TEST(SubsetSearch, StoppedCloudIsNotCertified) {
  const auto problem = cubic_problem(1, 3, 60);
  std::atomic<bool> stop = true;
  SearchSettings settings;
  settings.cloud = CloudKind::bins;
  settings.stop = &stop;
  const auto result = search(problem, settings);
  EXPECT_FALSE(result.certified);
  EXPECT_LT(result.cloud.models, 1000);
  EXPECT_LT(result.lower_bound, result.models.front().criterion);
}

TEST(SubsetSearch, NearTiesAreAllModelsWithinTheDistance) {
  const auto problem = cubic_problem(5, 2, 30);
  SearchSettings settings;
  settings.keep = 1023;
  const auto all = search(problem, settings);
  settings.keep = 3;
  settings.near = 0.1;
  const auto near = search(problem, settings);
  std::size_t expected = 0;
  for (const auto& model : all.models)
    expected += model.criterion <= 1.1 * all.models.front().criterion;
  ASSERT_GT(expected, 5);
  ASSERT_EQ(near.models.size(), expected);
  for (std::size_t i = 0; i < expected; ++i) EXPECT_EQ(near.models[i].terms, all.models[i].terms);
  EXPECT_FALSE(near.truncated);
  settings.near_most = 4;
  const auto few = search(problem, settings);
  EXPECT_TRUE(few.truncated);
  ASSERT_EQ(few.models.size(), 4);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(few.models[i].terms, all.models[i].terms);
}

// Without noise every model that holds the true terms fits exactly: ties, won by the smallest.
TEST(SubsetSearch, ExactFitsAreTiesWonByFewestTerms) {
  auto problem = cubic_problem(6, 3, 40);
  problem.response =
      2 * problem.columns.col(3) - problem.columns.col(11) + 0.5 * problem.columns.col(0);
  for (const Criterion criterion : every_criterion) {
    if (criterion == Criterion::cp) continue;  // no residual variance to compare with
    SearchSettings settings;
    settings.criterion = criterion;
    settings.keep = 2;
    const auto result = search(problem, settings);
    EXPECT_EQ(result.models.front().terms, (std::vector<int>{0, 3, 11})) << name_of(criterion);
    EXPECT_TRUE(result.certified);
  }
}

// With a limit at or above the best PRESS the answer is the same, below it there is none, whatever
// the search begins with.
TEST(SubsetSearch, ModelsBeyondALimitAreOfNoInterest) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const Problem problem = random_problem(seed, 9);
    SearchSettings settings;
    settings.forced = problem.forced;
    settings.keep = 1;
    settings.threads = 1;
    const SearchResult all =
        search_subsets(problem.columns, problem.response, problem.weights, settings);
    const SubsetModel& best = all.models.front();
    settings.start = {static_cast<int>(seed) % static_cast<int>(problem.columns.cols())};
    for (const double factor : {1 + 1e-9, 1.01, 3.0}) {
      settings.press_at_most = factor * best.press;
      const SearchResult same =
          search_subsets(problem.columns, problem.response, problem.weights, settings);
      ASSERT_TRUE(same.certified);
      ASSERT_EQ(same.models.size(), 1u) << seed;
      EXPECT_EQ(same.models.front().terms, best.terms) << seed;
      EXPECT_EQ(same.models.front().press, best.press) << seed;
    }
    settings.press_at_most = 0.99 * best.press;
    const SearchResult none =
        search_subsets(problem.columns, problem.response, problem.weights, settings);
    EXPECT_TRUE(none.certified);
    EXPECT_TRUE(none.models.empty()) << seed;
  }
}

TEST(SubsetSearch, NamesWhatIsWrong) {
  const auto problem = cubic_problem(7, 2, 20);
  const auto message = [&](const Problem& wrong, const SearchSettings& settings) -> std::string {
    try {
      search(wrong, settings);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  SearchSettings settings;
  auto wrong = problem;
  wrong.response.setConstant(3);
  EXPECT_EQ(message(wrong, settings), "the response is the same in every row");
  wrong = problem;
  wrong.columns(4, 2) = NAN;
  EXPECT_EQ(message(wrong, settings), "row 5 has a value that is not a finite number");
  wrong = problem;
  wrong.weights = Eigen::VectorXd::Ones(20);
  wrong.weights[1] = -1;
  EXPECT_EQ(message(wrong, settings), "the weight in row 2 is -1; it must be positive");
  settings.forced = {10};
  EXPECT_EQ(message(problem, settings), "forced term 10 is not one of the 10 terms");
  settings.forced = {};
  settings.criterion = Criterion::cp;
  wrong = problem;
  wrong.columns = wrong.columns.topRows(9).eval();
  wrong.response = wrong.response.head(9).eval();
  EXPECT_EQ(message(wrong, settings), "cp needs more rows (9) than independent terms (9)");
  EXPECT_THROW(read_criterion("aik"), InputError);
}

/// Many rows of skew inputs, some nearly dependent, most terms without effect.
Problem many_rows(std::uint64_t seed) {
  constexpr int rows = 2600, terms = 9;
  Rng rng(seed, 9);
  Problem problem{Eigen::MatrixXd(rows, terms), Eigen::VectorXd(rows), {}, {}};
  auto& x = problem.columns;
  for (int i = 0; i < rows; ++i) {
    for (int t = 0; t < terms; ++t) x(i, t) = t == 0 ? 1 : std::exp(rng.normal());
    x(i, 5) = x(i, 4) + 1e-3 * rng.normal();
    x(i, 6) = x(i, 1) * x(i, 2);
    problem.response[i] = 2 + x(i, 1) - x(i, 4) + 0.05 * x(i, 7) + 3 * rng.normal();
  }
  if (seed % 2 == 0) x.col(8) = x.col(2) - x.col(3);
  if (seed % 3 == 0) {
    problem.weights.resize(rows);
    for (double& w : problem.weights) w = rng.uniform(0.2, 4);
  }
  return problem;
}

// Against every model fitted by itself (least_squares_test.cpp holds that against R).
TEST(SubsetSearch, OfManyRowsFindsTheBestOfAll) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    const Problem problem = many_rows(seed);
    std::vector<std::pair<double, std::vector<int>>> all;
    for (TermSet set = 1; set < bit(9); ++set) {
      const auto terms = terms_of(set);
      const Eigen::MatrixXd columns = problem.columns(Eigen::all, terms);
      if (!find_dependences(columns).empty()) continue;
      all.emplace_back(fit_least_squares(columns, problem.response, problem.weights).press, terms);
    }
    std::sort(all.begin(), all.end());
    SearchSettings settings;
    settings.keep = 12;
    const auto found = search_subsets(problem.columns, problem.response, problem.weights, settings);
    ASSERT_TRUE(found.certified);
    ASSERT_EQ(found.models.size(), 12u);
    for (std::size_t m = 0; m < 12; ++m) {
      // Dependent columns make ties.
      if (seed % 2 == 1) {
        EXPECT_EQ(found.models[m].terms, all[m].second) << seed << ' ' << m;
      }
      EXPECT_NEAR(found.models[m].criterion / all[m].first, 1, 1e-10);
    }
    EXPECT_LT(found.nodes, 400) << "bounds must cut: there are 511 models";
  }
}

// sum of e^2 (1 + 2 h) by the rows, and by their moments.
TEST(RowMoments, WeighResidualsByLeverages) {
  const Problem problem = many_rows(1);
  const SearchProblem search(problem.columns, problem.response, {}, Criterion::loo);
  ASSERT_FALSE(search.moments.empty());
  const std::vector<int> terms = {0, 1, 6};
  const auto fit = fit_least_squares(problem.columns(Eigen::all, terms), problem.response);
  const double expected = (fit.residuals.array().square() * (1 + 2 * fit.leverages.array())).sum();
  const auto dimension = search.moments.dimension();
  Eigen::MatrixXd weight = Eigen::MatrixXd::Identity(dimension, dimension);
  Eigen::VectorXd residuals = search.response.head(dimension);
  const Eigen::MatrixXd columns = search.columns(Eigen::all, terms).topRows(dimension);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(columns);
  const Eigen::MatrixXd q = qr.householderQ() * Eigen::MatrixXd::Identity(dimension, 3);
  for (int j = 0; j < 3; ++j) search.moments.add_leverage(q.col(j), weight);
  residuals -= q * (q.transpose() * residuals);
  EXPECT_NEAR(residuals.dot(weight * residuals) / expected, 1, 1e-12);
  EXPECT_LT(expected, fit.press);
}

}  // namespace
}  // namespace wearwell
