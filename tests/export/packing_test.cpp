#include <gtest/gtest.h>

#include "export/packing.hpp"
#include "export/page_html.hpp"
#include "export/page_support.hpp"

namespace deltalux {
namespace {

TEST(Packing, Base64HasTheWordsOfTheStandard) {
  EXPECT_EQ(exporting::base64(""), "");
  EXPECT_EQ(exporting::base64("f"), "Zg==");
  EXPECT_EQ(exporting::base64("fo"), "Zm8=");
  EXPECT_EQ(exporting::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(exporting::base64("\xff\xfe\xfd"), "//79");
}

TEST(Packing, GzipComesBack) {
  std::string bytes;
  for (int i = 0; i < 100000; ++i) bytes += static_cast<char>(i * i >> 3);
  EXPECT_EQ(test::gunzip(exporting::gzip(bytes)), bytes);
  EXPECT_EQ(test::gunzip(exporting::gzip("")), "");
  EXPECT_EQ(exporting::gzip(bytes), exporting::gzip(bytes));
}

TEST(Packing, ThePageHasTheSolutionInItsPlace) {
  const std::string page = exporting::pageHtml("<p>@DELTALUX_SOLUTION@</p>", "light");
  EXPECT_EQ(page.substr(0, 3), "<p>");
  EXPECT_EQ(page.substr(page.size() - 4), "</p>");
  EXPECT_EQ(test::gunzip(test::fromBase64(page.substr(3))), "light");
}

}  // namespace
}  // namespace deltalux
