#include "runtime/modbus/allow_list.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>

#include <cstring>
#include <random>

namespace hysteron::runtime::modbus {
namespace {

bool contains(std::string_view network, std::string_view address) {
  return Network::parse(network)->contains(*address_bytes(address));
}

TEST(AllowList, Networks) {
  EXPECT_TRUE(contains("192.168.10.0/24", "192.168.10.255"));
  EXPECT_FALSE(contains("192.168.10.0/24", "192.168.11.0"));
  EXPECT_TRUE(contains("0.0.0.0/0", "255.1.2.3"));
  EXPECT_FALSE(contains("0.0.0.0/0", "2001:db8::1")) << "IPv4's whole is not IPv6's";
  EXPECT_TRUE(contains("10.1.2.3", "10.1.2.3"));
  EXPECT_FALSE(contains("10.1.2.3", "10.1.2.2"));
  EXPECT_TRUE(contains("fd00::/8", "fdff:1::9"));
  EXPECT_FALSE(contains("fd00::/8", "fe00::"));
  EXPECT_TRUE(contains("10.0.0.0/8", "::ffff:10.9.9.9")) << "as a socket of both families sees it";
}

TEST(AllowList, EveryLengthAgreesWithArithmetic) {
  std::mt19937 random(8);
  for (unsigned length = 0; length <= 32; ++length) {
    const auto mask = static_cast<std::uint32_t>(length == 0 ? 0U : 0xFFFFFFFFU << (32 - length));
    for (int i = 0; i < 200; ++i) {
      const std::uint32_t net = static_cast<std::uint32_t>(random()) & mask;
      const std::uint32_t host = i % 2 == 0 ? static_cast<std::uint32_t>(random()) : net ^ (1U << random() % 32);
      const auto text = [](std::uint32_t address) {
        const in_addr in{htonl(address)};
        return std::string(::inet_ntoa(in));
      };
      EXPECT_EQ(contains(text(net) + "/" + std::to_string(length), text(host)), (host & mask) == net);
    }
  }
}

TEST(AllowList, WhatIsNoNetwork) {
  for (const char* text : {"", "/", "10.0.0.0/33", "10.0.0.1/24", "10.0.0.0/", "10.0.0.0/-1", "10.0.0/8", "localhost",
                           "fd00::/129", "fd00::1/8", "10.0.0.0/8 ", "10.0.0.0/8/8", "::ffff:10.0.0.0/8"}) {
    EXPECT_FALSE(Network::parse(text).has_value()) << text;
  }
}

TEST(AllowList, AnEmptyListAllowsEveryoneAndAListNobodyElse) {
  sockaddr_storage peer{};
  sockaddr_in four{};
  four.sin_family = AF_INET;
  ::inet_pton(AF_INET, "127.0.0.1", &four.sin_addr);
  std::memcpy(&peer, &four, sizeof four);
  EXPECT_TRUE(is_allowed({}, peer));
  EXPECT_TRUE(is_allowed({*Network::parse("10.0.0.0/8"), *Network::parse("127.0.0.0/8")}, peer));
  EXPECT_FALSE(is_allowed({*Network::parse("10.0.0.0/8")}, peer));
  sockaddr_storage local{};
  local.ss_family = AF_UNIX;
  EXPECT_FALSE(is_allowed({*Network::parse("0.0.0.0/0")}, local));
}

TEST(AllowList, AnOriginIsAnAddressOrTheHalfOfOne) {
  const auto origin = [](const char* text) {
    sockaddr_storage peer{};
    sockaddr_in6 six{};
    six.sin6_family = AF_INET6;
    const auto bytes = *address_bytes(text);
    std::memcpy(&six.sin6_addr, bytes.data(), bytes.size());
    std::memcpy(&peer, &six, sizeof six);
    return origin_of(peer);
  };
  EXPECT_EQ(origin("10.1.2.3"), address_bytes("10.1.2.3"));
  EXPECT_NE(origin("10.1.2.3"), origin("10.1.2.4"));
  EXPECT_EQ(origin("2001:db8:1:2::3"), origin("2001:db8:1:2:ffff::4"));
  EXPECT_NE(origin("2001:db8:1:2::3"), origin("2001:db8:1:3::3"));
  EXPECT_FALSE(origin_of(sockaddr_storage{}));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
