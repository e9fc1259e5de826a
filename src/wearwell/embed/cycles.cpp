#include "wearwell/embed/cycles.h"

#include "wearwell/base/error.h"
#include "wearwell/models/clutch/clutch_model_file.h"
#include "wearwell/models/clutch/clutch_predict.h"
#include "wearwell/models/clutch/cycle_table.h"

namespace wearwell::embed {

PlateCycles::PlateCycles(const std::string& model, bool scatter_only, bool skip_not_finite)
    : model_(clutch::read_model(model)),
      sum_(model_, !scatter_only,
           skip_not_finite ? clutch::NotFinite::skip : clutch::NotFinite::refuse) {}

std::size_t PlateCycles::add(const Table& table) {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> names = names_;
  const clutch::CycleColumns cycles = clutch::cycle_columns(table, names);
  const bool named = !table.column("plate").is_number;
  if (any_ && named != named_) {
    throw InputError(table.source + ": plates are " + (named ? "names" : "numbers") +
                     " here, but not before");
  }
  clutch::CycleSum::Rates rates;
  sum_.rates(cycles, rates);
  const std::vector<clutch::PlateWear> before = sum_.plates();
  if (named) sum_.name_plates(names);
  try {
    sum_.add(cycles, rates);
  } catch (const InputError& error) {
    sum_.restore(before);
    throw InputError(table.source + ", " + error.what());
  }
  any_ = true;
  named_ = named;
  names_ = std::move(names);
  return table.rows;
}

std::size_t PlateCycles::add_file(const std::string& file) {
  const std::lock_guard lock(mutex_);
  const std::vector<clutch::PlateWear> before = sum_.plates();
  try {
    return clutch::sum_cycles(file, sum_);
  } catch (...) {
    sum_.restore(before);
    throw;
  }
}

nlohmann::ordered_json PlateCycles::json() const {
  const std::lock_guard lock(mutex_);
  return wear_json(model_, sum_, sum_.with_replicates());
}

}  // namespace wearwell::embed
