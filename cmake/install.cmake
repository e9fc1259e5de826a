# `cmake --install`: the program with its manual page and completions, the libraries with their headers, and the package for find_package(wearwell). Examples that
# use it: examples/cpp.

# What other programs link.
add_library(wearwell_engine INTERFACE)
target_link_libraries(wearwell_engine INTERFACE wearwell_infer wearwell_predict wearwell_regress)
add_library(wearwell_wearwell INTERFACE)
target_link_libraries(wearwell_wearwell INTERFACE wearwell_cli wearwell_models wearwell_engine)
foreach(name engine wearwell)
  set_target_properties(wearwell_${name} PROPERTIES EXPORT_NAME ${name})
  add_library(wearwell::${name} ALIAS wearwell_${name})
endforeach()

get_property(libraries GLOBAL PROPERTY wearwell_libraries)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/wearwell)
set(third_party ${CMAKE_INSTALL_LIBDIR}/wearwell)  # DuckDB, which Debian does not package
set_target_properties(wearwell PROPERTIES INSTALL_RPATH "$ORIGIN/../${third_party}")
install(TARGETS wearwell RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
# The program knows its commands best: it writes what stands beside it.
set(share ${PROJECT_BINARY_DIR}/share)
install(CODE "
  file(MAKE_DIRECTORY ${share})
  foreach(each man:wearwell.1 bash:wearwell zsh:_wearwell)
    string(REGEX MATCH \"^[a-z]+\" what \${each})
    string(REGEX REPLACE \"^[a-z]+:\" \"\" name \${each})
    execute_process(COMMAND $<TARGET_FILE:wearwell> generate \${what}
      OUTPUT_FILE ${share}/\${name} COMMAND_ERROR_IS_FATAL ANY)
  endforeach()" COMPONENT program)
install(FILES ${share}/wearwell.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 COMPONENT program)
install(FILES ${share}/wearwell DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions COMPONENT program)
install(FILES ${share}/_wearwell DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions COMPONENT program)
install(TARGETS ${libraries} wearwell_engine wearwell_wearwell EXPORT wearwell
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(EXPORT wearwell NAMESPACE wearwell:: DESTINATION ${package} FILE wearwellTargets.cmake)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/src/wearwell DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}
  FILES_MATCHING PATTERN "*.h")
install(FILES ${DuckDB_LIBRARY} DESTINATION ${third_party} COMPONENT program)
install(FILES ${DuckDB_INCLUDE_DIR}/duckdb.h DESTINATION ${third_party})
install(FILES ${PROJECT_SOURCE_DIR}/setup/package/wearwell-monitor@.service DESTINATION lib/systemd/system
  COMPONENT service EXCLUDE_FROM_ALL)  # it names /usr/bin
install(FILES ${PROJECT_SOURCE_DIR}/setup/package/grafana.json DESTINATION ${CMAKE_INSTALL_DATADIR}/wearwell COMPONENT program)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/wearwell COMPONENT program RENAME copyright)
install(FILES ${PROJECT_SOURCE_DIR}/NOTICE DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/wearwell COMPONENT program)

include(CMakePackageConfigHelpers)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/wearwellConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES
  ${PROJECT_SOURCE_DIR}/cmake/wearwellConfig.cmake ${PROJECT_BINARY_DIR}/wearwellConfigVersion.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindDuckDB.cmake ${PROJECT_SOURCE_DIR}/cmake/FindLibZip.cmake
  ${PROJECT_SOURCE_DIR}/cmake/FindMosquitto.cmake ${PROJECT_SOURCE_DIR}/cmake/FindPqxx.cmake ${PROJECT_SOURCE_DIR}/cmake/FindUDUNITS2.cmake
  DESTINATION ${package})
