// The best terms of a regression among all submodels, with a proof.
#include <wearwell/regress/selection.h>

#include <cstdio>

int main() {
  using namespace wearwell;
  Eigen::MatrixXd inputs(24, 2);
  Eigen::VectorXd response(24);
  for (int i = 0; i < 24; ++i) {
    const double a = i % 6, b = i / 6;
    inputs.row(i) << a, b;
    response[i] = 3 + 2 * a - 0.5 * a * b + 0.01 * ((7 * i) % 5 - 2);
  }
  const Design design = make_design(polynomial_terms({"a", "b"}, 2), inputs);
  const Selection selection = select_terms(design, response, {}, {});
  const SubsetModel& best = selection.search.models.front();
  for (const int term : best.terms)
    std::printf("%s ", design.terms[static_cast<std::size_t>(term)].name.c_str());
  std::printf("(%s, R2p %.4f)\n", selection.search.certified ? "proven" : "not proven", best.r2p);
}
