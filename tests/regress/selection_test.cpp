#include "wearwell/regress/selection.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "wearwell/base/rng.h"

namespace wearwell {
namespace {

struct Data {
  Design design;
  Eigen::VectorXd response;
};

/// A quadratic in two inputs with noise; true terms: 1, a, a*b.
Data quadratic() {
  Rng rng(3, 0);
  Eigen::MatrixXd inputs(40, 2);
  for (double& x : inputs.reshaped()) x = rng.uniform(1, 5);
  Data data{make_design(polynomial_terms({"a", "b"}, 2), inputs), Eigen::VectorXd(40)};
  for (int i = 0; i < 40; ++i)
    data.response[i] = 2 + 3 * inputs(i, 0) - inputs(i, 0) * inputs(i, 1) + 0.5 * rng.normal();
  return data;
}

TEST(Selection, DescribesTheBestModelAndItsRivals) {
  const auto data = quadratic();
  SelectionSettings settings;
  settings.search.keep = 5;
  settings.search.near = 0.1;
  settings.folds = 40;
  const auto selection = select_terms(data.design, data.response, {}, settings);
  const auto& models = selection.search.models;
  ASSERT_GE(models.size(), 5);
  EXPECT_DOUBLE_EQ(selection.fit.press, models.front().press);
  // Original units predict what the scaled ones do.
  const Eigen::VectorXd predicted =
      data.design.columns(Eigen::all, models.front().terms) * selection.fit.coefficients;
  Eigen::VectorXd again = Eigen::VectorXd::Constant(40, selection.original.intercept);
  for (std::size_t j = 0; j < models.front().terms.size(); ++j) {
    const int t = models.front().terms[j];
    const Eigen::VectorXd term =
        data.design.columns.col(t).array() * data.design.range[t] + data.design.minimum[t];
    again += selection.original.coefficients[static_cast<Eigen::Index>(j)] * term;
  }
  EXPECT_TRUE(predicted.isApprox(again, 1e-10));

  double sum = 0;
  for (const double weight : selection.weights) sum += weight;
  EXPECT_NEAR(sum, 1, 1e-12);
  for (std::size_t t = 0; t < selection.support.size(); ++t) {
    const auto holds = [&](const SubsetModel& model) {
      return std::count(model.terms.begin(), model.terms.end(), static_cast<int>(t)) > 0;
    };
    const auto count = std::count_if(models.begin(), models.end(), holds);
    EXPECT_NEAR(selection.support[t].inclusion,
                static_cast<double>(count) / static_cast<double>(models.size()), 1e-12);
    double weight = 0;
    for (std::size_t m = 0; m < models.size(); ++m)
      weight += holds(models[m]) ? selection.weights[m] : 0;
    EXPECT_NEAR(selection.support[t].weight, weight, 1e-12);
  }
  // As many folds as rows: leave-one-out.
  ASSERT_EQ(selection.k_fold_press.size(), models.size());
  for (std::size_t m = 0; m < models.size(); ++m)
    EXPECT_NEAR(selection.k_fold_press[m], models[m].press, 1e-9 * models[m].press);
}

}  // namespace
}  // namespace wearwell
