// Clients in JavaScript against the server: every type in every word order, to the bit.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <tuple>

#include "runtime/modbus/map_text.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/support/scratch_folder.hpp"

namespace hysteron::runtime::modbus {
namespace {

/// As scripts/install-js-clients chooses it.
std::string clients_folder() {
  const auto of = [](const char* name) { return std::string(std::getenv(name) == nullptr ? "" : std::getenv(name)); };
  if (!of("HYSTERON_JS_CLIENTS").empty()) {
    return of("HYSTERON_JS_CLIENTS");
  }
  const std::string cache = of("XDG_CACHE_HOME").empty() ? of("HOME") + "/.cache" : of("XDG_CACHE_HOME");
  return cache + "/hysteron/js-clients";
}

class JavaScript : public ::testing::TestWithParam<std::tuple<const char*, WordOrder>> {};

/// Values that are the same in no two orders of bytes.
double given(const Point& point, std::size_t i) {
  switch (point.type) {
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

TEST_P(JavaScript, ReadsAndWritesEveryPoint) {
  const auto& [client, order] = GetParam();
  const std::string modules = clients_folder() + "/node_modules";
  if (std::system("command -v node > /dev/null") != 0 || !std::filesystem::exists(modules + "/" + client)) {
    GTEST_SKIP() << "no node, or no " << client << " in " << modules << ": scripts/install-js-clients fetches it";
  }
  test::MemoryDoor door(test::points_of_every_type());
  for (std::size_t i = 0; i < door.points().size(); ++i) {
    door.set(i, given(door.points()[i], i));
  }
  const Server server(make_register_map(door.points(), {.title = "T", .order = order}), door, {.port = 0});
  const test::ScratchFolder folder;
  const std::string map = folder.write("map.json", as_json(*server.map()));
  const std::string command =
      "NODE_PATH='" + modules + "' timeout 120 node " HYSTERON_SOURCE_DIR "/tests/clients/interop.js points " + client +
      " " + std::to_string(server.port()) + " '" + map + "' > '" + (folder / "out") + "' 2> '" + (folder / "err") + "'";
  ASSERT_EQ(std::system(command.c_str()), 0) << test::contents_of(folder / "err");
  std::istringstream lines(test::contents_of(folder / "out"));
  std::map<std::string, double> read;
  std::string name;
  for (std::string value; lines >> name >> value;) {
    read[name] = std::stod(value);
  }
  for (std::size_t i = 0; i < door.points().size(); ++i) {
    const Point& point = door.points()[i];
    EXPECT_EQ(read[point.name], given(point, i)) << point.name;
    const double changed = point.type == PointType::boolean ? 1.0 - given(point, i) : given(point, i) + 1.0;
    EXPECT_EQ(door.value(i), point.writable ? changed : given(point, i)) << point.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Clients, JavaScript,
                         ::testing::Combine(::testing::Values("jsmodbus", "modbus-serial"),
                                            ::testing::ValuesIn(word_orders)),
                         [](const auto& one) {
                           const std::string client = std::get<0>(one.param);
                           return std::string(client == "jsmodbus" ? "Jsmodbus" : "ModbusSerial") +
                                  std::string(name_of(std::get<1>(one.param)));
                         });

}  // namespace
}  // namespace hysteron::runtime::modbus
