#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The pieces of which every plot is composed: marks over two axes, written as a Vega-Lite
/// specification that holds its own data and can be pasted into the Vega editor.
namespace wearwell::plot {

using Json = nlohmann::ordered_json;

/// Colours that stand out on white and on near black alike.
namespace colour {
inline constexpr const char* posterior = "#2f7fd6";
inline constexpr const char* wide = "#6fa8dc";  ///< the wider of two bands
inline constexpr const char* prior = "#8a8f98";
inline constexpr const char* measured = "#e0592a";
inline constexpr const char* limit = "#c2417c";
inline constexpr const char* chains[] = {"#2f7fd6", "#d9822b", "#2e9e6b", "#9a6dd7"};
}  // namespace colour

struct Axis {
  std::string title;
  bool logarithmic = false;
  std::optional<double> low = {}, high = {};  ///< what lies outside is cut off; none if not finite
  std::vector<std::string> names = {};        ///< instead of numbers, at 1, 2, ...
  bool numbers = true;                        ///< false: a density, whose numbers say nothing
  /// Ticks at these places with these names, instead of numbers: shares on probability paper.
  std::vector<std::pair<double, std::string>> ticks = {};
};

/// Named columns of equal length.
using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

/// How a mark looks, and its entry in the legend (none when `label` is empty).
struct Look {
  std::string colour;
  std::string label = {};
  double opacity = 1;
  double width = 2;  ///< of lines, in pixels
  bool dashed = false;
  double size = 50;  ///< of points, in square pixels
};

/// Marks: each takes columns x and y, or what it names, and further ones for its tooltip.
Json line(const Columns& data, const Look& look);
Json steps(const Columns& data, const Look& look);  ///< a histogram's outline
/// From y2 (0 where there is none) to y; from x2 to x where there is an x2 instead.
Json area(const Columns& data, const Look& look);
Json points(const Columns& data, const Look& look);
/// Points with a direction: "triangle-right" for what went on unseen, "triangle-left" for what was
/// over before.
Json arrows(const Columns& data, const std::string& shape, const Look& look);
Json ranges(const Columns& data, const Look& look);  ///< an upright stroke from y to y2 at x
Json cells(const Columns& data, const Look& look);   ///< x to x2, y to y2, opacity by `density`
/// The same with `density` a number from `low` to `high`, and a scale that shows which.
struct Shade {
  std::string title;
  double low = 0, high = 1;
};
Json heat_map(const Columns& data, const Look& look, const Shade& shade);
Json vertical_line(double x, const Look& look);  ///< a line across the plot
Json horizontal_line(double y, const Look& look);
Json text(double x, double y, const std::string& words, const std::string& colour);

/// The specification; without marks it says that there is no finite value to draw. `description` is what a screen reader says of it. `zoom`: wheel with Shift
/// and dragging move the axes.
Json plot(const std::string& description, const Axis& x, const Axis& y, std::vector<Json> marks,
          int height = 280, bool zoom = false);

}  // namespace wearwell::plot
