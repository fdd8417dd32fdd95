#include "runtime/modbus/register_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "runtime/modbus/address_text.hpp"
#include "runtime/modbus/discovery.hpp"
#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::modbus {
namespace {

using ::testing::HasSubstr;

std::map<std::string, Stretch> addresses(const RegisterMap& map) {
  std::map<std::string, Stretch> result;
  for (const MapEntry& entry : map.entries()) {
    result[map.point_of(entry).name] = entry.at;
  }
  return result;
}

std::vector<Point> some_points(std::mt19937& random, std::size_t count, const std::string& prefix) {
  std::vector<Point> points;
  for (std::size_t i = 0; i < count; ++i) {
    points.push_back({.name = prefix + std::to_string(i),
                      .type = point_types[random() % point_types.size()],
                      .unit = "V",
                      .writable = random() % 2 == 0});
  }
  return points;
}

TEST(RegisterMap, EveryPointHasItsOwnAlignedAddress) {
  std::mt19937 random(1);
  for (int round = 0; round < 50; ++round) {
    const auto points = some_points(random, random() % 200, "P");
    const RegisterMap map = make_register_map(points, {.title = "T"});
    ASSERT_EQ(map.entries().size(), points.size());
    std::set<std::pair<Area, std::uint32_t>> taken;
    for (const MapEntry& entry : map.entries()) {
      const Point& point = map.point_of(entry);
      EXPECT_EQ(entry.at.count, registers_of(point.type));
      EXPECT_EQ(entry.at.address % entry.at.count, 0U);
      EXPECT_EQ(holds_bits(entry.at.area), point.type == PointType::boolean);
      EXPECT_EQ(entry.at.area == Area::coil || entry.at.area == Area::holding_register, point.writable);
      for (std::uint32_t i = 0; i < entry.at.count; ++i) {
        EXPECT_TRUE(taken.insert({entry.at.area, entry.at.address + i}).second);
        EXPECT_EQ(map.find(entry.at.area, entry.at.address + i), &entry);
      }
    }
    for (const Area area : areas) {  // without holes
      std::uint32_t used = 0;
      for (const MapEntry& entry : map.entries_in(area)) {
        used += entry.at.count;
      }
      for (std::uint32_t at = 0; at < 1000; ++at) {
        EXPECT_EQ(map.find(area, at) != nullptr, at < used);
      }
    }
  }
}

TEST(RegisterMap, ALockFileKeepsAddressesThroughEdits) {
  std::mt19937 random(2);
  auto points = some_points(random, 60, "A");
  std::string lock;
  std::map<std::string, Stretch> known;
  for (int edit = 0; edit < 30; ++edit) {
    const RegisterMap map = make_register_map(points, {.title = "T", .lock_file = "t.lock", .lock_text = lock});
    const auto now = addresses(map);
    for (const auto& [name, at] : now) {
      const auto before = known.find(name);
      if (before != known.end()) {
        EXPECT_EQ(before->second, at) << name << " moved";
      }
      known[name] = at;
    }
    for (const auto& [name, at] : known) {  // nobody has the address of one that went
      if (!now.contains(name)) {
        EXPECT_EQ(map.find(at.area, at.address), nullptr) << name;
      }
    }
    lock = lock_text(map);
    EXPECT_EQ(lock_text(make_register_map(points, {.title = "T", .lock_file = "t.lock", .lock_text = lock})), lock);
    for (int gone = 0; gone < 5; ++gone) {
      points.erase(points.begin() + static_cast<long>(random() % points.size()));
    }
    for (Point& one : some_points(random, 5, "E" + std::to_string(edit) + "_")) {
      points.insert(points.begin() + static_cast<long>(random() % points.size()), one);
    }
  }
}

/// As in a diagram, Y_REF is y_ref. A line with the very name goes before one that is only alike.
TEST(RegisterMap, ANameWrittenInOtherCaseKeepsItsAddress) {
  const std::vector<Point> points{{.name = "A", .type = PointType::real32, .writable = true},
                                  {.name = "y_ref", .type = PointType::real32, .writable = true}};
  const auto map_of = [&](const std::string& lock) {
    return make_register_map(points, {.title = "T", .lock_file = "t.lock", .lock_text = lock});
  };
  const RegisterMap map = map_of("holding 0 real32 Y_REF\nholding 4 real32 A\n");
  EXPECT_EQ(addresses(map).at("y_ref").address, 0U);
  EXPECT_TRUE(map.retired().empty());
  EXPECT_THAT(lock_text(map), HasSubstr("\nholding 0 real32 y_ref\n"));
  const RegisterMap both = map_of("holding 0 real32 Y_REF\nholding 8 real32 y_ref\nholding 4 real32 A\n");
  EXPECT_EQ(addresses(both).at("y_ref").address, 8U);
  EXPECT_EQ(both.retired().size(), 1U);
}

TEST(RegisterMap, APointThatChangedItsTypeGetsANewAddress) {
  std::vector<Point> points{{.name = "X", .type = PointType::real32, .writable = true}};
  const std::string lock = lock_text(make_register_map(points, {.title = "T"}));
  EXPECT_EQ(lock, "# Addresses of T. Keep this file with the diagram.\nholding 0 real32 X\n");
  points[0].type = PointType::real64;
  const RegisterMap map = make_register_map(points, {.title = "T", .lock_file = "t.lock", .lock_text = lock});
  EXPECT_EQ(addresses(map).at("X").address, 4U);
  EXPECT_EQ(map.find(Area::holding_register, 0), nullptr);
}

/// What was retired under the name of a point that is there is read back, and is the point's again with the old type.
TEST(RegisterMap, ALockFileHasANameOnceForEachTypeAndArea) {
  const auto after = [](const Point& point, const std::string& lock) {
    const RegisterMap map =
        make_register_map(std::vector<Point>{point, {.name = "Z", .type = PointType::real32, .writable = true}},
                          {.title = "T", .lock_file = "t.lock", .lock_text = lock});
    const RegisterMap again =
        make_register_map(map.points(), {.title = "T", .lock_file = "t.lock", .lock_text = lock_text(map)});
    EXPECT_EQ(lock_text(again), lock_text(map)) << "a start that changes nothing";
    return map;
  };
  const Point narrow{.name = "X", .type = PointType::real32, .writable = true};
  const Point wide{.name = "X", .type = PointType::real64, .writable = true};
  const RegisterMap first = after(narrow, "");
  const RegisterMap second = after(wide, lock_text(first));
  const Stretch old = addresses(first).at("X");
  EXPECT_EQ(second.find(old.area, old.address), nullptr) << "nobody has the address meanwhile";
  EXPECT_EQ(addresses(second).at("Z"), addresses(first).at("Z"));
  EXPECT_EQ(addresses(after(narrow, lock_text(second))).at("X"), old);
  EXPECT_EQ(addresses(after(wide, lock_text(after(narrow, lock_text(second))))), addresses(second));

  const Point read_only{.name = "X", .type = PointType::real64};
  const RegisterMap read = after(read_only, "");
  const RegisterMap written = after(wide, lock_text(read));
  EXPECT_EQ(addresses(written).at("X").area, Area::holding_register);
  EXPECT_EQ(written.find(Area::input_register, addresses(read).at("X").address), nullptr);
  EXPECT_EQ(addresses(after(read_only, lock_text(written))).at("X"), addresses(written).at("X"));
}

TEST(RegisterMap, OfPointsOfOneNameTheFirstAloneHasAnAddress) {
  const std::vector<Point> points{{.name = "K", .type = PointType::real64, .unit = "ms", .writable = true},
                                  {.name = "K", .type = PointType::real64, .unit = "s", .writable = true}};
  const RegisterMap map = make_register_map(points, {.title = "T"});
  ASSERT_EQ(map.entries().size(), 1U);
  EXPECT_EQ(map.entries()[0].point, 0U);
  EXPECT_EQ(make_register_map(points, {.title = "T", .expose = {"K"}}).entries().size(), 1U);
}

TEST(RegisterMap, TheHashIsOfAllThatAClientReliesOn) {
  const auto points = test::points_of_every_type();
  const MapRequest request{.title = "T"};
  const std::string hash = make_register_map(points, request).hash();
  EXPECT_EQ(hash.size(), 64U);
  EXPECT_EQ(make_register_map(points, request).hash(), hash);
  std::set<std::string> hashes{hash, make_register_map(points, {.title = "T", .order = WordOrder::dcba}).hash()};
  const auto changed = [&](auto change) {
    auto other = points;
    change(other[1]);
    hashes.insert(make_register_map(other, request).hash());
  };
  changed([](Point& point) { point.name = "Z"; });
  changed([](Point& point) { point.type = PointType::uint16; });
  changed([](Point& point) { point.unit = "mm"; });
  changed([](Point& point) { point.low = -7; });
  changed([](Point& point) { point.high = 7; });
  changed([](Point& point) { point.writable = true; });
  EXPECT_EQ(hashes.size(), 8U);
}

TEST(RegisterMap, OpenPlcAddresses) {
  struct Case {
    PointType type;
    bool writable;
    Stretch at;
  };
  const std::vector<Case> cases{
      {PointType::boolean, true, {Area::coil, 0, 1}},
      {PointType::boolean, false, {Area::discrete_input, 0, 1}},
      {PointType::int16, true, {Area::holding_register, 0, 1}},
      {PointType::uint16, false, {Area::input_register, 0, 1}},
      {PointType::real32, true, {Area::holding_register, 2048, 2}},
      {PointType::int32, false, {Area::holding_register, 2050, 2}},
      {PointType::real64, true, {Area::holding_register, 4096, 4}},
      {PointType::uint64, false, {Area::holding_register, 4100, 4}},
  };
  std::vector<Point> points;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    points.push_back({.name = "P" + std::to_string(i), .type = cases[i].type, .writable = cases[i].writable});
  }
  const auto found = addresses(make_register_map(points, {.title = "T", .placing = Placing::openplc}));
  for (std::size_t i = 0; i < cases.size(); ++i) {
    EXPECT_EQ(found.at("P" + std::to_string(i)), cases[i].at) << i;
  }
  std::vector<Point> words(1030, {.type = PointType::int16, .writable = true});
  for (std::size_t i = 0; i < words.size(); ++i) {
    words[i].name = "W" + std::to_string(i);
  }
  const auto many = addresses(make_register_map(words, {.title = "T", .placing = Placing::openplc}));
  EXPECT_EQ(many.at("W1029"), (Stretch{Area::holding_register, 1029, 1})) << "%MW5";
}

TEST(RegisterMap, AddressesInBothNotations) {
  const auto at = [](std::string_view text) { return parse_address(text)->at; };
  EXPECT_EQ(at("%QX0.0"), (Stretch{Area::coil, 0, 1}));
  EXPECT_EQ(at("%QX99.7"), (Stretch{Area::coil, 799, 1}));
  EXPECT_EQ(at("%ix1.2"), (Stretch{Area::discrete_input, 10, 1}));
  EXPECT_EQ(at("%IW1023"), (Stretch{Area::input_register, 1023, 1}));
  EXPECT_EQ(at("%QW7"), (Stretch{Area::holding_register, 7, 1}));
  EXPECT_EQ(at("%MW0"), (Stretch{Area::holding_register, 1024, 1}));
  EXPECT_EQ(at("%MD1"), (Stretch{Area::holding_register, 2050, 2}));
  EXPECT_EQ(at("%ML1023"), (Stretch{Area::holding_register, 8188, 4}));
  EXPECT_EQ(at("holding 16"), (Stretch{Area::holding_register, 16, 1}));
  for (const char* wrong : {"",           "%",          "%QX",        "%QX0",      "%QX0.8",     "%QX100.0",
                            "%QX0.-1",    "%QX 0.0",    "%IW1024",    "%QW-1",     "%QW",        "%MD1024",
                            "%ML1024",    "%XX0",       "QW0",        "holding",   "holding -1", "holding 65536",
                            "holding  1", "holding 1 ", "register 1", "%QW000001", "%QX0.0.0"}) {
    EXPECT_EQ(parse_address(wrong), std::nullopt) << wrong;
  }
}

TEST(RegisterMap, AGivenAddressReplacesTheOneInTheLockFile) {
  const std::vector<Point> points{{.name = "X", .type = PointType::int16, .writable = true},
                                  {.name = "Y", .type = PointType::int16, .writable = true}};
  const RegisterMap map = make_register_map(points, {.title = "T",
                                                     .given = {{"X", "%QW9"}},
                                                     .lock_file = "t.lock",
                                                     .lock_text = "holding 0 int16 X\nholding 1 int16 Y\n"});
  EXPECT_EQ(addresses(map).at("X").address, 9U);
  EXPECT_EQ(addresses(map).at("Y").address, 1U);
}

TEST(Discovery, AClientReadsTheMapBack) {
  const auto points = test::points_of_every_type();
  const RegisterMap map = make_register_map(points, {.title = "T", .order = WordOrder::badc});
  const auto found = read_chain(map.chain());
  ASSERT_TRUE(found.has_value());
  EXPECT_EQ(found->order, WordOrder::badc);
  EXPECT_EQ(found->hash, map.hash().substr(0, 32));
  ASSERT_EQ(found->points.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point& known = map.point_of(map.entries()[i]);
    const Point& read = found->points[i].point;
    EXPECT_EQ(found->points[i].at, map.entries()[i].at);
    EXPECT_EQ(std::tie(read.name, read.unit, read.type, read.kind, read.low, read.high, read.writable),
              std::tie(known.name, known.unit, known.type, known.kind, known.low, known.high, known.writable));
  }
}

TEST(Discovery, ATornChainIsNone) {
  const RegisterMap map = make_register_map(test::points_of_every_type(), {.title = "T"});
  for (std::size_t size = 0; size < map.chain().size(); ++size) {
    ASSERT_EQ(read_chain(map.chain().first(size)), std::nullopt) << size;
  }
  std::vector<std::uint16_t> torn(map.chain().begin(), map.chain().end());
  std::mt19937 random(4);
  for (int i = 0; i < 2000; ++i) {  // whatever the words, nothing is read beyond them
    const std::size_t at = random() % torn.size();
    const std::uint16_t old = torn[at];
    torn[at] = static_cast<std::uint16_t>(random());
    const auto found = read_chain(torn);
    ASSERT_TRUE(!found || found->points.size() == map.points().size());
    torn[at] = old;
  }
}

TEST(MapText, CsvQuotesAndJsonParses) {
  const RegisterMap map = make_register_map(test::points_of_every_type(), {.title = "T"});
  EXPECT_THAT(as_csv(map), HasSubstr("\nholding,0,4,int64,I64.W,um/V,-1000000000000000,1000000000000000,read write,"
                                     "parameter,\"a value, \"\"so\"\" to say\",,1,0,ABCD,false\n"));
  const auto json = nlohmann::json::parse(as_json(map));
  EXPECT_EQ(json["hash"], map.hash());
  EXPECT_EQ(json["points"].size(), map.points().size());
  EXPECT_EQ(json["points"][0]["name"], "FLAG.W");
  EXPECT_EQ(json["points"][0]["reference"], "000001");
  const Point open{.name = "X", .meaning = "a|b"};
  const RegisterMap one = make_register_map(std::vector{open}, {.title = "T"});
  EXPECT_TRUE(nlohmann::json::parse(as_json(one))["points"][0]["low"].is_null());
  std::vector kept{open};
  kept[0].is_retained = true;
  const RegisterMap retained = make_register_map(kept, {.title = "T"});
  EXPECT_THAT(as_csv(retained), HasSubstr(",retained\n"));
  EXPECT_THAT(as_csv(retained), testing::EndsWith(",true\n"));
  EXPECT_THAT(as_cpp(retained), HasSubstr(", -1, true},\n"));
  EXPECT_THAT(as_cpp(one), HasSubstr(", -1, false},\n"));
  EXPECT_EQ(retained.hash(), one.hash()) << "what is kept moves no value";
  EXPECT_THAT(as_markdown(one), HasSubstr("| input | 0 | 300001 | real64 | X |  |  |  | read | a\\|b |\n"));
}

TEST(MapText, TheHeaderCompilesAndKnowsItsNames) {
  const RegisterMap map = make_register_map(test::points_of_every_type(), {.title = "PIEZO-FF"});
  const test::ScratchFolder folder;
  std::ofstream(folder / "registers.hpp") << as_cpp(map);
  std::ofstream(folder / "good.cpp") << "#include \"registers.hpp\"\n"
                                        "static_assert(piezo_ff_registers::at(\"I64.W\").count == 4);\n"
                                        "static_assert(piezo_ff_registers::registers.size() == 98);\n";
  std::ofstream(folder / "bad.cpp") << "#include \"registers.hpp\"\n"
                                       "constexpr auto none = piezo_ff_registers::at(\"NONE\");\n";
  const auto compiles = [&](const std::string& file) {
    const std::string command =
        "c++ -std=c++20 -Wall -Wextra -Werror -fsyntax-only " + (folder / file) + " 2> " + (folder / "log");
    return std::system(command.c_str()) == 0;
  };
  EXPECT_TRUE(compiles("good.cpp")) << test::contents_of(folder / "log");
  EXPECT_FALSE(compiles("bad.cpp"));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
