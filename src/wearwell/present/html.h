#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

/// The pieces of a page. Text goes in as it is, wherever it came from, and is escaped here and
/// nowhere else; only what is called `html` is markup.
namespace wearwell::html {

/// For `html` that is put together elsewhere. Control characters are shown as "\x1b".
std::string escape(const std::string& text);

/// With a capital at the beginning.
std::string capital(std::string text);

/// 4 significant digits as people write them: "0.7759", "21 600", "7.759 × 10⁻⁴"; "–" for what is
/// not finite.
std::string number(double x, int digits = 4);

/// A number that was given, not estimated: all its digits, "20 585".
std::string given(double x);

/// Powers raised: "5 mm³" of "5 mm^3".
std::string raised(const std::string& text);

/// "mm³/(N m)" of "mm^3/(N m)", in one piece; empty for "1".
std::string unit(const std::string& text);

/// A number and its unit.
std::string quantity(double x, const std::string& unit_text, int digits = 4);

/// "6.25 to 9.20 × 10⁻⁴": two numbers with one power of ten.
std::string range(double low, double high, int digits = 4);

/// One key figure: what, how much, and what to know of it.
struct Tile {
  std::string name, value, unit, note;
};
std::string tiles(const std::vector<Tile>& tiles);

/// A paragraph that stands out; `kind` is "pass", "warn" or "fail", `word` says the same.
std::string callout(const std::string& kind, const std::string& word, const std::string& text);

/// A table with its caption; the first cell of each row names the row. Headings and cells are text:
/// "k [mm³]" has its unit in softer print, a second line is emphasized.
struct Table {
  std::string caption;
  std::vector<std::string> heading;
  std::vector<std::vector<std::string>> rows;
  bool words = false;                    ///< cells are sentences, not numbers
  std::vector<std::string> badges = {};  ///< "pass", "warn" or "fail" of each row, if any: its
                                         ///< second cell is painted so
  std::vector<bool> text = {};           ///< columns of text, which begin at the left and may wrap
};
std::string table(const Table& table);

/// A plot: title, what to see in it, and its Vega-Lite specification.
struct Figure {
  std::string id, title, caption;
  nlohmann::ordered_json specification;
  /// The title of small multiples, of which this is one; their caption is that of the first.
  std::string panel_of = {};
  bool wide = false;  ///< takes a row for itself
};

/// Figures side by side, two in a row where there is room; one without a neighbour takes the row.
/// Neighbours with one `panel_of` are small and stand under one title.
std::string figures(const std::vector<Figure>& figures);

/// What is shown on request.
std::string details(const std::string& summary, const std::string& html);

std::string section(const std::string& id, const std::string& title, const std::string& html);

}  // namespace wearwell::html
