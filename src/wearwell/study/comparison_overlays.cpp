#include "wearwell/study/comparison_overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <sstream>

#include "wearwell/present/html.h"

namespace wearwell {
namespace {

using Json = nlohmann::ordered_json;
using Numbers = std::vector<double>;

// The figures that every report draws under the same name: wear or life, against work or stress.
constexpr const char* curves[] = {"sn-curve", "history", "life"};

const Json* find(const Json& json, std::initializer_list<const char*> path) {
  const Json* at = &json;
  for (const char* key : path) {
    if (!at->is_object() || !at->contains(key)) return nullptr;
    at = &(*at)[key];
  }
  return at;
}

std::string text_at(const Json& json, std::initializer_list<const char*> path) {
  const Json* found = find(json, path);
  return found && found->is_string() ? found->get<std::string>() : "";
}

struct Line {
  Numbers x, y;
  bool dashed = false;
};

// Columns x and y of the CSV in a line mark.
std::optional<Line> read_line(const Json& layer) {
  if (text_at(layer, {"mark", "type"}) != "line") return {};
  std::istringstream csv(text_at(layer, {"data", "values"}));
  std::string row;
  if (!std::getline(csv, row) || !(row == "x,y" || row.starts_with("x,y,"))) return {};
  Line line;
  line.dashed = find(layer, {"mark", "strokeDash"}) != nullptr;
  while (std::getline(csv, row)) {
    const char *at = row.data(), *end = at + row.size();
    double value[2] = {NAN, NAN};
    for (double& each : value) {
      at = std::from_chars(at, end, each).ptr;
      if (at != end && *at == ',') ++at;
    }
    if (!std::isfinite(value[0]) || !std::isfinite(value[1])) continue;
    line.x.push_back(value[0]);
    line.y.push_back(value[1]);
  }
  return line.x.size() > 1 ? std::optional(line) : std::nullopt;
}

struct Drawn {
  std::size_t study = 0;
  std::string title;
  plot::Axis x, y;
  std::vector<Line> lines;
};

std::optional<Drawn> read_figure(std::size_t study, const html::Figure& figure) {
  const Json* layers = find(figure.specification, {"layer"});
  if (!layers || !layers->is_array()) return {};
  Drawn drawn{study, figure.title, {}, {}, {}};
  for (const Json& layer : *layers) {
    auto line = read_line(layer);
    if (!line) continue;
    if (drawn.lines.empty()) {
      drawn.x = {text_at(layer, {"encoding", "x", "title"}),
                 text_at(layer, {"encoding", "x", "scale", "type"}) == "log"};
      drawn.y = {text_at(layer, {"encoding", "y", "title"}),
                 text_at(layer, {"encoding", "y", "scale", "type"}) == "log"};
    }
    drawn.lines.push_back(std::move(*line));
  }
  return drawn.lines.empty() ? std::nullopt : std::optional(drawn);
}

// Log axes end where the curves do, not at the next power of ten.
void fit_to(const Numbers& values, plot::Axis& axis) {
  if (!axis.logarithmic) return;
  constexpr double margin = 1.05;
  for (const double x : values) {
    axis.low = std::min(axis.low.value_or(INFINITY), x / margin);
    axis.high = std::max(axis.high.value_or(0), x * margin);
  }
}

bool positive(const Numbers& values) {
  return std::all_of(values.begin(), values.end(), [](double x) { return x > 0; });
}

html::Figure over_each_other(const Comparison& comparison, const std::string& id,
                             const std::vector<Drawn>& all) {
  std::vector<plot::Json> marks;
  plot::Axis x = all.front().x, y = all.front().y;
  bool dashes = false;
  for (const Drawn& drawn : all) {
    for (const Line& line : drawn.lines) {
      x.logarithmic = x.logarithmic && positive(line.x);
      y.logarithmic = y.logarithmic && positive(line.y);
    }
  }
  for (const Drawn& drawn : all) {
    for (const Line& line : drawn.lines) {
      fit_to(line.x, x);
      fit_to(line.y, y);
    }
    bool labelled = false;
    for (const Line& line : drawn.lines) {
      const std::string& name = comparison.studies[drawn.study].name;
      plot::Look look = look_of_study(drawn.study, line.dashed || labelled ? "" : name);
      labelled = labelled || !line.dashed;
      dashes = dashes || line.dashed;
      look.dashed = look.dashed || line.dashed;
      marks.push_back(plot::line({{"x", line.x}, {"y", line.y}}, look));
    }
  }
  const std::string& title = all.front().title;
  return {"overlay-" + id, title,
          std::string("The curve of each study, in its color.") +
              (dashes ? " Dashed: the design curve." : ""),
          plot::plot(title + " of each study", x, y, marks, 340, true)};
}

struct Row {
  std::string quantity, unit;
  std::map<std::size_t, const QuantitySummary*> of;  // by study
};

std::vector<Row> rows_of(const Comparison& comparison) {
  std::vector<Row> rows;
  for (std::size_t s = 0; s < comparison.studies.size(); ++s) {
    for (const QuantitySummary& each : comparison.studies[s].result.quantities) {
      if (!each.is_life && !each.is_bounded()) continue;
      const std::string name =
          fmt::format("{} of {}{}{}", each.name, each.of, each.at.empty() ? "" : " ", each.at);
      auto found = std::find_if(rows.begin(), rows.end(), [&](const Row& row) {
        return row.quantity == name && row.unit == each.unit;
      });
      if (found == rows.end()) {
        rows.push_back({name, each.unit, {}});
        found = rows.end() - 1;
      }
      found->of.emplace(s, &each);
    }
  }
  return rows;
}

}  // namespace

plot::Look look_of_study(std::size_t study, const std::string& name) {
  static constexpr const char* colours[] = {plot::colour::chains[0], plot::colour::chains[1],
                                            plot::colour::chains[2], plot::colour::chains[3],
                                            plot::colour::limit,     plot::colour::prior};
  return {colours[study % std::size(colours)], name, 0.95, 2, study >= std::size(colours)};
}

present::Table life_table(const Comparison& comparison) {
  using present::Cell;
  present::Table table{
      "lives",
      "Lives and design values of each study",
      {{"Quantity"}, {"Unit"}, {"Study"}, {"B10, or next one"}, {"At least"}, {"50 %"}}};
  const bool upper =
      std::any_of(comparison.studies.begin(), comparison.studies.end(), [](const auto& study) {
        return std::any_of(study.result.quantities.begin(), study.result.quantities.end(),
                           [](const auto& each) { return each.best().upper_bound.has_value(); });
      });
  if (upper) table.columns.push_back({"At most"});
  for (const Row& row : rows_of(comparison)) {
    for (const auto& [study, quantity] : row.of) {
      const QuantityQuantiles& q = quantity->best();
      Cell bound, next;
      if (q.bound) bound = *q.bound;
      if (quantity->is_life) {
        next = q.b10;
      } else if (q.predictive) {
        next = *q.predictive;
      }
      table.rows.push_back(
          {row.quantity, row.unit, comparison.studies[study].name, next, bound, q.q50});
      if (upper) table.rows.back().push_back(q.upper_bound ? Cell(*q.upper_bound) : Cell());
    }
  }
  return table;
}

std::vector<html::Figure> curve_figures(const Comparison& comparison) {
  std::vector<html::Figure> figures;
  for (const std::string id : curves) {
    std::vector<Drawn> all;
    for (std::size_t s = 0; s < comparison.studies.size(); ++s) {
      for (const html::Figure& figure : comparison.studies[s].result.figures) {
        if (figure.id != id) continue;
        auto drawn = read_figure(s, figure);
        if (drawn &&
            (all.empty() || (all[0].x.title == drawn->x.title && all[0].y.title == drawn->y.title)))
          all.push_back(std::move(*drawn));
      }
    }
    if (all.size() > 1) figures.push_back(over_each_other(comparison, id, all));
  }
  return figures;
}

}  // namespace wearwell
