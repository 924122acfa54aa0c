#include <gtest/gtest.h>

#include "export/packing.hpp"
#include "export/page_data.hpp"
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

TEST(Packing, ThePageHasTheSolutionInItsPlaces) {
  const std::string page = exporting::pageHtml("<p>@DELTALUX_SOLUTION@</p><i>@DELTALUX_LATER@</i>", {"light", "more"});
  EXPECT_EQ(page.substr(0, 3), "<p>");
  const std::size_t between = page.find("</p><i>");
  ASSERT_NE(between, std::string::npos);
  EXPECT_EQ(page.substr(page.size() - 4), "</i>");
  EXPECT_EQ(test::gunzip(test::fromBase64(page.substr(3, between - 3))), "light");
  EXPECT_EQ(test::gunzip(test::fromBase64(page.substr(between + 7))), "more");
}

}  // namespace
}  // namespace deltalux
