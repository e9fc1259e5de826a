# find_package(wearwell) gives
#
#   wearwell::wearwell   all of it: models, studies, results; and the program's own code
#   wearwell::engine     what knows no trade, no file and no screen: posteriors, samplers, quadrature, subset search
include(CMakeFindDependencyMacro)
list(PREPEND CMAKE_MODULE_PATH ${CMAKE_CURRENT_LIST_DIR})
find_dependency(Boost 1.74)
find_dependency(CLI11)
find_dependency(DuckDB)
find_dependency(Eigen3 3.4)
find_dependency(EXPAT)
find_dependency(LibZip)
find_dependency(OpenSSL COMPONENTS Crypto SSL)
find_dependency(TBB)
find_dependency(Threads)
find_dependency(UDUNITS2)
find_dependency(ZLIB)
find_dependency(fmt)
find_dependency(nlohmann_json)
find_dependency(tomlplusplus)
find_package(NLopt REQUIRED NAMES nlopt CONFIGS NLoptConfig.cmake)
list(POP_FRONT CMAKE_MODULE_PATH)
include(${CMAKE_CURRENT_LIST_DIR}/wearwellTargets.cmake)
