#include "wearwell/models/ownlaw/model.h"

#include "wearwell/models/ownlaw/own_study.h"

namespace wearwell {
namespace resource {

std::string_view law_study();
std::string_view law_data();

}  // namespace resource

namespace ownlaw {

Model model() {
  static constexpr ExampleFile example[] = {{"study.toml", resource::law_study},
                                            {"wear.csv", resource::law_data}};
  return {.key = "law",
          .trade = "law",
          .example = example,
          .read =
              [](const TomlReader& root, const Source& source) {
                return read_posterior_study(root, source, read_law_study);
              },
          .add_commands = nullptr};
}

}  // namespace ownlaw
}  // namespace wearwell
