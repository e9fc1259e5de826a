#pragma once

#include <algorithm>
#include <cmath>

#include "wearwell/models/formula_model/crossing_search.h"
#include "wearwell/models/formula_model/node_lives.h"

namespace wearwell::formula_model {

/// Nodes of one pass as they continue from the present state of their unit.
struct NodeLives::Ahead {
  const NodeLives& lives;
  const Nodes& nodes;
  const UnitReading& last;
  const NodePath* path;  // of the quantity with the threshold, if it is running
  NodeRow own, ahead;
  bool runs, changes = false;
  NodeProgram::Scratch scratch;
  std::size_t begin = 0, count = 0, evaluated = ~std::size_t{0};
  double passed_by[most_crossings] = {};
  const NodeAxis* axis;

  Ahead(const NodeLives& of, const Nodes& at, const UnitReading& row, const NodePath& limited,
        const NodeAxis* own_axis)
      : lives(of),
        nodes(at),
        last(row),
        path(&limited),
        own(row.row),
        ahead(of.conditions(row.row)),
        runs(of.program_->running() > 0),
        scratch(*of.program_),
        axis(own_axis) {
    for (std::size_t c = 0; c < own.numbers.size(); ++c) {
      const bool differs = own.numbers[c] != ahead.numbers[c];
      changes |= of.program_->uses_column(c) && differs;
    }
    for (std::size_t l = 0; l < own.labels.size(); ++l) {
      changes |= of.program_->uses_label(l) && own.labels[l] != ahead.labels[l];
    }
    changes &= !runs;
  }

  // A place on the axis of the formula, of node i of this pass.
  double place_of(std::size_t i, double x) const { return axis ? axis->at(begin + i, x) : x; }
  // A remaining life along that axis as use.
  double use_of(std::size_t i, double life) const {
    if (!axis || !(life > 0)) return life;
    return axis->back(begin + i, place_of(i, last.place) + life) - last.place;
  }
  void here(double* place) const {
    for (std::size_t i = 0; i < count; ++i) place[i] = place_of(i, last.place);
  }

  // The start of the forecast.
  double from() const { return runs && path->begun ? path->place : lives.path_.begin; }

  void evaluate(const NodeRow& row, const double* place) {
    NodeProgram::GoesOn on;
    if (runs) {
      on = {from(), path->begun ? &path->carried : nullptr, &lives.steps_, lives.row_length_};
    }
    lives.program_->evaluate(nodes, begin, count, row, place, on, scratch, evaluated == begin);
    evaluated = begin;
  }
  double at(std::size_t o, std::size_t i) const {
    const std::span<const double> values = lives.program_->values(o, scratch);
    return values[values.size() == 1 ? 0 : i];
  }

  // Output o of all nodes at the unit's present position, under its own conditions.
  void now(std::size_t o, double* value) {
    double place[most_crossings];
    here(place);
    evaluate(runs ? ahead : own, place);
    const std::span<const double> values = lives.program_->values(o, scratch);
    for (std::size_t i = 0; i < count; ++i) value[i] = values[values.size() == 1 ? 0 : i];
  }

  // Turns positions into remaining lives: negative if the threshold is passed. A path that
  // continues has no positions before its last row: the excess over the threshold is divided by the
  // rate of the fastest neighbour.
  void count_from(const double* start, double* place) const {
    double pace = 0;
    for (std::size_t i = 0; i < count; ++i) {
      place[i] -= start[i];
      if (!(passed_by[i] < 0 && std::isfinite(place[i]))) continue;
      const double own_pace = place[i] / -passed_by[i];
      pace = pace > 0 ? std::min(pace, own_pace) : own_pace;
    }
    for (std::size_t i = 0; runs && i < count; ++i) {
      if (passed_by[i] >= 0) place[i] = -passed_by[i] * (pace > 0 ? pace : 1);
    }
  }

  void cross(const double* level, double* place) {
    std::span<const double> values;
    search_crossings(
        lives.path_.rising, from(), lives.path_.scale, count, level,
        [&](const double* trial) {
          evaluate(ahead, trial);
          values = lives.program_->values(0, scratch);
        },
        [&](std::size_t i) { return values[values.size() == 1 ? 0 : i]; }, place, passed_by);
  }
};

}  // namespace wearwell::formula_model
