# Files that the program carries with it.
#
#   wearwell_resource(report page_css page.css)
#
# puts the file into the library wearwell_report as `std::string_view wearwell::resource::page_css()`, and its SHA-256 in
# hexadecimal digits as `page_css_sha256()`.
function(wearwell_resource library name file)
  get_filename_component(path ${file} ABSOLUTE)
  if(NOT EXISTS ${path})
    message(FATAL_ERROR "no ${path}; run setup/install")
  endif()
  set(source ${CMAKE_CURRENT_BINARY_DIR}/${name}_resource.cpp)
  file(SHA256 ${path} sha256)
  set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${path})
  configure_file(${PROJECT_SOURCE_DIR}/cmake/resource.cpp.in ${source} @ONLY)
  set_source_files_properties(${source} PROPERTIES OBJECT_DEPENDS ${path})
  target_sources(wearwell_${library} PRIVATE ${source})
endfunction()
