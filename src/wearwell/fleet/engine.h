#pragma once

#include <functional>
#include <string>
#include <vector>

#include "wearwell/base/error.h"
#include "wearwell/base/monitor.h"
#include "wearwell/fleet/dialect.h"

namespace wearwell::fleet {

/// One row of an answer: its texts and its numbers, in the order of the query.
struct Row {
  std::vector<std::string> texts;
  std::vector<double> numbers;  ///< NaN if missing
};

/// A column of a table, and whether it is numeric.
struct EngineColumn {
  std::string name;
  bool is_number = false;
  bool is_real = false;                   ///< may have a fraction
  bool is_date = false, is_time = false;  ///< a date; a timestamp
  /// Of numbers that are read as text, in a table with invalid cells: their decimal mark. 0: typed.
  char text_decimal = 0;
};

/// A server, or one behind it, was lost during the work. After another `begin` all of it may be
/// repeated, perhaps by a replica.
struct Lost : InputError {
  using InputError::InputError;
};

/// A database with a fleet's cycles. All functions throw InputError with the engine's message, and
/// MachineError if memory or disk is the cause; an answer is complete or there is none.
class Engine {
 public:
  virtual ~Engine() = default;
  virtual Dialect dialect() const = 0;
  virtual std::string description() const = 0;  ///< "DuckDB 1.4.4"
  /// The name of the table of cycles in queries.
  virtual std::string table() const = 0;
  /// Its name in messages.
  virtual std::string source() const = 0;
  /// The layout of its text files ("semicolons, decimal comma"); empty if it needs no mention.
  virtual std::string layout() const { return ""; }
  virtual std::vector<EngineColumn> columns() = 0;
  /// The following work is atomic and sees the table as it is now; without `commit` it is undone.
  /// ClickHouse has no transactions: there, uncommitted data belongs into temporary tables, which
  /// the next `begin` discards.
  virtual void begin() = 0;
  virtual void commit() = 0;
  /// Throws if the rows of one unit are divided between parts of the table. `unit`: the column that
  /// names units.
  virtual void refuse_split_units(const std::string& /*unit*/) {}
  /// Statements, one after the other, without an answer. `what`: names of the steps for progress,
  /// of which there are `total`. Throws Cancelled.
  virtual void run(const std::string& statements, const Monitor& monitor, const std::string& what,
                   long long total) = 0;
  /// The rows of a query: the first `texts` columns as text, the others as numbers. After
  /// `begin`.
  virtual void rows(const std::string& query, std::size_t texts,
                    const std::function<void(const Row&)>& take) = 0;
};

}  // namespace wearwell::fleet
