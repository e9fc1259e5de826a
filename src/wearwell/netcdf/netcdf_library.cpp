#include "wearwell/netcdf/netcdf_library.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "wearwell/base/error.h"

namespace wearwell::netcdf {
namespace {

template <class Function>
void find(void* library, const char* name, Function& function) {
  function = reinterpret_cast<Function>(dlsym(library, name));
  if (!function)
    throw MachineError(fmt::format("{} has no function {}", WEARWELL_NETCDF_SONAME, name));
}

Library load() {
  void* const handle = dlopen(WEARWELL_NETCDF_SONAME, RTLD_NOW | RTLD_LOCAL);
  if (!handle) {
    const char* const why = dlerror();
    throw MachineError(
        fmt::format("the library of NetCDF cannot be loaded (Debian: apt install libnetcdf19): {}",
                    why ? why : WEARWELL_NETCDF_SONAME));
  }
  Library library{};
  find(handle, "nc_create_mem", library.create_mem);
  find(handle, "nc_close_memio", library.close_memio);
  find(handle, "nc_abort", library.abort);
  find(handle, "nc_def_grp", library.def_grp);
  find(handle, "nc_def_dim", library.def_dim);
  find(handle, "nc_def_var", library.def_var);
  find(handle, "nc_def_var_deflate", library.def_var_deflate);
  find(handle, "nc_put_att_text", library.put_att_text);
  find(handle, "nc_put_var_double", library.put_var_double);
  find(handle, "nc_put_var_longlong", library.put_var_longlong);
  find(handle, "nc_put_var_schar", library.put_var_schar);
  find(handle, "nc_put_var_string", library.put_var_string);
  find(handle, "nc_strerror", library.strerror);
  return library;
}

}  // namespace

const Library& library() {
  static const Library loaded = load();
  return loaded;
}

}  // namespace wearwell::netcdf
