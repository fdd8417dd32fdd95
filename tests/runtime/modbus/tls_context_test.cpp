// The files of TLS: what they must be, and what is said where they are not. The pages of the errors keep their word.
#include "runtime/modbus/tls_context.hpp"

#include <gtest/gtest.h>
#include <toml++/toml.h>

#include <array>
#include <cstdlib>
#include <ctime>

#include "support/errors.hpp"
#include "tests/runtime/modbus/tls_files.hpp"
#include "tests/support/error_page.hpp"

namespace hysteron::runtime::modbus {
namespace {

using test::Certificate;

class TlsContexts : public ::testing::Test {
 protected:
  TlsContexts() {
    // What the pages speak of.
    const Certificate old({.name = "server", .begins = -7200, .ends = -3600, .for_clients = false}, &files_.authority);
    files_.folder.write("expired.pem", old.certificate_pem());
    files_.private_file("expired.key", old.key_pem());
    files_.private_file("other.key", old.key_pem());
    files_.private_file("locked.key", files_.server.key_pem("secret"));
    files_.folder.write("open.key", files_.server.key_pem());
    std::filesystem::permissions(files_.folder / "open.key", std::filesystem::perms(0644));
  }

  /// Number, place and cause of the refusal; empty where there is none.
  static std::string refusal(const TlsOptions& options) {
    try {
      const TlsContext context(options);
      return "";
    } catch (const InputError& refused) {
      const Diagnostic& only = refused.diagnostics().all().front();
      EXPECT_EQ(refused.diagnostics().all().size(), 1U);
      EXPECT_FALSE(only.mend.empty());
      return std::to_string(only.number) + "@" + std::to_string(only.place.line) + " " + only.cause;
    }
  }

  [[nodiscard]] TlsOptions options_of(const std::string& text) const {
    const auto table = toml::parse(text);
    const auto path = [&](const char* key) { return files_.folder / table["tls"][key].value<std::string>().value(); };
    return {.certificate = path("certificate"),
            .key = path("key"),
            .clients = path("clients"),
            .certificate_place = {.file = "run.toml", .line = 1},
            .key_place = {.file = "run.toml", .line = 2},
            .clients_place = {.file = "run.toml", .line = 3}};
  }
  /// With one of the files another one.
  [[nodiscard]] std::string refusal_with(const std::string& key, const std::string& file) const {
    TlsOptions options =
        options_of("[tls]\ncertificate = \"server.pem\"\nkey = \"server.key\"\nclients = \"clients.pem\"\n");
    (key == "certificate" ? options.certificate : key == "key" ? options.key : options.clients) = files_.folder / file;
    return refusal(options);
  }

  test::TlsFiles files_;
};

TEST_F(TlsContexts, PagesFailAndMend) {
  for (const int number : {error::unusable_tls_file, error::key_of_another_certificate, error::key_open_to_others,
                           error::certificate_out_of_date}) {
    const auto page = test::read_error_page("HY" + std::to_string(number));
    EXPECT_TRUE(refusal(options_of(page.fails.text)).starts_with(std::to_string(number) + "@")) << page.number;
    EXPECT_EQ(refusal(options_of(page.mended.text)), "") << page.number;
  }
}

TEST_F(TlsContexts, EachFileIsNamedWithItsPlaceAndCause) {
  const auto starts = [&](const std::string& text, const std::string& with) {
    EXPECT_TRUE(text.starts_with(with)) << text;
  };
  const std::string folder = files_.folder / "";
  starts(refusal_with("certificate", "none.pem"),
         "831@1 The certificate " + folder + "none.pem cannot be read: No such");
  starts(refusal_with("key", "none.key"), "831@2 The private key " + folder + "none.key cannot be read: No such");
  starts(refusal_with("clients", "none.pem"), "831@3 The file of those who sign clients' certificates ");
  starts(refusal_with("certificate", "server.key"), "831@1 ");
  starts(refusal_with("key", "server.pem"), "833@2 ");
  starts(refusal_with("key", "locked.key"), "831@2 The private key ");
  starts(refusal_with("key", "other.key"), "832@2 ");
  starts(refusal_with("key", "open.key"), "833@2 Others than its owner may read or change the private key ");
  starts(refusal_with("clients", "expired.pem"), "834@3 ");
  files_.folder.write(
      "both.pem", test::contents_of(files_.folder / "expired.pem") + test::contents_of(files_.folder / "clients.pem"));
  EXPECT_EQ(refusal_with("clients", "both.pem"), "") << "one that counts is enough";
  files_.folder.write("torn.pem", files_.authority.certificate_pem() + files_.server.certificate_pem().substr(0, 200));
  starts(refusal_with("clients", "torn.pem"), "831@3 ");
  EXPECT_EQ(refusal_with("certificate", "server.pem"), "");
}

TEST_F(TlsContexts, WhatIsOutOfDateMayBeTakenAndSaysSo) {
  const std::time_t now = std::time(nullptr);
  TlsOptions options = files_.options();
  EXPECT_EQ(TlsContext(options).fault_at(now), TlsFault::none);
  EXPECT_EQ(TlsContext(options).fault_at(now + 7200), TlsFault::ended);
  EXPECT_EQ(TlsContext(options).fault_at(0), TlsFault::not_begun);
  options.certificate = files_.folder / "expired.pem";
  options.key = files_.folder / "expired.key";
  EXPECT_TRUE(refusal(options).starts_with("834@"));
  EXPECT_EQ(TlsContext(options, OutOfDate::taken).fault_at(now), TlsFault::ended);
  options = files_.options();
  options.clients = files_.folder / "expired.pem";
  EXPECT_EQ(TlsContext(options, OutOfDate::taken).fault_at(now), TlsFault::signers);
  options.key = files_.folder / "other.key";
  EXPECT_THROW(TlsContext(options, OutOfDate::taken), InputError) << "nothing but dates is let pass";
}

TEST_F(TlsContexts, NoSecretIsInARefusal) {
  for (const char* const file : {"locked.key", "other.key", "open.key"}) {
    const std::string key = test::contents_of(files_.folder / file);
    const std::string said = refusal_with("key", file);
    for (std::size_t at = key.find('\n') + 1; at + 16 < key.size(); at += 16) {
      EXPECT_EQ(said.find(key.substr(at, 16)), std::string::npos);
    }
  }
}

TEST_F(TlsContexts, ItsGroupMayReadAKey) {
  std::filesystem::permissions(files_.folder / "open.key", std::filesystem::perms(0640));
  EXPECT_EQ(refusal_with("key", "open.key"), "");
  std::filesystem::permissions(files_.folder / "open.key", std::filesystem::perms(0660));
  EXPECT_TRUE(refusal_with("key", "open.key").starts_with("833@2 "));
}

TEST_F(TlsContexts, WhatTheServiceManagerHandsOverCounts) {
  files_.private_file("tls-key", files_.server.key_pem());
  ::setenv("CREDENTIALS_DIRECTORY", files_.folder.path().c_str(), 1);
  EXPECT_EQ(refusal_with("key", "none.key"), "");
  EXPECT_TRUE(refusal_with("certificate", "none.pem").starts_with("831@1 ")) << "it hands over no certificate";
  ::unsetenv("CREDENTIALS_DIRECTORY");
}

TEST_F(TlsContexts, TellsUntilWhenTheCertificateCounts) {
  const Certificate long_lived({.ends = 400L * 24 * 3600, .for_clients = false}, &files_.authority);
  files_.folder.write("server.pem", long_lived.certificate_pem());
  files_.private_file("server.key", long_lived.key_pem());
  const std::time_t end = std::time(nullptr) + 400L * 24 * 3600;
  std::tm parts{};
  ::gmtime_r(&end, &parts);
  std::array<char, 16> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d", &parts);
  EXPECT_EQ(TlsContext(files_.options()).valid_until(), text.data());
}

}  // namespace
}  // namespace hysteron::runtime::modbus
