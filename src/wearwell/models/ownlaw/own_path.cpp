#include "wearwell/models/ownlaw/own_path.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "wearwell/base/error.h"
#include "wearwell/base/nearest.h"

namespace wearwell::ownlaw {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

bool is_condition(const OwnLaw& law, const std::string& name) {
  const auto column =
      std::find_if(law.symbols.columns.begin(), law.symbols.columns.end(),
                   [&](const law::ColumnSymbol& each) { return each.name == name; });
  return column != law.symbols.columns.end() && !column->measured && law.along != name;
}

}  // namespace

Conditions read_conditions(const TomlReader& table, const OwnLaw& law) {
  Conditions result;
  std::vector<std::string> words, known;
  for (const law::ColumnSymbol& each : law.symbols.columns) {
    if (is_condition(law, each.name)) known.push_back(each.name);
  }
  for (const law::LabelSymbol& each : law.symbols.labels) {
    if (law.label != each.name) known.push_back(each.name);
  }
  for (const std::string& name : table.keys()) {
    if (law.along == name) table.fail(name, "is the axis (predict.along); ask with predict.at");
    if (std::find(known.begin(), known.end(), name) == known.end()) {
      table.fail(name, known.empty()
                           ? "is no condition: no column of the data is one"
                           : fmt::format("is no condition; possible are {} (nearest: '{}')",
                                         fmt::join(known, ", "), nearest_name(name, known)));
    }
    if (const LabelColumn* label = law.data.label(name)) {
      const std::string level = table.required_text(name);
      const auto at = std::find(label->levels.begin(), label->levels.end(), level);
      if (at == label->levels.end()) {
        table.fail(name,
                   fmt::format("'{}' is none of the data's; possible are {} (nearest: '{}')", level,
                               fmt::join(label->levels, ", "), nearest_name(level, label->levels)));
      }
      result.labels[name] = static_cast<int>(at - label->levels.begin());
      words.push_back(fmt::format("{} = {}", name, level));
      continue;
    }
    const NumberColumn& column = *law.data.number(name);
    const Quantity quantity = table.required_quantity(name, law::si_text(column.unit.powers));
    result.numbers[name] = quantity.si();
    words.push_back(fmt::format("{} = {:.6g}{}", name, quantity.value,
                                quantity.unit.text == "1" ? "" : " " + quantity.unit.text));
  }
  result.words = fmt::format("{}", fmt::join(words, ", "));
  return result;
}

Conditions conditions_of_unit(const OwnLaw& law, std::size_t unit, const Conditions& given) {
  Conditions result = given;
  const NumberColumn* axis = law.along ? law.data.number(*law.along) : nullptr;
  std::optional<std::size_t> last;
  for (const std::size_t row : law.order) {
    if (law.unit_of_row[row] != unit) continue;
    if (!last || !axis || axis->values[row] >= axis->values[*last]) last = row;
  }
  if (!last) return result;
  for (const NumberColumn& each : law.data.numbers) {
    if (is_condition(law, each.name)) result.numbers.try_emplace(each.name, each.values[*last]);
  }
  for (const LabelColumn& each : law.data.labels) {
    if (law.label != each.name) result.labels.try_emplace(each.name, each.at[*last]);
  }
  return result;
}

Conditions common_conditions(const OwnLaw& law, const Conditions& given) {
  Conditions result = given;
  for (const NumberColumn& each : law.data.numbers) {
    const bool same = std::all_of(each.values.begin(), each.values.end(),
                                  [&](double x) { return x == each.values.front(); });
    if (same && is_condition(law, each.name)) {
      result.numbers.try_emplace(each.name, each.values.front());
    }
  }
  for (const LabelColumn& each : law.data.labels) {
    if (each.levels.size() == 1 && law.label != each.name) result.labels.try_emplace(each.name, 0);
  }
  return result;
}

std::shared_ptr<const Path> make_path(std::shared_ptr<const OwnLaw> law, const TomlReader& table,
                                      const std::string& key,
                                      const std::vector<law::Wanted>& wanted, bool along,
                                      const Conditions& conditions) {
  auto path = std::make_shared<Path>();
  path->symbols = law->row_symbols;
  path->shared = law->shared;
  path->along = along;
  if (along) {
    // The axis becomes a number that is given by row, so that no row is bound anew while a life is
    // searched.
    auto& columns = path->symbols.columns;
    const auto axis = std::find_if(columns.begin(), columns.end(),
                                   [&](const auto& each) { return each.name == *law->along; });
    path->symbols.parameters.push_back({axis->name, axis->powers, law::Scope::per_row, {}});
    columns.erase(axis);
  }
  try {
    path->program = law::compile(law->lines, wanted, path->symbols);
  } catch (const InputError& error) {
    table.fail(key, error.what());
  }
  if (path->program.has_paths()) {
    table.fail(key,
               "depends on rows before its own (cum, or a state): predictions along such a "
               "path are not made yet");
  }
  law::Rows rows;
  rows.count = Path::most;
  std::vector<std::vector<double>> numbers;
  std::vector<std::vector<int>> labels;
  for (std::size_t c = 0; c < path->symbols.columns.size(); ++c) {
    numbers.emplace_back();
    if (!path->program.uses_column(c)) continue;
    const std::string& name = path->symbols.columns[c].name;
    const auto at = conditions.numbers.find(name);
    if (at == conditions.numbers.end()) {
      const NumberColumn& column = *law->data.number(name);
      table.fail(key, fmt::format("needs predict.given.{}: it is not the same in all rows (write "
                                  "given = {{ {} = \"{:.4g} {}\" }})",
                                  name, name, from_si(column.unit.unit, column.values.front()),
                                  column.unit.unit.text));
    }
    numbers.back().assign(Path::most, at->second);
  }
  for (std::size_t c = 0; c < path->symbols.labels.size(); ++c) {
    labels.emplace_back();
    if (!path->program.uses_label(c)) continue;
    const std::string& name = path->symbols.labels[c].name;
    const auto at = conditions.labels.find(name);
    if (at == conditions.labels.end()) {
      table.fail(key, fmt::format("needs predict.given.{}, one of {}", name,
                                  fmt::join(path->symbols.labels[c].levels, ", ")));
    }
    labels.back().assign(Path::most, at->second);
  }
  for (const auto& each : numbers) rows.columns.emplace_back(each);
  for (const auto& each : labels) rows.labels.emplace_back(each);
  path->data = path->program.bind(rows);
  path->law = std::move(law);
  return path;
}

PathAt::PathAt(const Path& path)
    : path_(&path),
      population_at_(*path.law),
      inner_(path.shared.size()),
      workspace_(path.program.workspace(Path::most)) {
  for (std::size_t e = 0; e < path.law->effects.size(); ++e) effect_[e].resize(Path::most);
}

void PathAt::move_to(const double* x) {
  population_ = population_at_(x);
  for (std::size_t i = 0; i < inner_.size(); ++i) inner_[i] = x[path_->shared[i]];
}

void PathAt::evaluate(std::size_t count, const double* z, const double* place) {
  const std::size_t d = path_->law->effects.size();
  static constexpr double middle[2] = {};
  const double* by_row[3] = {};
  std::size_t given = 0;
  for (std::size_t e = 0; e < d; ++e) {
    for (std::size_t i = 0; i < count; ++i) {
      effect_[e][i] = population_.value(*path_->law, e, z ? z + i * d : middle);
    }
    by_row[given++] = effect_[e].data();
  }
  if (path_->along) by_row[given++] = place;
  path_->program.forward(path_->data, 0, count, {inner_, {by_row, given}}, workspace_);
}

double PathAt::output(std::size_t o, std::size_t i) const {
  const std::span<const double> values = workspace_.values(o);
  return values[values.size() == 1 ? 0 : i];
}

Crossing::Crossing(const Path& path, bool rising, double begin, double scale)
    : at_(path),
      effects_(path.law->effects.size()),
      rising_(rising),
      begin_(begin),
      scale_(scale) {}

// Outward from the scale until the level is passed, then within that by the rule of false position with
// halved ends (Dowell and Jarratt 1971): of a straight path it is there at once.
void Crossing::solve(std::size_t count, const double* z, const double* level, double* place) {
  constexpr int most_outward = 60, most_inward = 120;
  double low[Path::most] = {}, high[Path::most] = {}, at_low[Path::most] = {};
  double at_high[Path::most] = {}, trial[Path::most] = {};
  std::uint8_t state[Path::most] = {};  // 0 looks outward, 1 inward, 2 is done
  int side[Path::most] = {};
  const auto excess = [&](std::size_t i) {
    const double y = at_.output(0, i) - level[i];
    return rising_ ? y : -y;
  };
  std::fill_n(trial, count, begin_);
  at_.evaluate(count, z, trial);
  for (std::size_t i = 0; i < count; ++i) {
    low[i] = begin_;
    at_low[i] = excess(i);
    state[i] = at_low[i] >= 0 ? 2 : 0;
    place[i] = begin_;
    trial[i] = begin_ + scale_;
    // A path may be no number at its very beginning: log 0.
    if (std::isnan(at_low[i]) || at_low[i] == -infinity) at_low[i] = -infinity;
  }
  for (int step = 0; step < most_outward + most_inward; ++step) {
    if (std::all_of(state, state + count, [](auto s) { return s == 2; })) return;
    at_.evaluate(count, z, trial);
    for (std::size_t i = 0; i < count; ++i) {
      if (state[i] == 2) continue;
      const double y = excess(i);
      if (std::isnan(y)) {
        place[i] = y;
        state[i] = 2;
        continue;
      }
      if (state[i] == 0) {
        if (y >= 0) {
          high[i] = trial[i];
          at_high[i] = y;
          state[i] = 1;
        } else if (step >= most_outward) {
          place[i] = infinity;
          state[i] = 2;
          continue;
        } else {
          low[i] = trial[i];
          at_low[i] = y;
          trial[i] = begin_ + (trial[i] - begin_) * (step < 10 ? 2 : 8);
          continue;
        }
      } else if (y >= 0) {
        high[i] = trial[i];
        at_high[i] = y;
        if (side[i] == 1) at_low[i] *= 0.5;
        side[i] = 1;
      } else {
        low[i] = trial[i];
        at_low[i] = y;
        if (side[i] == -1) at_high[i] *= 0.5;
        side[i] = -1;
      }
      const double size = std::max(std::abs(low[i]), std::abs(high[i]));
      if (y == 0 || high[i] - low[i] <= 1e-11 * size || std::abs(y) <= 1e-13 * std::abs(level[i])) {
        place[i] = trial[i];
        state[i] = 2;
        continue;
      }
      double next = std::isfinite(at_low[i])
                        ? low[i] - at_low[i] * (high[i] - low[i]) / (at_high[i] - at_low[i])
                        : 0.5 * (low[i] + high[i]);
      if (!(next > low[i] && next < high[i]) || step % 8 == 7) next = 0.5 * (low[i] + high[i]);
      if (!(next > low[i] && next < high[i])) {
        place[i] = high[i];
        state[i] = 2;
        continue;
      }
      trial[i] = next;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (state[i] == 1) place[i] = 0.5 * (low[i] + high[i]);
    if (state[i] == 0) place[i] = infinity;
  }
}

}  // namespace wearwell::ownlaw
