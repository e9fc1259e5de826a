#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "wearwell/input/toml_reader.h"
#include "wearwell/models/ownlaw/own_law.h"

namespace wearwell::ownlaw {

/// Under which conditions something is asked: values of columns and labels.
struct Conditions {
  std::map<std::string, double> numbers;  ///< SI
  std::map<std::string, int> labels;      ///< index of the level
  std::string words;                      ///< "force = 20 N"
};

/// Reads predict.given or a table like it. Throws InputError.
Conditions read_conditions(const TomlReader& table, const OwnLaw& law);

/// Those of a unit's last row, where `given` does not say otherwise.
Conditions conditions_of_unit(const OwnLaw& law, std::size_t unit, const Conditions& given);

/// Columns that are the same in all rows, where `given` does not say otherwise.
Conditions common_conditions(const OwnLaw& law, const Conditions& given);

/// Expressions under fixed conditions, at any place along the axis and for any unit of the population.
/// Immutable; evaluations are thread-safe with a `PathAt` each.
struct Path {
  std::shared_ptr<const OwnLaw> law;
  law::Program program;
  bool along = false;  ///< whether the axis is given by row, as the last of those
  law::Symbols symbols;
  std::vector<std::size_t> shared;  ///< the study's parameters among those of the symbols
  law::Data data;                   ///< `most` rows, all alike
  static constexpr std::size_t most = 128;
};

/// Compiles `wanted` under these conditions; `along` leaves the axis open. Throws InputError at `key` of
/// `table`: where an expression is wrong, where a condition is missing, or where a path depends on rows
/// before its own.
std::shared_ptr<const Path> make_path(std::shared_ptr<const OwnLaw> law, const TomlReader& table,
                                      const std::string& key,
                                      const std::vector<law::Wanted>& wanted, bool along,
                                      const Conditions& conditions);

/// One thread's evaluation of a path.
class PathAt {
 public:
  explicit PathAt(const Path& path);
  /// All that follows is at these parameters, which must stay.
  void move_to(const double* x);
  const Population& population() const { return population_; }

  /// Computes the outputs for `count` units at z (effects() each; null for none) and places along
  /// the axis (null where it is none), count <= Path::most.
  void evaluate(std::size_t count, const double* z, const double* place);
  double output(std::size_t o, std::size_t i) const;

 private:
  const Path* path_;
  PopulationAt population_at_;
  Population population_;
  std::vector<double> inner_, effect_[2], place_;
  law::Workspace workspace_;
};

/// Where output 0 of a path first reaches a level, by unit: from `begin` on, with a first guess of
/// `scale`. `rising` says from which side. Infinite where it never does, `begin` where it has.
class Crossing {
 public:
  Crossing(const Path& path, bool rising, double begin, double scale);
  PathAt& at() { return at_; }
  void solve(std::size_t count, const double* z, const double* level, double* place);

 private:
  PathAt at_;
  std::size_t effects_;
  bool rising_;
  double begin_, scale_;
};

}  // namespace wearwell::ownlaw
