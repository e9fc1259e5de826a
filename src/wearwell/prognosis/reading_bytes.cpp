#include "wearwell/prognosis/reading_bytes.h"

namespace wearwell::prognosis {

void save(ByteWriter& to, const Reading& reading) {
  to.u64(reading.numbers.size());
  for (const double number : reading.numbers) to.number(number);
  to.u64(reading.labels.size());
  for (const std::string& label : reading.labels) to.text(label);
}

Reading read_reading(ByteReader& from, const Tracker& tracker) {
  Reading reading;
  reading.numbers.resize(from.count(sizeof(double)));
  for (double& number : reading.numbers) number = from.number();
  reading.labels.resize(from.count(sizeof(std::uint64_t)));
  for (std::string& label : reading.labels) label = from.text();
  if (reading.numbers.size() != tracker.columns().size() ||
      reading.labels.size() != tracker.labels().size())
    from.fail("a reading has other columns");
  return reading;
}

}  // namespace wearwell::prognosis
