#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/program.h"
#include "wearwell/input/toml_reader.h"

namespace wearwell::formula_model {

/// An expression with "[mode]" in place of a level, for this level: "slope[mode]" becomes "slope['wear']".
std::string of_level(const std::string& text, const std::string& name, const std::string& level);

/// Lines of [formula] by a label that no row states as such, a failure mode or a subpopulation: lines that depend on it
/// have a copy for each level, under a name of its own. Throws InputError at a line that cannot have copies.
class LinesByLevel {
 public:
  LinesByLevel(const TomlReader& root, std::string name, std::vector<std::string> levels,
               const std::vector<formula::Line>& lines);

  const std::vector<formula::Line>& lines() const { return lines_; }
  /// An expression of level k.
  std::string text(const std::string& written, std::size_t k) const;

 private:
  std::string name_;
  std::vector<std::string> levels_;
  std::vector<formula::Line> lines_;
  std::vector<std::string> dependent_;
};

}  // namespace wearwell::formula_model
