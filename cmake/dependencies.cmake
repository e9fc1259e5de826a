# Every library that wearwell uses, found once. setup/install provides them on Debian 12.
find_package(Boost 1.74 REQUIRED)
find_package(CLI11 REQUIRED)
find_package(DuckDB REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(GTest REQUIRED)
find_package(NLopt REQUIRED NAMES nlopt CONFIGS NLoptConfig.cmake)
find_package(TBB REQUIRED)
find_package(Threads REQUIRED)
find_package(UDUNITS2 REQUIRED)
find_package(benchmark REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(rapidcheck REQUIRED)
find_package(tomlplusplus REQUIRED)

# Headers only: ceres/jet.h and Random123, both in the default include path on Debian.
find_path(CERES_JET_INCLUDE_DIR ceres/jet.h REQUIRED)
find_path(RANDOM123_INCLUDE_DIR Random123/philox.h REQUIRED)
