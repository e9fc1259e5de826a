#pragma once

#include <string>
#include <vector>

#include "wearwell/formula/complaint.h"

namespace wearwell::formula {

/// An element of MathML Core: "mfrac" with two children, "mi" with a text.
struct MathElement {
  std::string tag;
  std::string text = {};
  std::vector<MathElement> children = {};
};

/// A name: Greek letters by their names, what follows _ as subscripts: "sigma_a" is σ with subscript a.
MathElement typeset_name(const std::string& name);

/// An expression as a formula of a textbook, by its syntax alone: quotients as fractions, powers raised,
/// roots, indices. Brackets that a fraction or root replaces are left out. Throws InputError with a caret at the error.
MathElement typeset(const Text& text);

/// The markup of an element, escaped.
std::string mathml(const MathElement& element);

}  // namespace wearwell::formula
