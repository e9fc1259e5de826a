#include "wearwell/present/html.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "wearwell/base/printable.h"
#include "wearwell/present/number.h"

namespace wearwell::html {
namespace {

// JSON inside a script element: escapes characters that could end the element, and line separators
// that old parsers reject in texts.
std::string script_safe(const std::string& json) {
  std::string out;
  out.reserve(json.size());
  for (std::size_t i = 0; i < json.size(); ++i) {
    const char c = json[i];
    if (c == '<' || c == '>' || c == '&') {
      out += fmt::format("\\u00{:02x}", c);
    } else if (json.compare(i, 3, "\u2028") == 0 || json.compare(i, 3, "\u2029") == 0) {
      out += json.compare(i, 3, "\u2028") == 0 ? "\\u2028" : "\\u2029";
      i += 2;
    } else {
      out += c;
    }
  }
  return out;
}

// The unit in brackets at the end of a name has a softer style.
std::string named(const std::string& text) {
  const std::size_t bracket = text.rfind(" [");
  if (bracket == text.npos || text.back() != ']') return escape(text);
  return fmt::format("{} <span class=\"unit\">{}</span>", escape(text.substr(0, bracket)),
                     escape(text.substr(bracket + 1)));
}

// Lines of a cell after the first are advice.
std::string cell(const std::string& text) {
  const std::size_t line = text.find('\n');
  if (line == text.npos) return named(text);
  return fmt::format("{}<br><em>{}</em>", named(text.substr(0, line)),
                     escape(text.substr(line + 1)));
}

// Words of a language fit into a column; names of files may have no end.
bool has_long_word(std::string_view text) {
  constexpr std::size_t longest = 16;
  std::size_t letters = 0;
  for (const char each : text) {
    const bool ends = each == ' ' || each == '\n' || each == '-';
    const bool follows = (static_cast<unsigned char>(each) & 0xc0) == 0x80;  // in UTF-8
    letters = ends ? 0 : letters + (follows ? 0 : 1);
    if (letters > longest) return true;
  }
  return false;
}

}  // namespace

std::string escape(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : printable(text, "\n\r\t")) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string number(double x, int digits) {
  return shown_number(x, digits, Script::page);
}

std::string given(double x) {
  return given_text(x, Script::page);
}

std::string raised(const std::string& text) {
  return powers_raised(text);
}

std::string unit(const std::string& text) {
  return unit_description(text, Script::page);
}

std::string quantity(double x, const std::string& unit_text, int digits) {
  const std::string u = unit(unit_text);
  return u.empty() ? number(x, digits) : number(x, digits) + "\u00a0" + u;
}

std::string range(double low, double high, int digits) {
  return range_text(low, high, digits, Script::page);
}

std::string tiles(const std::vector<Tile>& tiles) {
  std::string out = "<dl class=\"tiles\">\n";
  for (const Tile& tile : tiles) {
    out += fmt::format(
        "<div><dt>{}</dt><dd class=\"value\">{} <span>{}</span></dd><dd "
        "class=\"note\">{}</dd></div>\n",
        escape(tile.name), escape(tile.value), escape(tile.unit), escape(tile.note));
  }
  return out + "</dl>\n";
}

std::string callout(const std::string& kind, const std::string& word, const std::string& text) {
  return fmt::format("<p class=\"callout {}\"><strong>{}</strong> {}</p>\n", escape(kind),
                     escape(word), escape(text));
}

std::string table(const Table& table) {
  // A wide table scrolls separately, also by keyboard.
  std::string out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"group\" aria-label=\"{0}\">\n"
      "<table{1}><caption>{0}</caption>\n<thead><tr>",
      escape(table.caption), table.words ? " class=\"words\"" : "");
  const auto kind = [&](std::size_t column, std::string_view text) {
    const bool is_text = column < table.text.size() && table.text[column];
    return !is_text ? "" : has_long_word(text) ? " class=\"text long\"" : " class=\"text\"";
  };
  for (std::size_t c = 0; c < table.heading.size(); ++c) {
    out += fmt::format("<th scope=\"col\"{}>{}</th>", kind(c, table.heading[c]),
                       named(table.heading[c]));
  }
  out += "</tr></thead>\n<tbody>\n";
  for (std::size_t r = 0; r < table.rows.size(); ++r) {
    out += "<tr>";
    for (std::size_t c = 0; c < table.rows[r].size(); ++c) {
      const std::string& given = table.rows[r][c];
      const std::string text = cell(given);
      if (c == 0) {
        out += fmt::format("<th scope=\"row\"{}>{}</th>", kind(c, given), text);
      } else if (c == 1 && r < table.badges.size()) {
        out += fmt::format("<td><span class=\"badge {}\">{}</span></td>", escape(table.badges[r]),
                           text);
      } else {
        out += fmt::format("<td{}>{}</td>", kind(c, given), text);
      }
    }
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

namespace {

std::string plot_of(const Figure& figure) {
  return fmt::format("<div class=\"plot\"></div>\n<script type=\"application/json\">{}</script>\n",
                     script_safe(figure.specification.dump(
                         -1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

// The title is above the plot, the caption below.
std::string figure(const Figure& figure, bool wide) {
  return fmt::format(
      "<figure id=\"{}\"{}><figcaption><h3>{}</h3></figcaption>\n{}<p>{}</p></figure>\n",
      escape(figure.id), wide ? " class=\"wide\"" : "", escape(figure.title), plot_of(figure),
      escape(figure.caption));
}

std::string panel(const Figure& figure) {
  return fmt::format("<figure id=\"{}\"><figcaption><h4>{}</h4></figcaption>\n{}</figure>\n",
                     escape(figure.id), escape(figure.title), plot_of(figure));
}

// Whether a figure takes a whole row: on request, or without a neighbour in its row.
std::vector<bool> wide_ones(const std::vector<Figure>& figures) {
  std::vector<bool> wide(figures.size(), false);
  std::size_t in_row = 0;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    wide[i] = figures[i].wide || !figures[i].panel_of.empty();
    if (wide[i] && in_row == 1) wide[i - 1] = true;
    in_row = wide[i] ? 0 : (in_row + 1) % 2;
  }
  if (in_row == 1) wide.back() = true;
  return wide;
}

// The consecutive panels of one figure, up to `end`.
std::string panels(const std::vector<Figure>& figures, std::size_t first, std::size_t end) {
  std::string out =
      fmt::format("<div class=\"multiples\"><h3>{}</h3><p>{}</p>\n<div class=\"panels\">\n",
                  escape(figures[first].panel_of), escape(figures[first].caption));
  for (std::size_t i = first; i < end; ++i) out += panel(figures[i]);
  return out + "</div></div>\n";
}

}  // namespace

std::string figures(const std::vector<Figure>& figures) {
  std::string out = "<div class=\"figures\">\n";
  const std::vector<bool> wide = wide_ones(figures);
  for (std::size_t i = 0; i < figures.size();) {
    const std::string& group = figures[i].panel_of;
    std::size_t end = i + 1;
    while (!group.empty() && end < figures.size() && figures[end].panel_of == group) ++end;
    out += group.empty() ? figure(figures[i], wide[i]) : panels(figures, i, end);
    i = end;
  }
  return out + "</div>\n";
}

std::string details(const std::string& summary, const std::string& html) {
  return fmt::format("<details><summary>{}</summary>\n{}</details>\n", escape(summary), html);
}

std::string section(const std::string& id, const std::string& title, const std::string& html) {
  return fmt::format(
      "<section id=\"{0}\" aria-labelledby=\"{0}-title\"><h2 "
      "id=\"{0}-title\">{1}</h2>\n{2}</section>\n",
      escape(id), escape(title), html);
}

}  // namespace wearwell::html
