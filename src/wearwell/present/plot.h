#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The elements of plots: marks over two axes, as a self-contained Vega-Lite specification that can
/// be pasted into the Vega editor.
namespace wearwell::plot {

using Json = nlohmann::ordered_json;

/// Colors with sufficient contrast on white and on near black.
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
  std::optional<double> low = {}, high = {};  ///< range of the axis; content outside is clipped;
                                              ///< automatic if not finite
  std::vector<std::string> names = {};        ///< instead of numbers, at 1, 2, ...
  bool numbers = true;                        ///< false: a density without meaningful numbers
  /// Ticks at these positions with these names instead of numbers: fractions on probability paper.
  std::vector<std::pair<double, std::string>> ticks = {};
};

/// Named columns of equal length.
using Columns = std::vector<std::pair<std::string, std::vector<double>>>;

/// The style of a mark, and its legend entry (none if `label` is empty).
struct Look {
  std::string colour;
  std::string label = {};
  double opacity = 1;
  double width = 2;  ///< of lines, in pixels
  bool dashed = false;
  double size = 50;  ///< of points, in square pixels
};

/// Marks use columns x and y, or the named ones, and further columns for tooltips.
Json line(const Columns& data, const Look& look);
Json steps(const Columns& data, const Look& look);  ///< a histogram's outline
/// From y2 (default 0) to y; or from x2 to x if there is an x2.
Json area(const Columns& data, const Look& look);
Json points(const Columns& data, const Look& look);
/// Points with a direction: "triangle-right" for right-censored, "triangle-left" for left-censored
/// data.
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

/// The specification; without marks it shows a message. `description` is for screen readers.
/// `zoom`: Shift + wheel and dragging change the axes.
Json plot(const std::string& description, const Axis& x, const Axis& y, std::vector<Json> marks,
          int height = 280, bool zoom = false);

}  // namespace wearwell::plot
