#include "wearwell/models/fatigue/tolerance.h"

#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/non_central_t.hpp>
#include <boost/math/distributions/normal.hpp>
#include <cmath>

namespace wearwell::fatigue {

FittedLine fit_line(const std::vector<double>& x, const std::vector<double>& y) {
  FittedLine line;
  line.n = static_cast<double>(x.size());
  double mean_y = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.mean_x += x[i] / line.n;
    mean_y += y[i] / line.n;
  }
  double sum_xy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    line.sum_xx += (x[i] - line.mean_x) * (x[i] - line.mean_x);
    sum_xy += (x[i] - line.mean_x) * (y[i] - mean_y);
  }
  line.slope = sum_xy / line.sum_xx;
  line.intercept = mean_y - line.slope * line.mean_x;
  double rest = 0;
  for (std::size_t i = 0; i < x.size(); ++i) rest += std::pow(y[i] - line.at(x[i]), 2);
  line.sd = std::sqrt(rest / line.freedom());
  return line;
}

double owen_factor(double reliability, double confidence, double leverage, double freedom) {
  const double z = boost::math::quantile(boost::math::normal(), reliability);
  const boost::math::non_central_t law(freedom, z / std::sqrt(leverage));
  return boost::math::quantile(law, confidence) * std::sqrt(leverage);
}

double owen_limit(const FittedLine& line, double x, double reliability, double confidence) {
  return line.at(x) -
         owen_factor(reliability, confidence, line.leverage(x), line.freedom()) * line.sd;
}

double iso_12107_limit(const FittedLine& line, double x, double reliability, double confidence) {
  const double k = owen_factor(reliability, confidence, 1 / (line.freedom() + 1), line.freedom());
  return line.at(x) - k * line.sd * std::sqrt(1 + line.leverage(x));
}

double astm_e739_band(const FittedLine& line, double x, double confidence) {
  const boost::math::fisher_f law(2, line.freedom());
  return line.at(x) -
         std::sqrt(2 * boost::math::quantile(law, confidence) * line.leverage(x)) * line.sd;
}

}  // namespace wearwell::fatigue
