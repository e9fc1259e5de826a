// What is written is read back by xarray and netCDF4 in python/tests/test_netcdf.py; here is what needs no Python.
#include "wearwell/netcdf/netcdf_file.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <thread>
#include <vector>

namespace wearwell::netcdf {
namespace {

Group group(std::size_t size) {
  return {"posterior",
          {{"draw", size}},
          {{"k", {"draw"}, std::vector<double>(size, 1.5), {{"units", "mm"}}},
           {"diverging", {"draw"}, Variable::Flags(size, 1)},
           {"depth", {"draw"}, std::vector<std::int64_t>(size, 3)},
           {"name", {"draw"}, std::vector<std::string>(size, "J1")}},
          {{"inference_library", "wearwell"}}};
}

TEST(NetcdfFile, IsHdf5AndGrowsWithWhatItHolds) {
  const std::string small = file_of({group(2)}), large = file_of({group(5000)});
  EXPECT_EQ(small.substr(0, 8), "\x89HDF\r\n\x1a\n");
  EXPECT_GT(large.size(), small.size());
  EXPECT_NE(small.find("inference_library"), std::string::npos);
}

TEST(NetcdfFile, ArraysOfAnotherSizeAreRefused) {
  Group wrong = group(2);
  wrong.dimensions[0].size = 3;
  EXPECT_THROW(file_of({wrong}), std::logic_error);
  wrong = group(2);
  wrong.variables[0].dimensions = {"chain"};
  EXPECT_THROW(file_of({wrong}), std::logic_error);
  EXPECT_NO_THROW(file_of({group(2)}));  // the next one is as any
}

TEST(NetcdfFile, ManyThreadsMayAsk) {
  std::vector<std::string> files(8);
  std::vector<std::thread> threads;
  for (std::string& each : files) {
    threads.emplace_back([&each] { each = file_of({group(1000)}); });
  }
  for (std::thread& each : threads) each.join();
  for (const std::string& each : files) EXPECT_EQ(each.size(), files.front().size());
}

TEST(NetcdfFile, NamesArePlain) {
  EXPECT_EQ(plain_name("k"), "k");
  EXPECT_EQ(plain_name("k[PTFE]"), "k_PTFE_");
  EXPECT_EQ(plain_name("2nd stage"), "_2nd_stage");
  EXPECT_EQ(plain_name(""), "_");
}

}  // namespace
}  // namespace wearwell::netcdf
