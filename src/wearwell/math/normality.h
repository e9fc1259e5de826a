#pragma once

#include <cstdint>
#include <vector>

namespace wearwell {

struct KolmogorovTest {
  double distance = 0;  ///< largest between the empirical and the normal distribution function
  double p = 0;         ///< probability of a larger one under the null hypothesis
};

/// Kolmogorov-Smirnov test of values against N(0, 1). The p value is exact (Marsaglia, Tsang and
/// Wang 2003, J. Stat. Software 8(18)). `values` is not empty.
KolmogorovTest kolmogorov_test(std::vector<double> values);

/// The same distance after the values are standardized by their own mean and standard deviation
/// (Lilliefors 1967); its p value is the share of 10,000 normal samples with a larger one, so it
/// has a standard error of up to 0.005. At least four values that are not all the same.
KolmogorovTest lilliefors_test(std::vector<double> values, std::uint64_t seed = 1);

struct AndersonDarlingTest {
  double statistic =
      0;  ///< A^2 of the values, standardized by their own mean and standard deviation
  double p = 1;
};

/// Anderson-Darling test of normality with estimated mean and standard deviation (Stephens 1974, JASA 69, 730-737);
/// the p value is that of D'Agostino and Stephens (1986), Goodness-of-Fit Techniques, table 4.9.
/// Equal values are spread evenly over half the distance to their neighbours, so that rounding does
/// not look like non-normality. p is 1 for fewer than five values and for constant values.
AndersonDarlingTest anderson_darling_test(std::vector<double> values);

struct ShapiroWilkTest {
  double statistic = 1;  ///< W
  double score = 0;      ///< standard normal under the null hypothesis; large for non-normal values
  double p = 1;
};

/// The most values that Royston's approximation of the p value covers.
inline constexpr std::size_t most_shapiro_wilk = 5000;

/// Shapiro-Wilk test of normality, with Royston's approximation of its coefficients and p value
/// (1995, Applied Statistics 44, 547-551, algorithm AS R94). Equal values are spread as for
/// `anderson_darling_test`. p is 1 for fewer than five values and for constant values; at most
/// `most_shapiro_wilk` values.
ShapiroWilkTest shapiro_wilk_test(std::vector<double> values);

/// Points of a normal probability plot: values in ascending order against the normal quantiles of
/// (i - 1/2)/n.
struct NormalPlot {
  std::vector<double> quantile, value;
};
NormalPlot normal_plot(std::vector<double> values);

/// P(D_n < d) of the two-sided Kolmogorov statistic of n values.
double kolmogorov_cdf(int n, double d);

}  // namespace wearwell
