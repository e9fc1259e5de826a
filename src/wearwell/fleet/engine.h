#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/fleet/dialect.h"

namespace wearwell::fleet {

/// One row of an answer: its texts and its numbers, in the order in which they were asked for.
struct Row {
  std::vector<std::string> texts;
  std::vector<double> numbers;  ///< NaN where there is none
};

/// A column of a table, and whether it holds numbers.
struct EngineColumn {
  std::string name;
  bool is_number = false;
  bool is_real = false;                   ///< a number with a fraction, perhaps
  bool is_date = false, is_time = false;  ///< a day; a moment of it
};

/// A server, or one behind it, went away in the middle of the work. After another `begin` all may be done anew, by a
/// replica perhaps.
struct Lost : InputError {
  using InputError::InputError;
};

/// A database with a fleet's cycles in it. Everything throws InputError with what the engine says, as
/// far as it is for people, and MachineError where memory or disk is at fault; an answer is whole or there is none.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual Dialect dialect() const = 0;
  virtual std::string description() const = 0;  ///< "DuckDB 1.4.4"
  /// What a query calls the table of cycles.
  virtual std::string table() const = 0;
  /// What people call it.
  virtual std::string source() const = 0;
  virtual std::vector<EngineColumn> columns() = 0;
  /// What follows is done whole or not at all, and sees the table as it is now; undone without `commit`.
  /// ClickHouse has nothing of the kind: what is not to be kept belongs into temporary tables there, which the next `begin`
  /// leaves behind.
  virtual void begin() = 0;
  virtual void commit() = 0;
  /// Throws where the table lies in parts that hold some of the rows of one unit each. `unit`: the column that names units.
  virtual void refuse_split_units(const std::string& /*unit*/) {}
  /// Statements, one after the other, without an answer. `what`: the steps that progress is told in,
  /// of which there are `total`. Throws Cancelled.
  virtual void run(const std::string& statements, const Monitor& monitor, const std::string& what,
                   long long total) = 0;
  /// The rows of a query: the first `texts` columns as text, the others as numbers. After
  /// `begin`.
  virtual void rows(const std::string& query, std::size_t texts,
                    const std::function<void(const Row&)>& take) = 0;
};

}  // namespace wearwell::fleet
