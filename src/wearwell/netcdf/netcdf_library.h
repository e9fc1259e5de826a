#pragma once

#include <netcdf.h>
#include <netcdf_mem.h>

namespace wearwell::netcdf {

/// The functions of libnetcdf that we call.
struct Library {
  decltype(&nc_create_mem) create_mem;
  decltype(&nc_close_memio) close_memio;
  decltype(&nc_abort) abort;
  decltype(&nc_def_grp) def_grp;
  decltype(&nc_def_dim) def_dim;
  decltype(&nc_def_var) def_var;
  decltype(&nc_def_var_deflate) def_var_deflate;
  decltype(&nc_put_att_text) put_att_text;
  decltype(&nc_put_var_double) put_var_double;
  decltype(&nc_put_var_longlong) put_var_longlong;
  decltype(&nc_put_var_schar) put_var_schar;
  decltype(&nc_put_var_string) put_var_string;
  decltype(&nc_strerror) strerror;
};

/// Loads it with the first call. Throws MachineError if it is not installed.
const Library& library();

}  // namespace wearwell::netcdf
