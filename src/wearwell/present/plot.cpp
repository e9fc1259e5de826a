#include "wearwell/present/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "wearwell/base/printable.h"

namespace wearwell::plot {
namespace {

// A column name that is safe in CSV and Vega: a comma would split it, and Vega interprets points
// and brackets as paths.
std::string in_heading(const std::string& text) {
  std::string name = printable(text);
  for (char& c : name) {
    if (std::strchr(",.[]\"'\\", c)) c = ' ';
  }
  return name;
}

// Six digits suffice for a plot; CSV is the shortest format for many numbers.
Json inline_data(const Columns& columns) {
  std::string csv;
  for (const auto& [name, values] : columns) csv += (csv.empty() ? "" : ",") + in_heading(name);
  auto end = std::back_inserter(csv);
  for (std::size_t i = 0; i < columns.front().second.size(); ++i) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double value = columns[c].second[i];
      fmt::format_to(end, "{}", c == 0 ? "\n" : ",");
      if (std::isfinite(value)) fmt::format_to(end, "{:.6g}", value);
    }
  }
  return {{"values", csv}, {"format", {{"type", "csv"}}}};
}

bool has(const Columns& columns, const char* name) {
  for (const auto& column : columns) {
    if (column.first == name) return true;
  }
  return false;
}

Json mark(const char* type, const Look& look, const char* paint) {
  Json json = {{"type", type}, {"clip", true}, {"opacity", look.opacity}, {"aria", false}};
  json[paint] = look.colour;
  return json;
}

Json layer(const Columns& data, Json mark, const Look& look) {
  Json encoding = {{"x", {{"field", "x"}}}, {"y", {{"field", "y"}}}};
  for (const char* second : {"x2", "y2"}) {
    if (has(data, second)) encoding[second] = {{"field", second}};
  }
  // Columns with names longer than a letter are shown to the user.
  Json tooltip = Json::array();
  for (const auto& column : data) {
    if (column.first.size() > 2 && column.first != "density") {
      tooltip.push_back(
          {{"field", in_heading(column.first)}, {"type", "quantitative"}, {"format", ".4~g"}});
    }
  }
  if (!tooltip.empty()) encoding["tooltip"] = tooltip;
  if (!look.label.empty()) encoding["color"] = {{"datum", look.label}};
  return {{"data", inline_data(data)}, {"mark", std::move(mark)}, {"encoding", encoding}};
}

Json stroke(const char* type, const Look& look) {
  Json json = mark(type, look, "stroke");
  json["strokeWidth"] = look.width;
  if (look.dashed) json["strokeDash"] = {6, 4};
  return json;
}

Json scale(const Axis& axis) {
  Json json = {{"nice", !axis.low && !axis.high}};
  if (axis.logarithmic) {
    json["type"] = "log";
  } else {
    json["zero"] = false;
  }
  // Vega chooses an end that is not finite or not positive on a log scale.
  const auto is_end = [&](const std::optional<double>& end) {
    return end && std::isfinite(*end) && (!axis.logarithmic || *end > 0);
  };
  if (is_end(axis.low)) json["domainMin"] = *axis.low;
  if (is_end(axis.high)) json["domainMax"] = *axis.high;
  if (!axis.names.empty()) {
    json["domain"] = {0.5, static_cast<double>(axis.names.size()) + 0.5};
    json["nice"] = false;
  }
  return json;
}

Json named_ticks(const Axis& axis) {
  std::vector<double> values;
  std::string label = "''";
  for (auto each = axis.ticks.rbegin(); each != axis.ticks.rend(); ++each) {
    values.push_back(each->first);
    label = fmt::format("abs(datum.value-({}))<1e-9?{}:{}", each->first, Json(each->second).dump(),
                        label);
  }
  std::sort(values.begin(), values.end());
  // Of more values than its count Vega keeps every other one.
  return {{"values", values},
          {"tickCount", values.size() + 1},
          {"labelExpr", label},
          {"labelFlush", false},  // a name stands at its tick, also at the ends
          {"labelOverlap", "greedy"}};
}

Json ticks(const char* channel, const Axis& axis) {
  if (!axis.names.empty()) {
    std::vector<double> values;
    for (std::size_t i = 1; i <= axis.names.size(); ++i) values.push_back(static_cast<double>(i));
    return {{"values", values},
            {"grid", false},
            {"labelOverlap", false},
            {"labelFlush", false},
            {"labelAngle", axis.names.size() > 8 && channel[0] == 'x' ? -60 : 0},
            {"tickCount", values.size() + 1},
            {"labelExpr", Json(axis.names).dump() + "[datum.value - 1]"}};
  }
  if (!axis.numbers) return {{"labels", false}, {"ticks", false}, {"grid", false}};
  if (!axis.ticks.empty()) return named_ticks(axis);
  // The page formats powers of ten like html::number (page.js).
  if (axis.logarithmic) return {{"format", "~g"}, {"tickCount", 5}};
  return {{"format", ",~r"}};
}

// Reserves room for half a point beyond the ends of an axis: six pixels, but little of a plot that is
// hardly wider than that for a moment, as when a phone prints; its logarithmic axis would reach to infinity.
Json room_for_points(const char* channel) {
  return {{"expr", fmt::format("min(6, {} / 20)", channel[0] == 'x' ? "width" : "height")}};
}

void set_axis(Json& encoding, const char* channel, const Axis& axis, bool has_points) {
  if (!encoding.contains(channel)) return;
  Json& each = encoding[channel];
  each["type"] = "quantitative";
  each["title"] = axis.title;
  each["scale"] = scale(axis);
  if (has_points && axis.names.empty()) each["scale"]["padding"] = room_for_points(channel);
  each["axis"] = ticks(channel, axis);
}

}  // namespace

// Keeps the order of points, which Vega-Lite would sort by x.
Json line(const Columns& data, const Look& look) {
  Json json = layer(data, stroke("line", look), look);
  json["encoding"]["order"] = {{"value", nullptr}};
  return json;
}

Json steps(const Columns& data, const Look& look) {
  Json mark = stroke("line", look);
  mark["interpolate"] = "step-after";
  return layer(data, mark, look);
}

Json area(const Columns& data, const Look& look) {
  return layer(data, mark("area", look, "fill"), look);
}

Json points(const Columns& data, const Look& look) {
  Json filled = mark("point", look, "color");
  filled["filled"] = true;
  filled["size"] = look.size;
  return layer(data, filled, look);
}

Json arrows(const Columns& data, const std::string& shape, const Look& look) {
  Json json = points(data, look);
  json["mark"]["shape"] = shape;
  return json;
}

Json ranges(const Columns& data, const Look& look) {
  Json thick = stroke("rule", look);
  thick["strokeCap"] = "butt";
  return layer(data, thick, look);
}

Json cells(const Columns& data, const Look& look) {
  Json json = layer(data, mark("rect", look, "fill"), look);
  json["mark"].erase("opacity");
  json["mark"]["strokeWidth"] = 0;
  json["encoding"]["opacity"] = {{"field", "density"},
                                 {"type", "quantitative"},
                                 {"legend", nullptr},
                                 {"scale", {{"domain", {0, 1}}, {"range", {0, 1}}}}};
  return json;
}

Json heat_map(const Columns& data, const Look& look, const Shade& shade) {
  constexpr double palest = 0.06;
  constexpr int steps = 4;
  std::vector<double> shown;
  for (int i = 0; i <= steps; ++i)
    shown.push_back(std::lerp(shade.low, shade.high, static_cast<double>(i) / steps));
  Json json = cells(data, look);
  json["encoding"]["opacity"]["scale"] = {
      {"domain", {shade.low, shade.high}}, {"range", {palest, 1}}, {"clamp", true}};
  json["encoding"]["opacity"]["legend"] = {{"title", shade.title},
                                           {"values", shown},
                                           {"format", ",.3~r"},
                                           {"symbolType", "square"},
                                           {"symbolFillColor", look.colour},
                                           {"symbolStrokeWidth", 0}};
  return json;
}

Json vertical_line(double x, const Look& look) {
  Json json = layer({{"x", {x}}}, stroke("rule", look), look);
  json["encoding"].erase("y");
  return json;
}

Json horizontal_line(double y, const Look& look) {
  Json json = layer({{"y", {y}}}, stroke("rule", look), look);
  json["encoding"].erase("x");
  return json;
}

Json text(double x, double y, const std::string& words, const std::string& colour) {
  Json json = layer({{"x", {x}}, {"y", {y}}}, mark("text", {colour}, "fill"), {colour});
  json["mark"].update({{"text", words}, {"align", "right"}, {"dx", -7}, {"dy", -5}});
  return json;
}

namespace {

// One entry of the legend, styled like its marks.
struct Entry {
  Json label, colour;
  std::string shape = "square";
  bool dashed = false;

  explicit Entry(const Json& layer) : label(layer["encoding"]["color"]["datum"]) {
    const Json& mark = layer["mark"];
    constexpr double bar = 5;  // a stroke of this width is a bar
    for (const char* paint : {"stroke", "fill", "color"}) {
      if (mark.contains(paint)) colour = mark[paint];
    }
    if (mark.contains("stroke") && mark["strokeWidth"].get<double>() < bar) shape = "stroke";
    if (mark["type"] == "point") shape = mark.value("shape", "circle");
    dashed = mark.contains("strokeDash");
  }
};

std::vector<Entry> entries_of(const std::vector<Json>& marks) {
  std::vector<Entry> entries;
  for (const Json& each : marks) {
    if (!each["encoding"].contains("color")) continue;
    const Entry entry(each);
    if (std::none_of(entries.begin(), entries.end(),
                     [&](const Entry& known) { return known.label == entry.label; }))
      entries.push_back(entry);
  }
  return entries;
}

// Legend symbols like the marks: lines, dashed lines, point shapes.
Json legend_of(const std::vector<Entry>& entries) {
  Json labels = Json::array(), shapes = Json::array(), dashes = Json::array(),
       widths = Json::array();
  for (const Entry& entry : entries) {
    labels.push_back(entry.label);
    shapes.push_back(entry.shape);
    dashes.push_back(entry.dashed ? Json{4, 3} : Json{1, 0});
    widths.push_back(entry.shape == "stroke" ? 2.5 : 0);
  }
  const auto signal = [](const std::string& expression) {
    return Json{{"value", {{"signal", expression}}}};
  };
  // Vega evaluates the size of the largest symbol with the bare label as datum, to place the
  // labels; without a number, labels overlap their symbols.
  const auto of_entry = [&](const Json& values) {
    return signal(fmt::format("{}[indexof({}, isObject(datum) ? datum.value : datum)]",
                              values.dump(), labels.dump()));
  };
  const Json colour = signal("scale('color', datum.value)");
  return {{"encoding",
           {{"symbols",
             {{"shape", of_entry(shapes)},
              {"strokeDash", of_entry(dashes)},
              {"strokeWidth", of_entry(widths)},
              {"stroke", colour},
              {"fill", colour},
              {"size", {{"value", 150}}}}}}}};
}

// A text for a plot without marks, which Vega-Lite would reject.
Json nothing_to_draw() {
  return {
      {"data", {{"values", Json::array({Json::object()})}}},
      {"mark", {{"type", "text"}, {"text", "no finite value to plot"}, {"fill", colour::prior}}},
      {"encoding", Json::object()}};
}

}  // namespace

Json plot(const std::string& description, const Axis& x, const Axis& y, std::vector<Json> marks,
          int height, bool zoom) {
  if (marks.empty()) {
    marks.push_back(nothing_to_draw());
    zoom = false;
  }
  const std::vector<Entry> entries = entries_of(marks);
  Json labels = Json::array(), colours = Json::array();
  for (const Entry& entry : entries) {
    labels.push_back(entry.label);
    colours.push_back(entry.colour);
  }
  const bool has_points = std::any_of(
      marks.begin(), marks.end(), [](const Json& each) { return each["mark"]["type"] == "point"; });
  for (Json& each : marks) {
    Json& encoding = each["encoding"];
    set_axis(encoding, "x", x, has_points);
    set_axis(encoding, "y", y, has_points);
    if (!encoding.contains("color")) continue;
    encoding["color"].update({{"type", "nominal"},
                              {"title", nullptr},
                              {"legend", legend_of(entries)},
                              {"scale", {{"domain", labels}, {"range", colours}}}});
    for (const char* paint : {"stroke", "fill", "color"}) each["mark"].erase(paint);
  }
  // Uses a mark with both axes, because a line across the plot has only one.
  const auto both = std::find_if(marks.begin(), marks.end(), [](const Json& each) {
    return each["encoding"].contains("x") && each["encoding"].contains("y");
  });
  if (zoom && both != marks.end()) {
    (*both)["params"] =
        Json::array({{{"name", "zoom"},
                      {"select", {{"type", "interval"}, {"zoom", "wheel![event.shiftKey]"}}},
                      {"bind", "scales"}}});
  }
  return {{"$schema", "https://vega.github.io/schema/vega-lite/v6.json"},
          {"description", description},
          {"width", "container"},
          {"height", height},
          {"layer", std::move(marks)}};
}

}  // namespace wearwell::plot
