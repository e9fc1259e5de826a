#include "wearwell/present/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <iterator>

#include "wearwell/base/printable.h"

namespace wearwell::plot {
namespace {

// The name of a column as CSV and Vega take it whole: a comma would make two of it, a point or a
// bracket something inside of it.
std::string in_heading(const std::string& text) {
  std::string name = printable(text);
  for (char& c : name) {
    if (std::strchr(",.[]\"'\\", c)) c = ' ';
  }
  return name;
}

// Six digits are more than a plot shows; CSV is the shortest way to write many numbers.
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
  // What is named by more than a letter is meant for people.
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
  if (axis.low) json["domainMin"] = *axis.low;
  if (axis.high) json["domainMax"] = *axis.high;
  if (!axis.names.empty()) {
    json["domain"] = {0.5, static_cast<double>(axis.names.size()) + 0.5};
    json["nice"] = false;
  }
  return json;
}

Json ticks(const char* channel, const Axis& axis) {
  if (!axis.names.empty()) {
    std::vector<double> values;
    for (std::size_t i = 1; i <= axis.names.size(); ++i) values.push_back(static_cast<double>(i));
    return {{"values", values},
            {"grid", false},
            {"labelOverlap", false},
            {"labelAngle", axis.names.size() > 8 && channel[0] == 'x' ? -60 : 0},
            {"tickCount", values.size() + 1},
            {"labelExpr", Json(axis.names).dump() + "[datum.value - 1]"}};
  }
  if (!axis.numbers) return {{"labels", false}, {"ticks", false}, {"grid", false}};
  if (axis.logarithmic) return {{"format", "~g"}, {"tickCount", 5}};
  return {{"format", ",~r"}};
}

void set_axis(Json& encoding, const char* channel, const Axis& axis) {
  if (!encoding.contains(channel)) return;
  Json& each = encoding[channel];
  each["type"] = "quantitative";
  each["title"] = axis.title;
  each["scale"] = scale(axis);
  each["axis"] = ticks(channel, axis);
}

}  // namespace

Json line(const Columns& data, const Look& look) {
  return layer(data, stroke("line", look), look);
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

Json plot(const std::string& description, const Axis& x, const Axis& y, std::vector<Json> marks,
          int height, bool zoom) {
  Json labels = Json::array(), colours = Json::array(), legend = Json::object();
  bool lines = true;
  for (const Json& each : marks) {
    if (!each["encoding"].contains("color")) continue;
    const Json& label = each["encoding"]["color"]["datum"];
    if (std::find(labels.begin(), labels.end(), label) != labels.end()) continue;
    labels.push_back(label);
    for (const char* paint : {"stroke", "fill", "color"}) {
      if (each["mark"].contains(paint)) colours.push_back(each["mark"][paint]);
    }
    lines = lines && each["mark"].contains("stroke");
  }
  if (lines) legend = {{"symbolType", "stroke"}, {"symbolStrokeWidth", 3}};
  for (Json& each : marks) {
    Json& encoding = each["encoding"];
    set_axis(encoding, "x", x);
    set_axis(encoding, "y", y);
    if (!encoding.contains("color")) continue;
    encoding["color"].update({{"type", "nominal"},
                              {"title", nullptr},
                              {"legend", legend},
                              {"scale", {{"domain", labels}, {"range", colours}}}});
    for (const char* paint : {"stroke", "fill", "color"}) each["mark"].erase(paint);
  }
  if (zoom) {
    marks.front()["params"] =
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
