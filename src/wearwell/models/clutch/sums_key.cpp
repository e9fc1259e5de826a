#include "wearwell/models/clutch/sums_key.h"

#include <fmt/format.h>

#include "wearwell/base/sha1.h"
#include "wearwell/models/clutch/sql_writer.h"

namespace wearwell::clutch {

std::string table_key(const std::string& model, const SqlSource& source) {
  return fmt::format("{}@{}#", model, source.table);
}

std::string columns_key(const SqlSource& source) {
  std::string text = source.unit.name + "\n" + source.cycle.name;
  const auto add = [&](const SqlColumn& each) {
    text += fmt::format("\n{} {:.17g} {:.17g}", each.name, each.scale, each.offset);
  };
  for (const SqlColumn& each : source.inputs) add(each);
  add(source.energy);
  return sha1_of(text).substr(0, 12);
}

std::string SqlWriter::others() const {
  const std::string of_table =
      table_key_.empty() ? ""
                         : fmt::format(" where substring(model, 1, {}) = {}", table_key_.size(),
                                       fleet::literal(dialect_, table_key_));
  return fmt::format(
      "select max(model) as other, {} as others from {}{} having count(*) > 0 and "
      "max(case when model = {} then 1 else 0 end) = 0",
      fleet::real(dialect_, "count(distinct model)"), sums_table_, of_table, id_);
}

}  // namespace wearwell::clutch
