#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/formula/by_row_degree.h"
#include "wearwell/formula/symbols.h"

namespace wearwell::formula {

/// A line of the study's table [formula]: `name` is a name ("wear"), a rate
/// ("d(depth)/d(distance)") or a state's value at the beginning ("depth(0)"; 0 without one).
struct Line {
  std::string name;
  std::string text;
};

/// A requested expression: a parameter of a family, a limit, a quantity.
struct Wanted {
  std::string name;  ///< its position in messages: "[likelihood.depth] mean"
  std::string text;
  std::optional<Powers> powers = {};  ///< required dimension; any if empty
  std::string because = {};           ///< the source of that dimension: "the column 'depth'"
  bool uniform = false;               ///< whether it must be a function of parameters, without
                                      ///< columns
};

struct Output {
  std::string name;
  Powers powers;
  bool uniform = false;     ///< the same for all rows: one value, one adjoint
  bool parametric = false;  ///< depends on parameters
  bool by_path = false;     ///< depends on a path (cum, a state), that is, on previous rows
};

/// The caller's rows. For paths (cum, states) the rows of one path are adjacent and sorted along
/// the axis; a path begins at each entry of `paths` (ascending, the first 0). Without entries all
/// rows are one path.
struct Rows {
  std::size_t count = 0;
  std::vector<std::span<const double>> columns;  ///< as Symbols::columns; empty if not used
  std::vector<std::span<const int>> labels;      ///< as Symbols::labels; empty if not used
  std::vector<std::size_t> paths = {};
  /// The beginning of each path on the axis, by row (the first row of the path counts); replaces
  /// the one in the formula.
  std::vector<double> from = {};
  /// The number of equal rows (possibly fractional) that each row represents in the running sums
  /// (`cum`) of a continuable program; 1 if empty.
  std::vector<double> repeats = {};
};

/// The running values along the paths of a continuable program.
struct Running {
  std::size_t count = 0;      ///< sums, states
  bool sums = false;          ///< `cum` in its written form, which counts rows
  bool nested = false;        ///< one running value depends on another
  bool state = false;         ///< there is a state
  bool solved = false;        ///< solved by steps, not in closed form
  bool at_first_row = false;  ///< its beginning
  double at = 0;              ///< another place on the axis, SI
};

/// Rows bound to a program, with all values that do not depend on parameters. Owns its numbers; the
/// caller's columns are not needed afterwards.
class Data {
 public:
  Data();
  Data(Data&&) noexcept;
  Data& operator=(Data&&) noexcept;
  ~Data();
  std::size_t rows() const;

  struct Body;

 private:
  friend class Program;
  std::unique_ptr<Body> body_;
};

/// The workspace of one thread: values and adjoints of the rows of one call.
class Workspace {
 public:
  Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  ~Workspace();

  /// The values of output i after `forward`: one per row, or a single one if it is uniform.
  std::span<const double> values(std::size_t i) const;

  /// To be filled by the caller before `reverse`: the derivative of its sum by each value, of the
  /// same length. Undefined before.
  std::span<double> adjoints(std::size_t i);

  struct Body;

 private:
  friend class Program;
  std::unique_ptr<Body> body_;
};

/// The first non-finite value, in the order of computation.
struct Fault {
  std::size_t row = 0;     ///< of the data
  bool uniform = false;    ///< the same in every row; `row` has no meaning
  std::string expression;  ///< the smallest non-finite expression, "work / area"
  std::string why;         ///< "division by 0", "log of -3 m"
  std::string where;       ///< its line or output, "[formula] wear"
};

/// Inputs of one evaluation, all in SI.
struct Inputs {
  std::span<const double> parameters;  ///< in the order of slots(symbols)
  /// For each parameter by row, in the order of Symbols::parameters: an entry for each row of the
  /// call.
  std::span<const double* const> by_row = {};
  /// The running values before the path's first row (`Program::running().count` of them), with an
  /// entry for each row of the call; empty if paths start from the beginning.
  std::span<const double* const> carried = {};
};

/// Compiled formulas and outputs. Immutable and cheap to copy. Evaluations are thread-safe; each
/// thread has its own workspace, and Data can be shared. Results depend only on the rows of the
/// call and its inputs; the values of a row do not depend on rows of other paths; the order of
/// summation of a gradient depends only on the number of rows.
class Program {
 public:
  const std::vector<Output>& outputs() const;

  /// Whether any output uses parameter (column, label) i of the symbols.
  bool uses_parameter(std::size_t i) const;
  bool uses_column(std::size_t i) const;
  bool uses_label(std::size_t i) const;

  /// How output i depends on parameters by row, judged from its form.
  ByRowDegree by_row_degree(std::size_t output) const;

  /// Whether any output depends on previous rows. If so, a call needs whole paths.
  bool has_paths() const;

  /// For a program compiled as continuable.
  Running running() const;
  /// After `forward`: the running values of this row's path, up to and including the row.
  void carry(const Workspace& workspace, std::size_t row, std::span<double> carried) const;

  /// Binds rows; throws InputError if a path is not sorted along the axis of a state, or begins
  /// before the state. The second form reuses the memory of `data`.
  Data bind(const Rows& rows) const;
  void bind(const Rows& rows, Data& data) const;

  /// For calls with at most this many rows.
  Workspace workspace(std::size_t most_rows) const;

  /// Computes all outputs for rows begin .. end - 1. Does not allocate or throw; undefined values
  /// (0/0) are NaN or infinite.
  void forward(const Data& data, std::size_t begin, std::size_t end, const Inputs& inputs,
               Workspace& workspace) const;

  /// After `forward` with the same arguments and with the adjoints filled: adds to `gradient` (as
  /// long as the parameters) the sum over rows of adjoint * d output / d parameter, and to
  /// `by_row[p][row of the call]` the same for each parameter by row (null: not wanted). Not for a
  /// continued path.
  void reverse(const Data& data, std::size_t begin, std::size_t end, const Inputs& inputs,
               Workspace& workspace, std::span<double> gradient,
               std::span<double* const> by_row = {}) const;

  /// The first non-finite subexpression over these rows, if any.
  std::optional<Fault> first_fault(const Data& data, std::size_t begin, std::size_t end,
                                   const Inputs& inputs) const;

  /// The output as parsed, with names of [formula] expanded: "k * (force * distance) / area".
  std::string text(std::size_t output) const;

  /// The state as parsed: "d(depth)/d(distance) = k * force * (1 - depth / h0), depth(0) = 0";
  /// empty without one.
  std::string state_text() const;

 private:
  friend Program compile(const std::vector<Line>&, const std::vector<Wanted>&, const Symbols&,
                         bool);
  struct Body;
  std::shared_ptr<const Body> body_;
};

/// Compiles the outputs `wanted` with the lines `law`, in any order. Checks every line, used or
/// not. Throws InputError with the expression, a caret below the position, both dimensions if they
/// do not match, and a hint. `continued`: paths can start from carried values (`Inputs::carried`),
/// at some cost in speed.
Program compile(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                const Symbols& symbols, bool continued = false);

}  // namespace wearwell::formula
