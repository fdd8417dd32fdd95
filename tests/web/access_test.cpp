#include "runtime/web/access.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include "support/errors.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::web {
namespace {

int refusal_of(const auto& what) {
  try {
    what();
  } catch (const InputError& refused) {
    return refused.diagnostics().all().front().number;
  }
  return 0;
}

TEST(WebAccess, AnEndpointIsANumericAddressAndAPort) {
  const Endpoint four = parse_endpoint("127.0.0.1:8080");
  EXPECT_EQ(four.address, "127.0.0.1");
  EXPECT_EQ(four.port, 8080);
  EXPECT_TRUE(four.is_loopback);
  EXPECT_EQ(text_of(four, 81), "127.0.0.1:81");
  const Endpoint six = parse_endpoint("[::1]:0");
  EXPECT_EQ(six.address, "::1");
  EXPECT_TRUE(six.is_loopback);
  EXPECT_EQ(text_of(six, 81), "[::1]:81");
  EXPECT_TRUE(parse_endpoint("127.8.9.10:1").is_loopback);
  for (const char* const open : {"0.0.0.0:80", "[::]:80", "192.168.1.7:80", "128.0.0.1:80"}) {
    EXPECT_FALSE(parse_endpoint(open).is_loopback) << open;
  }
}

TEST(WebAccess, OtherTextsAreNoEndpoint) {
  for (const char* const text :
       {"", "8080", ":8080", "127.0.0.1", "127.0.0.1:", "127.0.0.1:65536", "127.0.0.1:-1", "127.0.0.1:80x",
        "localhost:80", "[::1]", "[::1]80", "[::1:80", "::1:80", "1.2.3:80"}) {
    EXPECT_EQ(refusal_of([&] { (void)parse_endpoint(text); }), error::malformed_web_address) << text;
  }
}

TEST(WebAccess, BeyondTheLoopbackThereIsAToken) {
  const Endpoint open = parse_endpoint("0.0.0.0:80");
  EXPECT_EQ(refusal_of([&] { check_access(open, {.is_loopback = false}); }), error::open_web_page);
  EXPECT_EQ(refusal_of([&] { check_access(open, {.is_loopback = false, .token = "0123456789abcdef"}); }), 0);
  EXPECT_EQ(refusal_of([&] { check_access(open, {.is_loopback = false, .read_token = "0123456789abcdef"}); }), 0);
  EXPECT_EQ(refusal_of([&] {
              check_access(open, {.is_loopback = false, .token = "0123456789abcdef", .read_token = "0123456789abcdef"});
            }),
            error::unfit_token_file);
  EXPECT_EQ(refusal_of([] { check_access(parse_endpoint("127.0.0.1:80"), {}); }), 0);
}

TEST(WebAccess, ATokenFileIsItsOwnersAlone) {
  const test::ScratchFolder folder;
  const std::string secret = "s3cret-s3cret-s3cret";
  const auto file = [&](const std::string& text, mode_t mode) {
    const std::string path = folder.write("token", text);
    EXPECT_EQ(::chmod(path.c_str(), mode), 0);
    return path;
  };
  EXPECT_EQ(read_token(file(secret + "\n", 0600)), secret);
  EXPECT_EQ(read_token(file(secret + "\r\n", 0400)), secret);
  for (const mode_t mode : {0640U, 0604U, 0620U, 0601U}) {
    EXPECT_EQ(refusal_of([&] { (void)read_token(file(secret, mode)); }), error::unfit_token_file) << mode;
  }
  for (const std::string& text : {std::string(), std::string(15, 'a'), std::string(257, 'a'), secret + " " + secret,
                                  secret + "\n" + secret, secret + "\xc3\xa9", secret + '\0'}) {
    try {
      (void)read_token(file(text, 0600));
      ADD_FAILURE() << text;
    } catch (const InputError& refused) {
      const Diagnostic& only = refused.diagnostics().all().front();
      EXPECT_EQ(only.number, error::unfit_token_file);
      EXPECT_EQ((only.cause + only.mend).find(secret), std::string::npos) << "the token is quoted";
    }
  }
  EXPECT_EQ(refusal_of([&] { (void)read_token(folder / "none"); }), error::unreadable_file);
}

TEST(WebAccess, ATokenIsTakenWholeOrNotAtAll) {
  const Access access{.token = "0123456789abcdef"};
  EXPECT_TRUE(is_token(access, "0123456789abcdef"));
  EXPECT_TRUE(is_authorized(access, "Bearer 0123456789abcdef"));
  for (const char* const wrong : {"", "0", "0123456789abcde", "0123456789abcdeg", "0123456789abcdef0",
                                  "0123456789abcdef0123456789abcdef", "0123456789ABCDEF"}) {
    EXPECT_FALSE(is_token(access, wrong)) << wrong;
    EXPECT_FALSE(is_authorized(access, std::string("Bearer ") + wrong)) << wrong;
  }
  EXPECT_FALSE(is_authorized(access, "0123456789abcdef"));
  EXPECT_FALSE(is_authorized(access, "Basic 0123456789abcdef"));
  const Access both{.token = "0123456789abcdef", .read_token = "fedcba9876543210"};
  EXPECT_TRUE(may_read(both, "Bearer 0123456789abcdef"));
  EXPECT_TRUE(may_read(both, "Bearer fedcba9876543210"));
  EXPECT_FALSE(is_authorized(both, "Bearer fedcba9876543210"));
  for (const char* const wrong : {"Bearer ", "Bearer fedcba987654321", "fedcba9876543210", ""}) {
    EXPECT_FALSE(may_read(both, wrong)) << wrong;
  }
  EXPECT_FALSE(may_read({.read_token = "fedcba9876543210"}, "Bearer "));
  EXPECT_FALSE(may_read({}, "Bearer "));
  // Without a token nothing is one.
  EXPECT_FALSE(is_token({}, ""));
  EXPECT_FALSE(is_authorized({}, "Bearer "));
}

TEST(WebAccess, AForeignHostOrOriginIsSeen) {
  for (const char* const own : {"127.0.0.1:8080", "localhost:8080", "localhost", "[::1]:8080", "127.0.0.1", "[::1]"}) {
    EXPECT_TRUE(is_loopback_host(own)) << own;
  }
  for (const char* const foreign : {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example", "192.168.1.1:80",
                                    "localhost.evil.example", "127.0.0.1:80@evil.example", "[::1"}) {
    EXPECT_FALSE(is_loopback_host(foreign)) << foreign;
  }
  EXPECT_TRUE(is_own_origin("", "127.0.0.1:80"));
  EXPECT_TRUE(is_own_origin("http://127.0.0.1:80", "127.0.0.1:80"));
  for (const char* const foreign : {"null", "http://evil.example", "http://127.0.0.1:81", "127.0.0.1:80", "file://"}) {
    EXPECT_FALSE(is_own_origin(foreign, "127.0.0.1:80")) << foreign;
  }
}

}  // namespace
}  // namespace hysteron::runtime::web
