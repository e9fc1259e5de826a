#include "wearwell/embed/answer.h"

#include "wearwell/base/printable.h"
#include "wearwell/present/page.h"

namespace wearwell::embed {
namespace {

// Options in the texts of a page as arguments.
void rename(std::vector<present::Block>& blocks, const PlanArguments& arguments) {
  const auto renamed = [&](std::string& text) { text = arguments.in_arguments(text); };
  for (present::Block& block : blocks) {
    if (auto* const prose = std::get_if<present::Prose>(&block.content)) {
      renamed(prose->text);
    } else if (auto* const callout = std::get_if<present::Callout>(&block.content)) {
      renamed(callout->text);
    } else if (auto* const facts = std::get_if<present::Facts>(&block.content)) {
      for (auto& [name, value] : facts->facts) renamed(name), renamed(value);
    } else if (auto* const figures = std::get_if<present::Figures>(&block.content)) {
      for (html::Figure& figure : figures->figures) renamed(figure.caption);
    } else if (auto* const details = std::get_if<present::Details>(&block.content)) {
      renamed(details->summary);
      rename(details->blocks, arguments);
    }
  }
}

}  // namespace

Answer shown(plan::Answer answer, const std::string& heading, const PlanArguments& arguments) {
  for (present::Section& section : answer.sections) rename(section.blocks, arguments);
  Answer result{answer.title,
                arguments.in_arguments(answer.text),
                printable_json(answer.json.dump(2)) + "\n",
                {},
                html_page({WEARWELL_VERSION, heading, answer.title, answer.sections}),
                answer.trusted};
  for (const present::Table* table : present::tables(answer.sections))
    result.tables.emplace_back(table->id, present::csv(*table));
  return result;
}

}  // namespace wearwell::embed
