#include "wearwell/study/result.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "wearwell/base/printable.h"
#include "wearwell/input/table.h"
#include "wearwell/present/page.h"
#include "wearwell/present/text_table.h"
#include "wearwell/study/header_json.h"
#include "wearwell/study/trust_blocks.h"

namespace wearwell {

std::string Header::Data::names() const {
  return fmt::format("{}", fmt::join(files, ", "));
}

nlohmann::ordered_json summary_json(const Result& result) {
  nlohmann::ordered_json json = to_json(result.header);
  json.update(result.body, true);
  return json;
}

std::string terminal_text(const Result& result, const TerminalStyle& style) {
  if (result.text) return result.text(style);
  const Header& header = result.header;
  const std::string trust = wrapped(printable(trust_line(header.checks)), 0, 2);
  std::string out =
      wrapped(printable(header.title), 0, 2) + wrapped(printable(header.equation), 2, 4) +
      wrapped(fmt::format("{}: {} rows", printable(header.data.names()), header.data.rows) +
                  printable(remarks_suffix(header.data.remarks)),
              2, 4) +
      "\n" + trust;
  for (const present::Table* table : present::tables(result.sections)) {
    if (table->id != "checks") out += "\n" + present::text(*table);
  }
  return out + "\nChecks\n" + checks_text(header.checks) + "\n" + trust;
}

std::string report_html(const Header& header, const std::vector<present::Section>& sections) {
  return html_page({header.version, header.title,
                    fmt::format("{}, {} rows of {}{}", header.model, header.data.rows,
                                header.data.names(), remarks_suffix(header.data.remarks)),
                    sections});
}

}  // namespace wearwell
