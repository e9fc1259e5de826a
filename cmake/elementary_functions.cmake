# wearwell_elementary: exp, log, pow, sin, lgamma, ... from musl's C library, linked into everything before libm.
#
# glibc chooses a variant of these by processor (with or without fused multiply-add), and the variants differ in the last bit; so do the
# x87 instructions behind long double. musl has one variant for every x86-64 processor, as accurate as glibc's. What wearwell, Boost.Math,
# Eigen and the C++ library call by name is found here first. floor, sqrt and others that are exact on every processor stay with libm;
# tests/numbers holds the list of what the program still imports from it.
find_file(MUSL_ARCHIVE libc.a
  PATHS /usr/lib/${CMAKE_SYSTEM_PROCESSOR}-linux-musl /usr/local/musl/lib /usr/lib/musl/lib NO_DEFAULT_PATH REQUIRED)

set(elementary_members
  acos acosh asin asinh atan atan2 atanh cbrt cos cosh erf exp exp10 exp2 expm1 hypot lgamma lgamma_r log log10 log1p log2 pow sin
  sincos sinh tan tanh tgamma
  # what these are made of
  __cos __expo2 __math_divzero __math_invalid __math_oflow __math_uflow __math_xflow __rem_pio2 __rem_pio2_large __sin __tan exp_data
  log2_data log_data pow_data scalbn signgam)
list(TRANSFORM elementary_members APPEND .lo)
set(elementary_folder ${PROJECT_BINARY_DIR}/elementary)
file(MAKE_DIRECTORY ${elementary_folder})
execute_process(COMMAND ${CMAKE_AR} xo ${MUSL_ARCHIVE} ${elementary_members}
  WORKING_DIRECTORY ${elementary_folder} COMMAND_ERROR_IS_FATAL ANY)
set(elementary_objects)
foreach(member ${elementary_members})
  set(object ${elementary_folder}/${member})
  set_source_files_properties(${object} PROPERTIES EXTERNAL_OBJECT ON GENERATED ON)
  list(APPEND elementary_objects ${object})
endforeach()
add_library(wearwell_elementary STATIC ${elementary_objects})
set_target_properties(wearwell_elementary PROPERTIES LINKER_LANGUAGE CXX EXPORT_NAME elementary)
set_property(GLOBAL APPEND PROPERTY wearwell_libraries wearwell_elementary)

# Boost.Math would compute in long double, whose functions are libm's.
target_compile_definitions(wearwell_elementary INTERFACE BOOST_MATH_PROMOTE_DOUBLE_POLICY=false)
