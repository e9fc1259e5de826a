#pragma once

#include <string>

#include "plan/grid_posterior.h"

namespace wearwell::plan {

/// A Weibull study of the lives of six parts, in hours.
inline Source lives_source() {
  Source source{{"life.toml", R"(title = "Lives"
model = "formula"
[data]
file = "lives.csv"
[data.columns]
life = { column = "hours", unit = "h" }
[likelihood.life]
family = "weibull"
scale = "size"
shape = "slope"
[prior]
size = { distribution = "lognormal", median = "100 h", log_sd = 1 }
slope = { distribution = "lognormal", median = 2, log_sd = 0.5 }
[predict]
b_lives = [10]
)"}};
  source.tables["lives.csv"] =
      table_of("lives.csv", {numbers_column("hours", {61, 80, 95, 110, 130, 150})});
  return source;
}

}  // namespace wearwell::plan
