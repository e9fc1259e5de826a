#include <numeric>
#include <utility>

#include "wearwell/models/formula_model/node_rows.h"

// What a reading is predicted to be, at the nodes that the prediction needs.
namespace wearwell::formula_model {
namespace {

// The nodes of a sample, each with parameters of its own.
Nodes nodes_of(const Nodes& nodes, const NodeRows::Sample& sample) {
  const std::size_t count = sample.node.size();
  Points parameters(static_cast<Eigen::Index>(count), nodes.parameters->cols());
  for (std::size_t i = 0; i < count; ++i)
    parameters.row(static_cast<Eigen::Index>(i)) =
        nodes.parameters->row(static_cast<Eigen::Index>(sample.node[i] / nodes.per_line));
  Nodes some;
  some.parameters = std::make_shared<const Points>(std::move(parameters));
  for (std::size_t e = 0; e < std::size(nodes.effect); ++e) {
    if (nodes.effect[e].empty()) continue;
    for (const std::size_t node : sample.node) some.effect[e].push_back(nodes.effect[e][node]);
  }
  return some;
}

}  // namespace

ReadingPrediction NodeRows::predict(const Nodes& nodes, const UnitReading& reading,
                                    const std::vector<NodePath>& before,
                                    const Sample& sample) const {
  ReadingPrediction prediction;
  // Of most nodes together, lines share what nodes of their own would repeat.
  if (follows_ || 2 * sample.node.size() > nodes.count()) {
    look(nodes, reading, before, nullptr, {}, &sample, &prediction);
    return prediction;
  }
  Sample all{std::vector<std::size_t>(sample.node.size()), sample.weight};
  std::iota(all.node.begin(), all.node.end(), std::size_t{0});
  look(nodes_of(nodes, sample), reading, before, nullptr, {}, &all, &prediction);
  return prediction;
}

}  // namespace wearwell::formula_model
