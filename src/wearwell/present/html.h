#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// The elements of a page. Text is untrusted and is escaped here; only arguments named `html` are
/// markup.
namespace wearwell::html {

/// Escapes text for `html` that is assembled elsewhere. Control characters become "\x1b".
std::string escape(const std::string& text);

/// Capitalizes the first letter.
std::string capital(std::string text);

/// 4 significant digits in readable form: "0.7759", "21 600", "7.759 × 10⁻⁴"; "–" if not finite.
std::string number(double x, int digits = 4);

/// A given number with all digits: "20 585".
std::string given(double x);

/// Powers raised: "5 mm³" of "5 mm^3".
std::string raised(const std::string& text);

/// "mm³/(N m)" of "mm^3/(N m)", without breaks; empty for "1".
std::string unit(const std::string& text);

/// A number and its unit.
std::string quantity(double x, const std::string& unit_text, int digits = 4);

/// "6.25 to 9.20 × 10⁻⁴": two numbers, see `range_text`.
std::string range(double low, double high, int digits = 4);

/// A key figure: name, value and remark.
struct Tile {
  std::string name, value, unit, note;
};
std::string tiles(const std::vector<Tile>& tiles);

/// A highlighted paragraph; `kind` is "pass", "warn" or "fail", `word` is its label.
std::string callout(const std::string& kind, const std::string& word, const std::string& text);

/// A table with its caption; the first cell of each row names the row. Headings and cells are text:
/// "k [mm³]" has its unit in a softer style, a second line is emphasized.
struct Table {
  std::string caption;
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
  bool words = false;                    ///< cells are sentences, not numbers
  std::vector<std::string> badges = {};  ///< "pass", "warn" or "fail" of each row, if any: its
                                         ///< second cell is painted so
  std::vector<bool> text = {};           ///< columns of text, left-aligned and wrapped
};
std::string table(const Table& table);

/// A plot: title, caption, and Vega-Lite specification.
struct Figure {
  std::string id, title, caption;
  nlohmann::ordered_json specification;
  /// The title of the small multiples to which this plot belongs; their caption is that of the
  /// first.
  std::string panel_of = {};
  bool wide = false;  ///< takes a whole row
};

/// Figures side by side, two per row if there is room; one without a neighbour takes the row.
/// Neighbours with the same `panel_of` are small and share a title.
std::string figures(const std::vector<Figure>& figures);

/// A collapsible block.
std::string details(const std::string& summary, const std::string& html);

std::string section(const std::string& id, const std::string& title, const std::string& html);

}  // namespace wearwell::html
