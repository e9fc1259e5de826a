#pragma once

#include <memory>
#include <string>
#include <vector>

#include "wearwell/input/table.h"

namespace wearwell {

/// While it lives, `numbers_of` and `kinds_of` (column_values.h) read each column of this table once on its
/// thread: the readings of a table ask for the same columns again and again. The table stays as it is, at
/// its address.
class TableScope {
 public:
  explicit TableScope(const Table& table);
  ~TableScope();
  TableScope(const TableScope&) = delete;
  TableScope& operator=(const TableScope&) = delete;

 private:
  struct Known;
  friend std::shared_ptr<const std::vector<double>> shared_numbers(const Table&, const Column&);
  friend std::shared_ptr<const std::vector<std::string>> shared_kinds(const Table&, const Column&);
  static thread_local TableScope* current_;
  static Known* known_of(const Table& table);

  const Table& table_;
  TableScope* before_;
  std::unique_ptr<Known> known_;
};

/// `numbers_of` without a copy.
std::shared_ptr<const std::vector<double>> shared_numbers(const Table& table, const Column& column);
/// `kinds_of` without a copy.
std::shared_ptr<const std::vector<std::string>> shared_kinds(const Table& table,
                                                             const Column& column);

}  // namespace wearwell
