#include "core.h"

extern "C" __attribute__((visibility("default"))) void R_init_wearwell(DllInfo* library) {
  static wearwell::r::Doors doors = [] {
    wearwell::r::Doors all;
    wearwell::r::add_tables(all);
    wearwell::r::add_studies(all);
    wearwell::r::add_plans(all);
    wearwell::r::add_followed(all);
    wearwell::r::add_tools(all);
    all.push_back({nullptr, nullptr, 0});
    return all;
  }();
  R_registerRoutines(library, nullptr, doors.data(), nullptr, nullptr);
  R_useDynamicSymbols(library, FALSE);
}
