#pragma once

#include <cstddef>

#include "wearwell/present/plot.h"

namespace wearwell::formula_model {

/// Number of conditions that one plot tells apart.
inline constexpr std::size_t group_colours = 6;

inline const char* group_colour(std::size_t group) {
  constexpr const char* colours[] = {plot::colour::chains[0], plot::colour::chains[1],
                                     plot::colour::chains[2], plot::colour::chains[3],
                                     plot::colour::limit,     plot::colour::prior};
  return colours[group % group_colours];
}

}  // namespace wearwell::formula_model
