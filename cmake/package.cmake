# `make package`: a Debian package of the program with its manual page, completions, DuckDB, and a service for monitors. The library is not in it.
get_filename_component(duckdb_folder ${DuckDB_LIBRARY} DIRECTORY)
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME wearwell)
set(CPACK_PACKAGE_CONTACT "The wearwell authors <wearwell@localhost>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Wear and fatigue-life parameters from few measurements, and remaining life")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program service)
set(CPACK_COMPONENTS_GROUPING ALL_COMPONENTS_IN_ONE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_PACKAGE_NAME wearwell)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${duckdb_folder})
set(CPACK_DEBIAN_PACKAGE_DEPENDS "passwd")  # useradd, for postinst
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libnetcdf19")  # loaded where it is used: fit --netcdf
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA
  "${PROJECT_SOURCE_DIR}/setup/package/postinst;${PROJECT_SOURCE_DIR}/setup/package/prerm;${PROJECT_SOURCE_DIR}/setup/package/postrm")
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE zstd)
include(CPack)
