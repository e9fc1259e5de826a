// A study whose table is in memory: fitted with progress and a way to stop, without a file being read or written.
#include <wearwell/models/registry.h>
#include <wearwell/study/model.h>

#include <cstdio>

namespace {

constexpr const char* study_text = R"toml(
model = "archard-joint"
[data]
file = "inspections"
[data.columns]
cycles = "cycles"
volume = { column = "volume", unit = "mm^3" }
[conditions]
work_per_cycle = "5.966 N m"
[likelihood]
family = "normal"
[prior]
k = { distribution = "flat", unit = "mm^3/(N m)" }
sigma = { distribution = "uniform", lower = "0 mm^3", upper = "15 mm^3" }
[predict]
cycles = [20585]
)toml";

}  // namespace

int main() {
  using namespace wearwell;
  Table table;
  table.source = "inspections";
  table.rows = 5;
  table.columns = {{"cycles", true, {1, 100, 1000, 5000, 10000}, {}},
                   {"volume", true, {4.44, 7.1, 12.2, 24.6, 45.31}, {}}};
  const Source source{{"memory", study_text}, {{"inspections", table}}};
  const auto study = read_study(source, all_models());
  std::printf("%s\n", study->description().c_str());

  std::stop_source stop;  // another thread may call stop.request_stop()
  const Monitor monitor{
      .progress =
          [](const Step& step) { std::fprintf(stderr, "%lld of %lld\r", step.done, step.total); },
      .stop = stop.get_token(),
      .threads = 2};
  RunOptions options;
  options.report = false;
  const Result result = study->run(options, monitor);
  std::printf("k = %s\n", result.body["parameters"]["k"]["mean"].dump().c_str());
  std::printf("trusted: %s\n", result.header.trusted ? "yes" : "no");

  stop.request_stop();
  try {
    study->run(options, monitor);
  } catch (const Cancelled& cancelled) {
    std::printf("%s\n", cancelled.what());
    return 0;
  }
  return 1;
}
