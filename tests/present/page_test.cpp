#include "wearwell/present/page.h"

#include <gmock/gmock.h>

#include <regex>

#include "support/run_command.h"
#include "support/scratch.h"

namespace wearwell {
namespace {

using testing::HasSubstr;
using testing::Not;

class PageTest : public ScratchTest {
 protected:
  const std::string page_ = html_page({"1", "T", "s", {{"a", "A", {{present::Prose{"text"}}}}}});

  std::string policy() const {
    std::smatch found;
    const std::regex tag("Content-Security-Policy\" content=\"([^\"]*)\"");
    return std::regex_search(page_, found, tag) ? found[1].str() : "";
  }
};

// The policy comes first: what stands before it is not bound by it.
TEST_F(PageTest, PolicyStandsBeforeAllElse) {
  const std::size_t at = page_.find("<meta http-equiv=\"Content-Security-Policy\"");
  ASSERT_NE(at, std::string::npos);
  EXPECT_LT(at, page_.find("<title"));
  EXPECT_LT(at, page_.find("<script"));
  EXPECT_THAT(policy(), HasSubstr("default-src 'none'"));
  const std::string scripts = policy().substr(policy().find("script-src"));
  EXPECT_THAT(scripts, Not(HasSubstr("unsafe")));
  EXPECT_THAT(policy(), Not(HasSubstr("unsafe-eval")));
}

// Every script of the page, hashed by coreutils, is one that the policy allows, and no more are.
TEST_F(PageTest, PolicyAllowsItsOwnScriptsOnly) {
  int scripts = 0;
  for (std::size_t at = 0; (at = page_.find("<script>", at)) != std::string::npos;) {
    at += 8;
    const auto file = write("script.js", page_.substr(at, page_.find("</script>", at) - at));
    const CommandResult hash = run_command(
        "sha256sum '" + file.string() +
        "' | cut -c1-64 | tr -d '\\n' | tr a-f A-F | basenc --base16 -d | base64 | tr -d '\\n'");
    EXPECT_THAT(policy(), HasSubstr("'sha256-" + hash.out + "'"));
    ++scripts;
  }
  EXPECT_EQ(scripts, 4);
  const std::string text = policy();
  int allowed = 0;
  for (std::size_t at = 0; (at = text.find("'sha256-", at)) != std::string::npos; ++at) ++allowed;
  EXPECT_EQ(allowed, 4);
}

}  // namespace
}  // namespace wearwell
