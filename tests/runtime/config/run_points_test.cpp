// The run file on points: how each lies on the server and on devices, and on which line.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <string>

#include "tests/runtime/config/run_file.hpp"

namespace hysteron::runtime {
namespace {

TEST(RunPoints, ValuesOnDevicesHaveFormats) {
  const auto config = parse_run_config("RUN.toml", R"(
[devices.drive]
word_order = "cdab"
[outputs.Y]
safe = 0.5
device = "drive"
register = 3
type = "int16"
scale = 0.1
[inputs.X]
device = "drive"
register = 10
type = "bcd32"
offset = -20.0
word_order = "abcd"
[inputs.Z]
device = "drive"
register = 12
bit = 15
)",
                                       plant());
  const auto& values = config.devices[0].values;
  EXPECT_EQ(values.at(config.device_outputs[0].link.value).format,
            (modbus::PointFormat{.type = PointType::int16, .scale = 0.1, .order = modbus::WordOrder::cdab}));
  EXPECT_EQ(values.at(config.device_inputs[0].link.value).format,
            (modbus::PointFormat{.type = {PointType::uint32, true}, .offset = -20.0}));
  EXPECT_EQ(values.at(config.device_inputs[1].link.value).at,
            (modbus::Stretch{modbus::Area::holding_register, 12, 1, 15}));
  EXPECT_EQ(values.at(config.device_inputs[1].link.value).format.type, PointType::boolean);
  EXPECT_EQ(config.task.outputs[0].high, 10.0) << "the diagram's is nearer than that of the type";
  EXPECT_EQ(config.task.field_points.size(), 9U);
  EXPECT_EQ(config.task.field_points[1].name, "device.drive.connections");
}

TEST(RunPoints, UnfitFormatsOnDevicesAreRefused) {
  const auto with = [](const std::string& rest) {
    return "[devices.a]\n[outputs.Y]\nsafe = 0.0\ndevice = \"a\"\n" + rest;
  };
  EXPECT_EQ(errors_of(with("type = \"int16\"\nscale = 0.0\n")), "860@6:9 ");
  EXPECT_EQ(errors_of(with("type = \"int16\"\nword_order = \"cdab\"\n")), "860@6:14 ");
  EXPECT_EQ(errors_of(with("type = \"int16\"\nscale = 1e-9\noffset = 1e9\n")), "860@6:9 ");
  EXPECT_EQ(errors_of(with("area = \"coil\"\nbit = 3\n")), "804@6:7 ");
  EXPECT_EQ(errors_of(with("bit = 3\ntype = \"int16\"\n")), "804@6:8 ");
  EXPECT_EQ(errors_of(with("bit = 16\n")), "805@5:7 ");
  EXPECT_EQ(errors_of(with("bit = 0\nscale = 2.0\n")), "860@6:9 ");
  EXPECT_EQ(errors_of(with("type = \"uint16\"\nscale = 0.1\noffset = 0.05\n")), "808@3:8 ") << "0 is on no step";
  EXPECT_EQ(errors_of("[outputs.Y]\nsafe = 0.0\nscale = 2.0\n"), "810@3:9 ");
  ProgramShape bits;
  bits = plant_of_two();
  const std::string two =
      "[devices.a]\n[outputs.W]\nsafe = 0.0\ndevice = \"a\"\nbit = 1\n[outputs.Y]\nsafe = 0.0\n"
      "device = \"a\"\n";
  EXPECT_EQ(errors_of(two + "bit = 2\n", bits), "");
  EXPECT_EQ(errors_of(two + "bit = 1\n", bits), "813@8:10 ");
  EXPECT_EQ(errors_of(two + "type = \"int16\"\n", bits), "813@8:10 ");
}

TEST(RunPoints, PointsOfTheServerHaveFormatsToo) {
  const std::string y = "[outputs.Y]\nsafe = 0\n";
  const auto config = parse_run_config("RUN.toml", y + R"(
[modbus]
expose = ["X", "Y", "HYST.*"]
discovery = false
idle = "10s"
evict = "1s"
[registers.X]
at = "holding 16"
type = "bcd16"
scale = 0.1
[registers.HYST.C1]
word_order = "dcba"
[registers."task.fault"]
at = "input 3"
)",
                                       plant());
  const auto& registers = config.modbus->registers;
  ASSERT_EQ(registers.size(), 3U);
  const auto of = [&](const std::string& name) {
    return *std::ranges::find(registers, name, &modbus::GivenRegister::name);
  };
  EXPECT_EQ(of("X").address, "holding 16");
  EXPECT_EQ(of("X").format->type, modbus::RegisterType(PointType::uint16, true));
  EXPECT_EQ(of("X").format->scale, 0.1);
  EXPECT_EQ(of("HYST.C1").format->order, modbus::WordOrder::dcba);
  EXPECT_EQ(of("task.fault").format, std::nullopt);
  EXPECT_EQ(config.modbus->expose.size(), 3U);
  EXPECT_FALSE(config.modbus->has_discovery);
  EXPECT_EQ(config.modbus->idle, std::chrono::seconds(10));
  EXPECT_EQ(config.modbus->evict, std::chrono::seconds(1));
  EXPECT_EQ(errors_of(y + "[modbus]\n[registers.X]\n"), "804@4:1 ");
  EXPECT_EQ(errors_of(y + "[modbus]\n[registers]\nX = 3\n"), "804@5:5 ");
  EXPECT_EQ(errors_of(y + "[registers.X]\nscale = 2.0\n"), "804@3:1 ");
  EXPECT_EQ(errors_of(y + "[modbus]\nexpose = []\n"), "804@4:10 ");
}

TEST(RunPoints, ASerialLineOfTheServer) {
  const std::string y = "[outputs.Y]\nsafe = 0\n";
  const auto config = parse_run_config("RUN.toml", y + R"(
[modbus]
listen = "off"
[modbus_rtu]
serial = "/dev/ttyS1"
baud = 9600
parity = "none"
stop_bits = 2
echo = true
unit = 17
longest_gap = "50ms"
read_only = true
)",
                                       plant());
  EXPECT_EQ(config.modbus->listen, "");
  const modbus::RtuOptions& rtu = config.modbus->rtu.value();
  EXPECT_EQ(rtu.line,
            (modbus::SerialLink{.path = "/dev/ttyS1", .baud = 9600, .parity = 'N', .stop_bits = 2, .has_echo = true}));
  EXPECT_EQ(rtu.unit, 17);
  EXPECT_EQ(rtu.longest_gap, std::chrono::milliseconds(50));
  EXPECT_TRUE(rtu.read_only);
  const std::string line = "[modbus_rtu]\nserial = \"/dev/ttyS1\"\n";
  EXPECT_EQ(errors_of(y + line), "804@3:1 ") << "no map";
  EXPECT_EQ(errors_of(y + "[modbus]\n[modbus_rtu]\n"), "804@4:1 ") << "no line";
  EXPECT_EQ(errors_of(y + "[modbus]\nlisten = \"off\"\n"), "804@3:1 ") << "nobody is served";
  EXPECT_EQ(errors_of(y + "[modbus]\nlisten = \"off\"\nport = 99\n" + line), "804@5:8 ");
  EXPECT_EQ(errors_of(y + "[modbus]\n" + line + "baud = 20000\n"), "805@6:8 ");
  EXPECT_EQ(errors_of(y + "[modbus]\n" + line + "unit = 255\n"), "805@6:8 ");
  EXPECT_EQ(errors_of(y + "[devices.a]\nserial = \"/dev/ttyS1\"\n[modbus]\n" + line), "804@7:10 ");
}

TEST(RunPoints, UnitsAndNamesOfDevices) {
  const auto with = [](const std::string& device) { return "[outputs.Y]\nsafe = 0\n[devices." + device; };
  const auto config = parse_run_config("RUN.toml", with("a]\nunit = 255\nconnection = \"shared\"\n"), plant());
  EXPECT_EQ(config.devices[0].unit, 255);
  EXPECT_TRUE(config.devices[0].shares_connection);
  EXPECT_EQ(errors_of(with("a]\nunit = 250\n")), "805@4:8 ");
  EXPECT_EQ(errors_of(with("a]\nserial = \"/dev/ttyS1\"\nunit = 255\n")), "805@5:8 ");
  EXPECT_EQ(errors_of(with("a]\nserial = \"/dev/ttyS1\"\nunit = 0\n")), "805@5:8 ") << "nobody answers all";
  EXPECT_EQ(errors_of(with("a]\nserial = \"/dev/ttyS1\"\nconnection = \"shared\"\n")), "804@5:14 ");
  EXPECT_EQ(errors_of(with("a]\necho = true\n")), "804@4:8 ");
  EXPECT_EQ(errors_of(with("\"a b\"]\n")), "804@3:1 ");
}

}  // namespace
}  // namespace hysteron::runtime
