#pragma once

#include <cmath>
#include <vector>

#include "wearwell/prob/response.h"

namespace wearwell {

/// How parts are watched: one of four from `late` on, two of three only at times that are `apart`, all to `longest`.
struct Watch {
  double longest, apart, late;
};

/// `parts` lives as they are seen; those that end before their part is watched are drawn again.
template <class Draw>
std::vector<Response> inspected_lives(std::size_t parts, const Draw& draw, const Watch& watch) {
  std::vector<Response> all;
  while (all.size() < parts) {
    const std::size_t i = all.size();
    const double entry = i % 4 == 3 ? watch.late : -INFINITY, life = draw();
    if (life <= entry) continue;  // it was never seen
    Response y{.at = std::min(life, watch.longest), .entry = entry};
    if (life > watch.longest) {
      y.seen = Censoring::right;
    } else if (i % 3 != 2) {
      const double before = watch.apart * std::floor(life / watch.apart),
                   from = std::max(before, entry);
      y.seen = from > 0 ? Censoring::interval : Censoring::left;
      y.at = from > 0 ? from : watch.apart;
      y.until = before + watch.apart;
    }
    all.push_back(y);
  }
  return all;
}

}  // namespace wearwell
