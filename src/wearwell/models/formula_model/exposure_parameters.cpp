#include "wearwell/models/formula_model/exposure_parameters.h"

#include <fmt/format.h>

namespace wearwell::formula_model {

using formula::Op;

bool depends_on(const formula::Graph& graph, int root, const ChangingStress& stress) {
  std::vector<bool> all(static_cast<std::size_t>(root) + 1);
  const auto at = [&](int i) { return i >= 0 && all[static_cast<std::size_t>(i)]; };
  for (int i = 0; i <= root; ++i) {
    const formula::Node& node = graph[i];
    const bool is_it = stress.label ? (node.op == Op::label_is && node.index == stress.index) ||
                                          (node.op == Op::pick && node.level == stress.index)
                                    : node.op == Op::column && node.index == stress.index;
    all[static_cast<std::size_t>(i)] = is_it || at(node.a) || at(node.b) || at(node.c);
  }
  return all.back();
}

void require_scale_alone(const TomlReader& likelihood, const char* key, const std::string& scale,
                         const formula::WrittenGraph& written,
                         const std::vector<formula::Wanted>& wanted,
                         const std::set<std::size_t>& may, const ChangingStress& stress) {
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    if (!may.contains(i) && depends_on(written.graph, written.roots[i], stress))
      likelihood.fail(key, fmt::format("{} depends on '{}'; cumulative exposure needs a "
                                       "distribution of which only the {} does",
                                       wanted[i].name, stress.name, scale));
  }
}

}  // namespace wearwell::formula_model
