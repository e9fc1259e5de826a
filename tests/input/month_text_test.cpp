#include "wearwell/input/month_text.h"

#include <gtest/gtest.h>

namespace wearwell {
namespace {

TEST(MonthText, FormsOfOneMonth) {
  for (const char* text : {"2024-03",    "2024-3",     "2024/03",
                           "2024.03",    "2024-03-01", "2024-03-31 00:00:00",
                           "03/2024",    "3/2024",     "03.2024",
                           "202403",     "Mar-24",     "mar 2024",
                           "March 2024", "March-2024", "2024 Mar",
                           "Mär 2024",   "März 2024",  "Mrz 24",
                           "mars 2024",  "marzo 2024", "Mar. 2024",
                           "01.03.2024", "31.3.2024",  "31/03/2024",
                           "03/31/2024", "03-03-2024", "31.03.2024 10:30"})
    EXPECT_EQ(month_in(text), 2024 * 12 + 2) << text;
  EXPECT_EQ(month_in("Dez 99"), 1999 * 12 + 11);
  EXPECT_EQ(month_in("août 2023"), 2023 * 12 + 7);
  EXPECT_EQ(month_in("Juli 2023"), month_in("juillet 2023"));
  EXPECT_EQ(month_text(2024 * 12 + 2), "2024-03");
}

TEST(MonthText, OtherTexts) {
  for (const char* text : {"",         "3",          "2024",       "24",         "01/02/2024",
                           "2024.1",   "01.02.24",   "2024-13",    "13/2024",    "24-Mar",
                           "jui 2024", "Q1 2024",    "shipped",    "units 2024", "ma 2024",
                           "-2024-03", "240301",     "2024-03-45", "2024-02-30", "2023-02-29",
                           "999999",   "31.02.2024", "13/14/2024", "02-03-2024", "31/04/2024"})
    EXPECT_FALSE(month_in(text)) << text;
}

// Every month in every written form is itself.
TEST(MonthText, RoundTrip) {
  for (int month = 1999 * 12; month < 2031 * 12; ++month)
    EXPECT_EQ(month_in(month_text(month)), month);
}

}  // namespace
}  // namespace wearwell
