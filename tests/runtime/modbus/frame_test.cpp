#include "runtime/modbus/frame.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace hysteron::runtime::modbus {
namespace {

using Bytes = std::vector<std::uint8_t>;

const Bytes read_two{0x12, 0x34, 0, 0, 0, 6, 17, 3, 0, 16, 0, 2};

TEST(Frame, ACompleteOne) {
  const FrameScan scan = scan_frame(read_two);
  ASSERT_EQ(scan.status, FrameStatus::complete);
  EXPECT_EQ(scan.size, 12U);
  EXPECT_EQ(scan.frame.transaction, 0x1234);
  EXPECT_EQ(scan.frame.unit, 17);
  EXPECT_EQ(Bytes(scan.frame.pdu.begin(), scan.frame.pdu.end()), (Bytes{3, 0, 16, 0, 2}));
  EXPECT_EQ(header_of(scan.frame, 6), (std::array<std::uint8_t, 7>{0x12, 0x34, 0, 0, 0, 7, 17}));
}

TEST(Frame, EveryStartOfOneIsIncomplete) {
  for (std::size_t size = 0; size < read_two.size(); ++size) {
    EXPECT_EQ(scan_frame(std::span(read_two).first(size)).status, FrameStatus::incomplete) << size;
  }
}

TEST(Frame, TheFirstWrongByteDecides) {
  for (const std::size_t at : {2U, 3U}) {
    Bytes bytes = read_two;
    bytes[at] = 1;
    EXPECT_EQ(scan_frame(std::span(bytes).first(at)).status, FrameStatus::incomplete);
    EXPECT_EQ(scan_frame(std::span(bytes).first(at + 1)).status, FrameStatus::wrong_protocol);
  }
  Bytes bytes = read_two;
  bytes[4] = 1;
  EXPECT_EQ(scan_frame(std::span(bytes).first(5)).status, FrameStatus::wrong_length);
}

TEST(Frame, EveryLengthField) {
  for (unsigned length = 0; length <= 0xFFFF; ++length) {
    Bytes bytes(6 + std::min(length, 300U), 0);
    bytes[4] = static_cast<std::uint8_t>(length >> 8U);
    bytes[5] = static_cast<std::uint8_t>(length & 0xFFU);
    const FrameScan scan = scan_frame(bytes);
    const bool sound = length >= 2 && length <= 254;
    ASSERT_EQ(scan.status, sound ? FrameStatus::complete : FrameStatus::wrong_length) << length;
    ASSERT_EQ(scan.size, sound ? 6 + length : 0U);
    ASSERT_EQ(scan.frame.pdu.size(), sound ? length - 1 : 0U);
  }
}

TEST(Frame, RandomBytesNeverReachBeyondThemselves) {
  std::mt19937 random(3);
  std::size_t complete = 0;
  for (int i = 0; i < 200000; ++i) {
    Bytes bytes(random() % 300);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(random() % 4 == 0 ? random() : 0);
    }
    const FrameScan scan = scan_frame(bytes);
    if (scan.status == FrameStatus::complete) {
      ++complete;
      ASSERT_LE(scan.size, bytes.size());
      ASSERT_EQ(scan.frame.pdu.data() + scan.frame.pdu.size(), bytes.data() + scan.size);
    }
  }
  EXPECT_GT(complete, 100U);
}

}  // namespace
}  // namespace hysteron::runtime::modbus
