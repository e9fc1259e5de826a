# NETCDF_INCLUDE_DIR and NETCDF_SONAME: its headers, and the name under which the program loads it when it needs it.
find_path(NETCDF_INCLUDE_DIR netcdf_mem.h)
find_library(NETCDF_LIBRARY netcdf)
if(NETCDF_LIBRARY)
  # libnetcdf.so -> libnetcdf.so.19
  get_filename_component(NETCDF_FILE ${NETCDF_LIBRARY} REALPATH)
  get_filename_component(NETCDF_SONAME ${NETCDF_FILE} NAME)
  string(REGEX REPLACE "(\\.so\\.[0-9]+).*" "\\1" NETCDF_SONAME ${NETCDF_SONAME})
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(NetCDF
  REQUIRED_VARS NETCDF_SONAME NETCDF_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "run setup/install")
