// Who may see a served explorer.
#include "ui/serve/http/access.hpp"

#include <gtest/gtest.h>

#include "ui/serve/http/address.hpp"
#include "ui/serve/http/answer.hpp"
#include "ui/serve/serve.hpp"

namespace sweepscope::ui {
namespace {

constexpr std::string_view kPolicyToken = "0123456789abcdef";

Request socket_request() {
  return {.method = "GET",
          .target = "/socket",
          .host = "127.0.0.1:8717",
          .origin = "http://127.0.0.1:8717",
          .protocols = "sweepscope.1, token.0123456789abcdef",
          .authorization = {},
          .upgrade = true};
}

unsigned status_of(const Request& request, const HostPolicy& policy = {}) {
  const Answer answer = answer_to(request, policy, kPolicyToken);
  return answer.kind == Answer::Kind::kWebSocket ? 101 : answer.status;
}

TEST(Access, TheOwnPageWithTheTokenIsLetIn) {
  EXPECT_EQ(status_of(socket_request()), 101U);
  Request tunnel = socket_request();
  tunnel.host = "localhost:9000";
  tunnel.origin = "http://localhost:9000";
  EXPECT_EQ(status_of(tunnel), 101U);
}

TEST(Access, AWrongTokenIsNot) {
  for (const std::string_view protocols :
       {"", "sweepscope.1", "sweepscope.1, token.", "sweepscope.1, token.0123456789abcdee",
        "sweepscope.1, token.0123456789abcdef0123456789abcdef", "sweepscope.1, token.0123456789abcde"}) {
    Request request = socket_request();
    request.protocols = protocols;
    EXPECT_EQ(status_of(request), 403U) << protocols;
  }
}

TEST(Access, APageOfAnotherSiteIsNot) {
  for (const std::string_view origin : {"", "null", "http://evil.example", "http://127.0.0.1:8718", "file://",
                                        "http://127.0.0.1:8717.evil.example", "ftp://127.0.0.1:8717"}) {
    Request request = socket_request();
    request.origin = origin;
    EXPECT_EQ(status_of(request), 403U) << origin;
  }
}

TEST(Access, ANameThatIsNotListedIsNot) {
  for (const std::string_view host :
       {"", "evil.example", "evil.example:8717", "127.0.0.1.evil.example", "10.0.0.5:8717", "localhost:80:80",
        "localhost:x", "[::1", "local host", "localhost\r\nX: y"}) {
    Request request = socket_request();
    request.host = host;
    request.upgrade = false;
    request.target = "/";
    EXPECT_EQ(status_of(request), 421U) << host;
  }
}

TEST(Access, AProxysNameAndNumbersOfThisMachineCanBeAllowed) {
  Request request = socket_request();
  request.host = "Robot.example";
  request.origin = "https://robot.example";
  EXPECT_EQ(status_of(request), 421U);
  EXPECT_EQ(status_of(request, {false, {"robot.example"}}), 101U);
  request.host = "10.0.0.5:8717";
  request.origin = "http://10.0.0.5:8717";
  EXPECT_EQ(status_of(request, {true, {}}), 101U);
}

TEST(Access, APageBehindAProxyThatChangesTheHostIsToldSo) {
  Request request = socket_request();
  request.upgrade = false;
  request.target = "/check";
  request.authorization = "Bearer 0123456789abcdef";
  EXPECT_EQ(status_of(request), 200U);
  request.page_origin = "http://127.0.0.1:8717";
  EXPECT_EQ(status_of(request), 200U);
  request.page_origin = "https://robot.example:8443";
  EXPECT_EQ(status_of(request), 409U);
  request.host = "robot.example";  // without the port
  EXPECT_EQ(status_of(request, {false, {"robot.example"}}), 409U);
  request.host = "robot.example:8443";
  EXPECT_EQ(status_of(request, {false, {"robot.example"}}), 200U);
  request.authorization = "Bearer 0123";
  EXPECT_EQ(status_of(request, {false, {"robot.example"}}), 403U) << "who has no token learns nothing";
}

TEST(Access, OnlyThePagesFilesAreFetched) {
  Request request = socket_request();
  request.upgrade = false;
  for (const std::string_view path : {"/", "/main.js", "/serve.css", "/?x"}) {
    request.target = path;
    EXPECT_EQ(status_of(request), 200U) << path;
  }
  for (const std::string_view path :
       {"/../etc/passwd", "/etc/passwd", "//", "/main.js/", "main.js", "", "/socket"}) {
    request.target = path;
    EXPECT_EQ(status_of(request), 404U) << path;
  }
  request.method = "POST";
  EXPECT_EQ(status_of(request), 405U);
}

TEST(Access, TokensAreComparedWhole) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const std::string_view given : {"", "ab", "abd", "abcabc", "abcd"})
    EXPECT_FALSE(equal_in_constant_time(given, "abc")) << given;
  EXPECT_EQ(random_token().size(), 64U);
  EXPECT_NE(random_token(), random_token());
}

TEST(Addresses, AreReadWithAndWithoutAPort) {
  EXPECT_EQ(parse_listen_address("")->text(), "127.0.0.1:8717");
  EXPECT_EQ(parse_listen_address("9000")->text(), "127.0.0.1:9000");
  EXPECT_EQ(parse_listen_address(":9000")->text(), "127.0.0.1:9000");
  EXPECT_EQ(parse_listen_address("", 8766)->text(), "127.0.0.1:8766");
  EXPECT_EQ(parse_listen_address("localhost:0")->text(), "127.0.0.1:0");
  EXPECT_EQ(parse_listen_address("::1")->text(), "[::1]:8717");
  EXPECT_EQ(parse_listen_address("[::1]:9000")->text(), "[::1]:9000");
  EXPECT_TRUE(parse_listen_address("127.9.9.9:1")->loopback);
  for (const char* other : {"0.0.0.0:80", "[::]:80", "192.168.1.2"})
    EXPECT_FALSE(parse_listen_address(other)->loopback);
  for (const char* wrong : {"room.bag", "127.0.0.1:70000", "127.0.0.1:x", "[::1", "999.1.1.1:80"})
    EXPECT_FALSE(parse_listen_address(wrong)) << wrong;
}

TEST(Addresses, ThePrintedTextHasTheTunnelOrAWarning) {
  const std::string local = how_to_reach({"127.0.0.1", 8717, true}, "TOKEN", "anna", "robot");
  EXPECT_NE(local.find("http://127.0.0.1:8717/#token=TOKEN\n"), local.npos) << local;
  EXPECT_NE(local.find("ssh -N -L 8717:127.0.0.1:8717 anna@robot\n"), local.npos) << local;
  EXPECT_EQ(local.find("Warning"), local.npos);
  const std::string open = how_to_reach({"0.0.0.0", 8717, false}, "TOKEN", "anna", "robot");
  EXPECT_NE(open.find("Warning: nothing is encrypted"), open.npos) << open;
}

}  // namespace
}  // namespace sweepscope::ui
