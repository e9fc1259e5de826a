// A path in two parts, the second going on from where the first ends, is the path in one.
#include <gtest/gtest.h>

#include <cmath>

#include "formula/laboratory.h"

namespace wearwell::formula {
namespace {

struct Parts {
  double whole = 0, parts = 0;
  Running running;
};

// The last of three rows.
Parts last_row(const Laboratory& laboratory, const std::string& text) {
  const Program program = compile(laboratory.lines, {{"output", text}}, laboratory.symbols, true);
  Parts result;
  result.running = program.running();
  Rows rows = laboratory.rows();
  const Data all = program.bind(rows);
  Workspace workspace = program.workspace(3);
  const std::vector<const double*> by_row = laboratory.pointers();
  program.forward(all, 0, 3, {laboratory.parameters, by_row}, workspace);
  result.whole = workspace.values(0).back();
  program.forward(all, 0, 2, {laboratory.parameters, by_row}, workspace);
  std::vector<double> stands(result.running.count);
  program.carry(workspace, 1, stands);
  rows.paths = {0, 1, 2};
  rows.from = {0, 0, laboratory.columns[3][1]};
  const Data ahead = program.bind(rows);
  std::vector<const double*> carried, last;
  for (const double& each : stands) carried.push_back(&each);
  for (const auto& each : laboratory.by_row) last.push_back(&each[2]);
  program.forward(ahead, 2, 3, {laboratory.parameters, last, carried}, workspace);
  result.parts = workspace.values(0).back();
  return result;
}

TEST(Continue, WhatRunsAlongAPathGoesOnFromWhereItStood) {
  Laboratory laboratory;
  laboratory.parameters[3] = 5e-12;
  // In closed form; of the data alone; linear in the state; by steps; from the first row on.
  const std::vector<std::vector<Line>> kinds = {
      {{"d(depth)/d(distance)", "k * force / area"}},
      {{"d(depth)/d(distance)", "1e-7 * force / 1 [N]"}, {"depth(0)", "1 [um]"}},
      {{"d(depth)/d(distance)", "k * force/area * (1 - depth/h0)"}},
      {{"d(depth)/d(distance)", "k * force/area * (1 - (depth/h0)^2)"}, {"depth(0)", "a * 1 [um]"}},
      {{"d(depth)/d(distance)", "k * force/area * exp(-depth/h0)"}, {"depth(first)", "2 [um]"}},
      {{"d(depth)/d(distance)", "k * force/area * distance/1 [m]"}}};
  for (const auto& lines : kinds) {
    laboratory.lines = lines;
    const Parts parts = last_row(laboratory, "depth + u * 0 [m]");
    EXPECT_EQ(parts.running.count, 1u);
    EXPECT_FALSE(parts.running.sums);
    EXPECT_NEAR(parts.parts / parts.whole, 1, 1e-10) << lines.front().text;
  }
  laboratory.lines = {};
  const Parts sum = last_row(laboratory, "cum(a * force) + cum(x) * 1 [N]");
  EXPECT_EQ(sum.running.count, 2u);
  EXPECT_TRUE(sum.running.sums);
  EXPECT_FALSE(sum.running.nested);
  EXPECT_DOUBLE_EQ(sum.parts, sum.whole);
  EXPECT_TRUE(last_row(laboratory, "cum(cum(x))").running.nested);
}

// A row may stand for many.
TEST(Continue, RowsAheadAreCounted) {
  Laboratory laboratory;
  laboratory.lines = {{"d(depth)/d(distance)", "1e-7 * force / 1 [N]"}};
  const Program program = compile(laboratory.lines, {{"sum", "cum(a * force)"}, {"state", "depth"}},
                                  laboratory.symbols, true);
  Rows rows = laboratory.rows();
  rows.paths = {0, 1, 2};
  rows.from = {0, 0, 0};
  rows.repeats = {1, 2.5, 10};
  const Data data = program.bind(rows);
  Workspace workspace = program.workspace(3);
  program.forward(data, 0, 3, {laboratory.parameters, laboratory.pointers()}, workspace);
  EXPECT_DOUBLE_EQ(workspace.values(0)[1], 0.7 * 20 * 2.5);
  EXPECT_DOUBLE_EQ(workspace.values(0)[2], 0.7 * 30 * 10);
  EXPECT_DOUBLE_EQ(workspace.values(1)[2], 1e-7 * 30 * 4);  // a state has no rows
}

}  // namespace
}  // namespace wearwell::formula
