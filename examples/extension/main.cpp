#include <wearwell/cli/program.h>
#include <wearwell/models/registry.h>

#include "drift/drift.h"

int main(int argc, char** argv) {
  const wearwell::Models known = wearwell::all_models();
  std::vector<wearwell::Model> models(known.begin(), known.end());
  models.push_back(drift::model());
  return wearwell::run_program(argc, argv, models);
}
