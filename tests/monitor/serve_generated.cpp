// Serves generated machines, for the tests in a browser:
//
//   serve_generated UNITS MILLISECONDS [TOKEN]     prints its address, ends with its standard input
//
// Every so many milliseconds one machine reports; 0: only when a line on the standard input says so.

#include <chrono>
#include <cstdlib>
#include <iostream>
#include <thread>

#include "monitor/generated_fleet.h"
#include "wearwell/monitor/http_server.h"

int main(int argc, char** argv) {
  using namespace wearwell::monitor;
  if (argc < 3) return 2;
  GeneratedFleet fleet(std::strtoul(argv[1], nullptr, 10));
  wearwell::HttpSettings settings;
  settings.port = 0;
  if (argc > 3) settings.token = argv[3];
  HttpServer server(settings, fleet, &fleet);
  std::cout << server.address() << std::endl;
  const int pause = std::atoi(argv[2]);
  std::jthread reports([&](const std::stop_token& stop) {
    while (pause > 0 && !stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(pause));
      fleet.advance();
    }
  });
  for (std::string line; std::getline(std::cin, line);) fleet.advance(std::atoi(line.c_str()));
}
