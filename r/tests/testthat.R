library(testthat)
library(wearwell)

test_check("wearwell")
