# DuckDB::DuckDB: an installed libduckdb first, else the one that setup/install brought from npm.
set(npm ${PROJECT_SOURCE_DIR}/setup/node_modules)
find_path(DuckDB_INCLUDE_DIR duckdb.h PATH_SUFFIXES src/duckdb/src/include HINTS ${npm}/duckdb)
find_library(DuckDB_LIBRARY duckdb HINTS ${npm}/@duckdb/node-bindings-linux-x64)

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
