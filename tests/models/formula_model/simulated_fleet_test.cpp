#include "wearwell/models/formula_model/simulated_fleet.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <tuple>
#include <vector>

namespace wearwell::formula_model {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream in(PROJECT_SOURCE_DIR "/" + file);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

TEST(SimulatedFleet, IsTheExampleThatIsShipped) {
  EXPECT_EQ(learned_csv(simulate_fleet(1, 200)), content_of("examples/fleet/learned.csv"));
}

TEST(SimulatedFleet, IsAsItSays) {
  const SimulatedFleet fleet = simulate_fleet(3, 300);
  double sum = 0, square = 0;
  for (const SimulatedMachine& each : fleet.machines) {
    EXPECT_NEAR(each.life * each.rate, wear_limit, 1e-9);
    const double log_rate = std::log(each.rate / median_rate);
    sum += log_rate;
    square += log_rate * log_rate;
  }
  EXPECT_NEAR(sum / 300, 0, 4 * rate_scatter / std::sqrt(300));
  EXPECT_NEAR(std::sqrt(square / 300), rate_scatter, 4 * rate_scatter / std::sqrt(600));
  std::set<std::tuple<std::size_t, double, double>> known;
  std::size_t repeated = 0, late = 0;
  std::vector<double> farthest(300, 0);
  double noise = 0;
  for (const SimulatedReading& each : fleet.readings) {
    const SimulatedMachine& machine = fleet.machines[each.machine];
    EXPECT_LT(each.use, machine.life + 0.1);
    repeated += !known.emplace(each.machine, each.use, each.wear).second;
    late += each.use < farthest[each.machine];
    farthest[each.machine] = std::max(farthest[each.machine], each.use);
    noise += std::pow(each.wear - machine.rate * each.use, 2);
  }
  EXPECT_NEAR(std::sqrt(noise / static_cast<double>(fleet.readings.size())), reading_error, 0.1);
  EXPECT_GT(repeated, fleet.readings.size() / 100);
  EXPECT_GT(late, fleet.readings.size() / 100);
  // Machines of a larger fleet are those of a smaller one.
  EXPECT_EQ(simulate_fleet(3, 5).machines[4].rate, fleet.machines[4].rate);
}

}  // namespace
}  // namespace wearwell::formula_model
