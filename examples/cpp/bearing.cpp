// The geometry of a worn journal bearing: a wear rate from a depth, and the life to another depth.
#include <wearwell/models/bearing/solve.h>

#include <cstdio>

int main() {
  using namespace wearwell::bearing;
  Bearing bearing;
  bearing.contact = Contact::stationary;
  bearing.radius = 20e-3;     // m
  bearing.clearance = 20e-6;  // m
  bearing.pressure = 1e6;     // Pa
  bearing.revolutions = 2e5;
  bearing.depth = 30e-6;  // m
  const double rate = solve(Quantity::rate, bearing).value;
  std::printf("k = %.4g m^3/(N m)\n", rate);

  bearing.rate = rate;
  bearing.depth = 60e-6;
  bearing.revolutions.reset();
  std::printf("worn to 60 um after %.6g revolutions\n",
              solve(Quantity::revolutions, bearing).value);
}
