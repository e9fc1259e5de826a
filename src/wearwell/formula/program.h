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

/// A line of the study's table [formula], as written there: `name` is a name ("wear"), a rate
/// ("d(depth)/d(distance)") or a state's value at the beginning ("depth(0)"; 0 without one).
struct Line {
  std::string name;
  std::string text;
};

/// An expression whose values are wanted: the slot of a family, a limit, a quantity.
struct Wanted {
  std::string name;  ///< as a message names its place: "[likelihood.depth] mean"
  std::string text;
  std::optional<Powers> powers = {};  ///< what its dimension must be; any without
  std::string because = {};           ///< whose dimension that is: "the column 'depth'"
  bool uniform = false;               ///< whether it may hold no column: a function of parameters
};

struct Output {
  std::string name;
  Powers powers;
  bool uniform = false;     ///< the same for all rows: one value, one adjoint
  bool parametric = false;  ///< depends on parameters at all
  bool by_path = false;     ///< depends on a path (cum, a state): on rows before its own
};

/// Rows as the caller has them. Where paths matter (cum, states), the rows of one path stand
/// together, sorted along the axis; a path begins at each entry of `paths` (ascending, the first 0).
/// Without entries all rows are one path.
struct Rows {
  std::size_t count = 0;
  std::vector<std::span<const double>> columns;  ///< as Symbols::columns; empty where not used
  std::vector<std::span<const int>> labels;      ///< as Symbols::labels; empty where not used
  std::vector<std::size_t> paths = {};
  /// Where on the axis each path begins, by row (its first one counts), instead of where the law says.
  std::vector<double> from = {};
  /// How many rows alike each row stands for in the running sums (`cum`) of a program that may be
  /// continued, not necessarily a whole number; ones where it is empty.
  std::vector<double> repeats = {};
};

/// What runs along the paths of a program that may be continued.
struct Running {
  std::size_t count = 0;      ///< sums, states
  bool sums = false;          ///< `cum` as it is written, which counts rows
  bool nested = false;        ///< one of them depends on another
  bool state = false;         ///< there is a state
  bool solved = false;        ///< by steps, not in closed form
  bool at_first_row = false;  ///< where it begins
  double at = 0;              ///< elsewhere on the axis, SI
};

/// Rows bound to a program: what does not depend on parameters, computed once. Owns its numbers;
/// the caller's columns may go.
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

/// The scratch of one thread: values and adjoints of the rows of one call.
class Workspace {
 public:
  Workspace();
  Workspace(Workspace&&) noexcept;
  Workspace& operator=(Workspace&&) noexcept;
  ~Workspace();

  /// The values of output i after `forward`: one for each row, or a single one where it is uniform.
  std::span<const double> values(std::size_t i) const;

  /// What the caller fills before `reverse`: the derivative of its own sum by each value, of the
  /// same length. Undefined before.
  std::span<double> adjoints(std::size_t i);

  struct Body;

 private:
  friend class Program;
  std::unique_ptr<Body> body_;
};

/// The first thing that went wrong with the numbers, in the order in which they are computed.
struct Fault {
  std::size_t row = 0;     ///< of the data
  bool uniform = false;    ///< the same in every row: `row` says nothing
  std::string expression;  ///< the smallest that is not finite, "work / area"
  std::string why;         ///< "division by 0", "log of -3 m"
  std::string where;       ///< the line or output that it stands in, "[formula] wear"
};

/// Inputs of one evaluation, all in SI.
struct Inputs {
  std::span<const double> parameters;  ///< in the order of slots(symbols)
  /// For each parameter by row, in the order of Symbols::parameters, an entry for each row of the
  /// call (its first row first).
  std::span<const double* const> by_row = {};
  /// What each thing that runs along a path is before the path's first row, an entry for each row of
  /// the call (`Program::running().count` of them); empty where paths begin anew.
  std::span<const double* const> carried = {};
};

/// Laws and outputs, compiled. Immutable and cheap to copy; evaluations are thread-safe, each thread
/// with a workspace and Data of its own or shared. Numbers depend on nothing but the rows of the
/// call and its inputs: values of a row not even on the other rows (of other paths); a gradient is
/// summed in an order that the number of rows alone decides.
class Program {
 public:
  const std::vector<Output>& outputs() const;

  /// Whether parameter (column, label) i of the symbols has a part in any output.
  bool uses_parameter(std::size_t i) const;
  bool uses_column(std::size_t i) const;
  bool uses_label(std::size_t i) const;

  /// How output i depends on parameters by row, as far as its form says.
  ByRowDegree by_row_degree(std::size_t output) const;

  /// Whether any output depends on rows before its own. Then a call takes whole paths.
  bool has_paths() const;

  /// Of a program that was compiled to be continued.
  Running running() const;
  /// After `forward`: what runs along the path of this row of the call, up to and with it.
  void carry(const Workspace& workspace, std::size_t row, std::span<double> carried) const;

  /// Binds rows; throws InputError where a path is not sorted along the axis of a state, or begins
  /// before the state does. The second form takes the memory of what `data` held.
  Data bind(const Rows& rows) const;
  void bind(const Rows& rows, Data& data) const;

  /// For calls with at most this many rows.
  Workspace workspace(std::size_t most_rows) const;

  /// Computes all outputs for rows begin .. end - 1. Nothing is allocated. What cannot be computed
  /// (0/0) is NaN or infinite; nothing throws.
  void forward(const Data& data, std::size_t begin, std::size_t end, const Inputs& inputs,
               Workspace& workspace) const;

  /// After `forward` with the same arguments and with the adjoints filled: adds to `gradient` (as
  /// long as the parameters) the sum over rows of adjoint * d output / d parameter, and to
  /// `by_row[p][row of the call]` the same for each parameter by row (null: not wanted). Not of a path
  /// that is continued.
  void reverse(const Data& data, std::size_t begin, std::size_t end, const Inputs& inputs,
               Workspace& workspace, std::span<double> gradient,
               std::span<double* const> by_row = {}) const;

  /// The first sub-expression that is not finite, over these rows; none where all are.
  std::optional<Fault> first_fault(const Data& data, std::size_t begin, std::size_t end,
                                   const Inputs& inputs) const;

  /// The output as it was understood, names of [formula] written out: "k * (force * distance) / area".
  std::string text(std::size_t output) const;

  /// The state as it was understood: "d(depth)/d(distance) = k * force * (1 - depth / h0), depth(0) = 0";
  /// empty without one.
  std::string state_text() const;

 private:
  friend Program compile(const std::vector<Line>&, const std::vector<Wanted>&, const Symbols&,
                         bool);
  struct Body;
  std::shared_ptr<const Body> body_;
};

/// Compiles the outputs `wanted` under the lines `law`, which may stand in any order. Every line is
/// checked, whether an output uses it or not. Throws InputError with the expression, a caret below
/// the place, both dimensions where they differ, and a hint. `continued`: paths may go on from where
/// others stand (`Inputs::carried`), at some cost of speed.
Program compile(const std::vector<Line>& law, const std::vector<Wanted>& wanted,
                const Symbols& symbols, bool continued = false);

}  // namespace wearwell::formula
