# DuckDB::DuckDB: the one that was installed with wearwell, one of the machine, else what setup/install brought from npm.
set(installed ${CMAKE_CURRENT_LIST_DIR}/../../wearwell)
set(npm ${CMAKE_CURRENT_LIST_DIR}/../setup/node_modules)
find_path(DuckDB_INCLUDE_DIR duckdb.h PATH_SUFFIXES src/duckdb/src/include HINTS ${installed} ${npm}/duckdb)
find_library(DuckDB_LIBRARY duckdb HINTS ${installed} ${npm}/@duckdb/node-bindings-linux-x64)

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(DuckDB
  REQUIRED_VARS DuckDB_LIBRARY DuckDB_INCLUDE_DIR
  REASON_FAILURE_MESSAGE "run setup/install")

if(DuckDB_FOUND AND NOT TARGET DuckDB::DuckDB)
  add_library(DuckDB::DuckDB SHARED IMPORTED)
  set_target_properties(DuckDB::DuckDB PROPERTIES
    IMPORTED_LOCATION ${DuckDB_LIBRARY}
    IMPORTED_NO_SONAME ON
    INTERFACE_INCLUDE_DIRECTORIES ${DuckDB_INCLUDE_DIR})
endif()
