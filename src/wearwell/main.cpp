#include "wearwell/cli/program.h"
#include "wearwell/models/registry.h"

int main(int argc, char** argv) {
  return wearwell::run_program(argc, argv, wearwell::all_models());
}
