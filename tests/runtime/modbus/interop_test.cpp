// Other people's clients against the server: every type in every word order, to the bit.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::modbus {
namespace {

class Interoperation : public ::testing::TestWithParam<WordOrder> {
 protected:
  Interoperation() {
    for (std::size_t i = 0; i < door_.points().size(); ++i) {
      door_.set(i, given(i));
    }
  }
  /// Values that no float holds exactly where the type is real64, and that are the same in no two orders of bytes.
  [[nodiscard]] double given(std::size_t i) const {
    switch (door_.points()[i].type) {
      case PointType::boolean:
        return static_cast<double>(i % 2);
      case PointType::real64:
        return 0.1 + static_cast<double>(i);
      case PointType::real32:
        return 0.375 + static_cast<double>(i);
      case PointType::int32:
      case PointType::int64:
        return -123456.0 - static_cast<double>(i);
      case PointType::uint32:
      case PointType::uint64:
        return 3456789012.0 + static_cast<double>(i);
      default:
        return 515.0 + static_cast<double>(i);
    }
  }
  [[nodiscard]] std::string output_of(const std::string& command) const {
    const std::string all = command + " > " + (folder_ / "out") + " 2> " + (folder_ / "err");
    EXPECT_EQ(std::system(all.c_str()), 0) << all << "\n"
                                           << test::contents_of(folder_ / "out") << test::contents_of(folder_ / "err");
    return test::contents_of(folder_ / "out");
  }

  test::ScratchFolder folder_;
  test::MemoryDoor door_{test::points_of_every_type()};
  Server server_{make_register_map(door_.points(), {.title = "T", .order = GetParam()}), door_, {.port = 0}};
};

TEST_P(Interoperation, Pymodbus) {
  const std::string file = folder_.write("map.json", as_json(*server_.map()));
  std::istringstream lines(output_of("/usr/bin/python3 " HYSTERON_SOURCE_DIR
                                     "/tests/runtime/modbus/interop_pymodbus.py " +
                                     std::to_string(server_.port()) + " " + file));
  std::map<std::string, double> read;
  std::string name;
  for (std::string value; lines >> name >> value;) {
    read[name] = std::stod(value);
  }
  for (std::size_t i = 0; i < door_.points().size(); ++i) {
    const Point& point = door_.points()[i];
    EXPECT_EQ(read[point.name], given(i)) << point.name;
    const double changed = point.type == PointType::boolean ? 1.0 - given(i) : given(i) + 1.0;
    EXPECT_EQ(door_.value(i), point.writable ? changed : given(i)) << point.name;
  }
}

/// mbpoll knows values of 32 bits with the low word first, or, by -B, with the high word first.
TEST_P(Interoperation, Mbpoll) {
  if (bytes_swapped(GetParam())) {
    return;
  }
  const std::string order = low_word_first(GetParam()) ? "" : "-B ";
  for (const auto& [name, type] :
       {std::pair{"R32.W", "4:float"}, {"I32.W", "4:int"}, {"I16.W", "4"}, {"R32.R", "3:float"}, {"I32.R", "3:int"}}) {
    const auto map = server_.map();
    for (const MapEntry& entry : map->entries()) {
      if (map->point_of(entry).name == name) {
        const std::string text =
            output_of("mbpoll -q -1 -0 -m tcp -a 1 " + order + "-p " + std::to_string(server_.port()) + " -t " + type +
                      " -r " + std::to_string(entry.at.address) + " 127.0.0.1");
        const auto colon = text.find("]:");
        ASSERT_NE(colon, std::string::npos) << text;
        EXPECT_EQ(std::stod(text.substr(colon + 2)), given(entry.point)) << name << "\n" << text;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(WordOrders, Interoperation, ::testing::ValuesIn(word_orders),
                         [](const auto& order) { return std::string(name_of(order.param)); });

}  // namespace
}  // namespace hysteron::runtime::modbus
