#include "wearwell/models/ownlaw/own_asked.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

namespace wearwell::ownlaw {

Asked::Asked(const TomlReader& table, std::shared_ptr<const OwnLaw> own_law,
             std::shared_ptr<const OwnRows> own_rows)
    : predict(table), law(std::move(own_law)), rows(std::move(own_rows)) {
  if (const auto conditions = predict.table("given")) given = read_conditions(*conditions, *law);
  common = common_conditions(*law, given);
  noun = law->label.value_or(law->symbols.labels.size() == 1 ? law->symbols.labels.front().name
                                                             : std::string("unit"));
  for (const Parameter& each : law->parameters) start.push_back(each.start);
}

std::string Asked::unit(std::size_t u) const {
  return law->units[u].empty() ? noun : noun + " " + law->units[u];
}

double Asked::last_place(std::size_t u) const {
  double last = -std::numeric_limits<double>::infinity();
  for (std::size_t row = 0; row < law->data.table.rows; ++row) {
    if (law->unit_of_row[row] == u) last = std::max(last, axis().values[row]);
  }
  return last;
}

std::string in_words(const Quantity& quantity) {
  return quantity.unit.text == "1" ? fmt::format("{:.6g}", quantity.value)
                                   : fmt::format("{:.6g} {}", quantity.value, quantity.unit.text);
}

std::string joined(const std::string& a, const std::string& b) {
  return a.empty() ? b : b.empty() ? a : a + ", " + b;
}

QuantityRequest request(const std::string& name, const std::string& of, const std::string& at,
                        const Unit& unit) {
  return {name, of, at, unit, true, false, {}, {}, {}};
}

}  // namespace wearwell::ownlaw
