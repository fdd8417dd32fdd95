#include "runtime/modbus/tls_renewal.hpp"

#include <gtest/gtest.h>

#include <array>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "tests/runtime/modbus/tls_files.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using test::Certificate;

constexpr long a_day = 24 * 3600;

/// Files of a server whose certificate lives for so many days, and a renewal that looks at them.
class Renewal : public ::testing::Test {
 protected:
  void serve_for(long days) {
    write_server(days);
    serving_ = std::make_shared<const TlsContext>(files_.options());
    renewal_.emplace(files_.options(), serving_, now_);
  }
  void write_server(long days) {
    const Certificate fresh({.name = "server", .begins = -10 * a_day, .ends = days * a_day + 600, .for_clients = false},
                            &files_.authority);
    write_certificate(fresh);
    write_key(fresh);
  }
  /// Put beside and moved over, as those who renew certificates do: another file each time.
  void write_certificate(const Certificate& certificate) {
    files_.folder.write("next.pem", certificate.certificate_pem());
    std::filesystem::rename(files_.folder / "next.pem", files_.folder / "server.pem");
  }
  void write_key(const Certificate& certificate) {
    files_.private_file("next.key", certificate.key_pem());
    std::filesystem::rename(files_.folder / "next.key", files_.folder / "server.key");
  }
  TlsRenewal::Found look(std::time_t days_on = 0) {
    now_ += TlsRenewal::interval;
    return renewal_->look(now_, std::time(nullptr) + days_on * a_day);
  }

  test::TlsFiles files_;
  TlsRenewal::Clock::time_point now_{};
  std::shared_ptr<const TlsContext> serving_;
  std::optional<TlsRenewal> renewal_;
};

/// For an alarm of the plant's own screen, which knows no log.
TEST_F(Renewal, TheDaysThatAreLeftAreCounted) {
  serve_for(40);
  EXPECT_EQ(look().days, 40);
  EXPECT_EQ(look(31).days, 9);
  EXPECT_EQ(look(40).days, 0) << "some minutes of its last day";
  EXPECT_EQ(look(400).days, 0) << "it has ended";
  serve_for(36'000);
  EXPECT_EQ(look().days, 36'000);
  EXPECT_EQ(look(-50'000).days, TlsRenewal::most_days) << "a clock at its beginning";
}

TEST_F(Renewal, NothingIsSaidOfFilesThatRestAndOfACertificateThatIsSound) {
  serve_for(400);
  for (int i = 0; i < 5; ++i) {
    const auto found = look();
    EXPECT_FALSE(found.renewed);
    EXPECT_TRUE(found.lines.empty()) << found.lines.front();
  }
}

TEST_F(Renewal, NewFilesAreReadOnceTheyRest) {
  serve_for(400);
  write_server(500);
  EXPECT_FALSE(look().renewed) << "the other file could still be on its way";
  const auto found = look();
  ASSERT_TRUE(found.renewed);
  EXPECT_GT(found.renewed->ends(), serving_->ends());
  ASSERT_EQ(found.lines.size(), 1U);
  EXPECT_EQ(found.lines[0], "new certificate, until " + found.renewed->valid_until() + ", for connections from now on");
  EXPECT_FALSE(look().renewed) << "read once";
}

TEST_F(Renewal, ACertificateWithoutItsKeyIsToldOfAndLeavesTheOldOneUntilTheKeyComes) {
  serve_for(400);
  const Certificate fresh({.name = "server", .ends = 500 * a_day, .for_clients = false}, &files_.authority);
  write_certificate(fresh);
  EXPECT_TRUE(look().lines.empty());
  const auto half = look();
  EXPECT_FALSE(half.renewed);
  ASSERT_EQ(half.lines.size(), 1U);
  EXPECT_NE(half.lines[0].find("the certificate until " + serving_->valid_until() + " goes on: HY832"),
            std::string::npos)
      << half.lines[0];
  EXPECT_TRUE(look().lines.empty()) << "told once";
  write_key(fresh);
  EXPECT_FALSE(look().renewed);
  EXPECT_TRUE(look().renewed);
}

/// As where the clock of the machine is behind when the operator writes it, and is set right later.
TEST_F(Renewal, ACertificateThatDoesNotCountYetIsTakenOnceItDoes) {
  serve_for(400);
  const Certificate fresh({.name = "server", .begins = 2, .ends = 500 * a_day, .for_clients = false},
                          &files_.authority);
  write_certificate(fresh);
  write_key(fresh);
  EXPECT_TRUE(look().lines.empty());
  const auto early = look();
  EXPECT_FALSE(early.renewed);
  ASSERT_EQ(early.lines.size(), 1U);
  EXPECT_NE(early.lines[0].find("HY834"), std::string::npos) << early.lines[0];
  TlsRenewal::Found found;
  ASSERT_TRUE(test::soon([&] {
    found = found.lines.empty() ? look() : found;
    return !found.lines.empty();
  }));
  EXPECT_TRUE(found.renewed) << found.lines.front();
}

TEST_F(Renewal, WhateverIsDoneToTheFilesNeverThrows) {
  serve_for(400);
  const std::array<std::string, 3> names{"server.pem", "server.key", "clients.pem"};
  for (const std::string& name : names) {
    for (const std::string& text :
         {std::string(), std::string("nonsense"), std::string("-----BEGIN CERTIFICATE-----\n")}) {
      files_.private_file(name, text);
      (void)look();
      const auto found = look();
      EXPECT_FALSE(found.renewed) << name;
      EXPECT_EQ(found.lines.size(), 1U) << name;
    }
    std::filesystem::remove(files_.folder / name);
    (void)look();
    EXPECT_EQ(look().lines.size(), 1U) << name << " is gone";
    files_.folder.write("clients.pem", files_.authority.certificate_pem());
    write_server(400);
    (void)look();
    EXPECT_TRUE(look().renewed) << name << " is back";
  }
}

TEST_F(Renewal, TheEndIsToldOfOnceADayFromThirtyDaysBefore) {
  serve_for(40);
  EXPECT_TRUE(look(9).lines.empty());
  for (int day = 11; day < 45; ++day) {
    const auto first = look(day);
    ASSERT_EQ(first.lines.size(), 1U) << day;
    const std::string expected = day < 39
                                     ? "the server's certificate ends in " + std::to_string(40 - day) + " days, on "
                                 : day == 39 ? "the server's certificate ends in 1 day, on "
                                 : day == 40 ? "the server's certificate ends in 0 days, on "
                                             : "the server's certificate ended on " + serving_->valid_until() + ": ";
    EXPECT_TRUE(first.lines[0].starts_with(expected)) << first.lines[0];
    EXPECT_TRUE(look(day).lines.empty()) << "once a day";
  }
  write_server(400);
  (void)look(45);
  const auto renewed = look(45);
  ASSERT_TRUE(renewed.renewed);
  EXPECT_EQ(renewed.lines.size(), 1U) << "that it is read, and no end any more";
  EXPECT_TRUE(look(46).lines.empty());
}

TEST_F(Renewal, AClockThatStandsAtItsBeginningIsToldOf) {
  serve_for(400);
  now_ += TlsRenewal::interval;
  const auto found = renewal_->look(now_, 0);
  ASSERT_EQ(found.lines.size(), 1U);
  EXPECT_NE(found.lines[0].find("does not count yet by the clock of this machine"), std::string::npos);
  EXPECT_EQ(found.fault, TlsFault::not_begun);
  const auto right = look();
  EXPECT_EQ(right.fault, TlsFault::none) << "once the clock is right, all is well";
  EXPECT_TRUE(right.lines.empty());
}

TEST_F(Renewal, WhatWasOutOfDateAtTheStartIsToldOfUntilNewFilesCome) {
  write_server(-2);
  serving_ = std::make_shared<const TlsContext>(files_.options(), OutOfDate::taken);
  renewal_.emplace(files_.options(), serving_, now_);
  const auto first = look();
  EXPECT_EQ(first.fault, TlsFault::ended);
  ASSERT_EQ(first.lines.size(), 1U);
  EXPECT_TRUE(first.lines[0].starts_with("the server's certificate ended on ")) << first.lines[0];
  EXPECT_TRUE(look().lines.empty()) << "once a day";
  write_server(-1);
  (void)look();
  const auto no_better = look();
  EXPECT_FALSE(no_better.renewed);
  ASSERT_EQ(no_better.lines.size(), 1U);
  EXPECT_NE(no_better.lines[0].find("HY834"), std::string::npos) << no_better.lines[0];
  write_server(400);
  (void)look();
  const auto renewed = look();
  EXPECT_TRUE(renewed.renewed);
  EXPECT_EQ(renewed.fault, TlsFault::none);
  EXPECT_EQ(look().fault, TlsFault::none);
}

TEST_F(Renewal, SignersOfWhomNoneCountsAreToldOf) {
  const Certificate old({.name = "old authority", .begins = -3 * a_day, .ends = -2 * a_day}, nullptr);
  files_.folder.write("clients.pem", old.certificate_pem());
  write_server(400);
  serving_ = std::make_shared<const TlsContext>(files_.options(), OutOfDate::taken);
  renewal_.emplace(files_.options(), serving_, now_);
  const auto found = look();
  EXPECT_EQ(found.fault, TlsFault::signers);
  ASSERT_EQ(found.lines.size(), 1U);
  EXPECT_NE(found.lines[0].find("clients.pem that sign those of clients counts today"), std::string::npos)
      << found.lines[0];
  files_.folder.write("clients.pem", old.certificate_pem() + files_.authority.certificate_pem());
  (void)look();
  EXPECT_EQ(look().fault, TlsFault::none);
}

}  // namespace
}  // namespace hysteron::runtime::modbus
