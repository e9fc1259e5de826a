#include "wearwell/regress/row_moments.h"

#include <algorithm>

namespace wearwell {
namespace {

using Index = Eigen::Index;

}  // namespace

RowMoments::RowMoments(Eigen::MatrixXd orthonormal) : basis(std::move(orthonormal)) {
  const Index n = basis.rows(), d = basis.cols(), pairs = d * (d + 1) / 2;
  if (n == 0) return;
  constexpr Index block = 256;
  fourth.setZero(pairs, pairs);
  Eigen::MatrixXd products(pairs, block);
  for (Index first = 0; first < n; first += block) {
    const Index count = std::min(block, n - first);
    for (Index i = 0; i < count; ++i) {
      double* product = products.col(i).data();
      const auto row = basis.row(first + i);
      for (Index a = 0; a < d; ++a) {
        for (Index b = a; b < d; ++b) *product++ = row[a] * row[b];
      }
    }
    fourth.selfadjointView<Eigen::Lower>().rankUpdate(products.leftCols(count));
  }
  fourth.triangularView<Eigen::StrictlyUpper>() = fourth.transpose();
}

void RowMoments::add_leverage(const Eigen::VectorXd& column, Eigen::MatrixXd& weight) const {
  const Index d = dimension();
  Eigen::VectorXd products(fourth.rows());
  Index pair = 0;
  for (Index a = 0; a < d; ++a) {
    for (Index b = a; b < d; ++b) products[pair++] = (a == b ? 2 : 4) * column[a] * column[b];
  }
  const Eigen::VectorXd added = fourth * products;
  pair = 0;
  for (Index a = 0; a < d; ++a) {
    weight(a, a) += added[pair++];
    for (Index b = a + 1; b < d; ++b, ++pair) {
      weight(a, b) += added[pair];
      weight(b, a) += added[pair];
    }
  }
}

}  // namespace wearwell
