// The server on a serial line, beside its connections: libmodbus as the master, a line that is lost, and echoes.
#include <gtest/gtest.h>
#include <modbus/modbus.h>

#include <array>
#include <filesystem>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "runtime/modbus/device.hpp"
#include "runtime/modbus/serial_line.hpp"
#include "runtime/modbus/server.hpp"
#include "tests/runtime/modbus/client_socket.hpp"
#include "tests/runtime/modbus/memory_door.hpp"
#include "tests/runtime/modbus/serial_device.hpp"
#include "tests/support/scratch_folder.hpp"
#include "tests/support/soon.hpp"

namespace hysteron::runtime::modbus {
namespace {

using test::soon;
using test::with_crc;
using Line = std::vector<std::uint8_t>;

constexpr std::uint8_t station = 5;

/// Two pseudo-terminals, and a thread that carries bytes between them, as a cable would: both ends are lines.
class Cable {
 public:
  Cable()
      : thread_([this](const std::stop_token& stop) {
          while (!stop.stop_requested()) {
            std::array<pollfd, 2> ends{{{a_.other(), POLLIN, 0}, {b_.other(), POLLIN, 0}}};
            if (::poll(ends.data(), 2, 10) > 0) {
              carry(ends[0], b_);
              carry(ends[1], a_);
            }
          }
        }) {}
  [[nodiscard]] const std::string& one_end() const { return a_.path(); }
  [[nodiscard]] const std::string& other_end() const { return b_.path(); }

 private:
  static void carry(const pollfd& from, const test::PseudoLine& to) {
    std::array<std::uint8_t, 256> bytes{};
    if ((from.revents & POLLIN) != 0) {
      const ssize_t got = ::read(from.fd, bytes.data(), bytes.size());
      (void)to.send(std::span(bytes).first(static_cast<std::size_t>(std::max<ssize_t>(got, 0))));
    }
  }
  test::PseudoLine a_;
  test::PseudoLine b_;
  std::jthread thread_;
};

ServerOptions on_line(const std::string& path, bool has_echo = false) {
  return {.listen = "",
          .rtu = RtuOptions{.line = {.path = path, .baud = 115200, .has_echo = has_echo}, .unit = station}};
}

struct Freed {
  void operator()(modbus_t* context) const {
    ::modbus_close(context);
    ::modbus_free(context);
  }
};

TEST(RtuServer, LibmodbusIsItsMaster) {
  const Cable cable;
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  const Server server(map, door, on_line(cable.one_end()));
  const std::unique_ptr<modbus_t, Freed> master(::modbus_new_rtu(cable.other_end().c_str(), 115200, 'E', 8, 1));
  ASSERT_EQ(::modbus_set_slave(master.get(), station), 0);
  ::modbus_set_response_timeout(master.get(), 1, 0);
  ASSERT_EQ(::modbus_connect(master.get()), 0);
  std::array<std::uint16_t, 125> back{};
  // The line is opened in the server's thread.
  ASSERT_TRUE(soon([&] { return ::modbus_read_registers(master.get(), 20, 1, back.data()) == 1; }));
  ::modbus_set_response_timeout(master.get(), 10, 0);
  const auto before = server.status().requests;
  std::array<std::uint16_t, 20> words{};
  for (std::uint16_t i = 0; i < words.size(); ++i) {
    words.at(i) = static_cast<std::uint16_t>(1000 + i);
  }
  ASSERT_EQ(::modbus_write_registers(master.get(), 20, 20, words.data()), 20) << modbus_strerror(errno);
  ASSERT_EQ(::modbus_read_registers(master.get(), 20, 20, back.data()), 20);
  EXPECT_TRUE(std::equal(words.begin(), words.end(), back.begin()));
  ASSERT_EQ(::modbus_read_registers(master.get(), chain_address, 125, back.data()), 125) << "the longest answer";
  EXPECT_EQ(back[0], 0x4859);
  ASSERT_EQ(::modbus_write_bit(master.get(), 3, 1), 1);
  std::array<std::uint8_t, 21> bits{};
  ASSERT_EQ(::modbus_read_bits(master.get(), 0, 21, bits.data()), 21);
  EXPECT_EQ(bits[3], 1);
  EXPECT_EQ(::modbus_read_registers(master.get(), 30000, 1, back.data()), -1);
  EXPECT_EQ(errno, EMBXILADD);
  EXPECT_EQ(server.status().requests, before + 6U);
  EXPECT_EQ(server.status().line.broken, 0U);
  EXPECT_EQ(server.port(), 0) << "it listens nowhere";
}

TEST(RtuServer, OurOwnClientReadsAndWritesIt) {
  const Cable cable;
  test::MemoryDoor door(test::points_of_every_type());
  const RegisterMap map = make_register_map(door.points(), {.title = "T"});
  const Server server(map, door, on_line(cable.one_end()));
  Device device(
      {.link = SerialLink{.path = cable.other_end(), .baud = 115200},
       .unit = station,
       .values = {{.at = {Area::holding_register, 20, 1}}, {.at = {Area::holding_register, 21, 1}, .written = true}},
       .response = milliseconds(5000)},
      {.own_thread = false});
  door.set(map.find(Area::holding_register, 20)->point, 815.0);
  device.write(1, 4711.0);
  ASSERT_TRUE(soon([&] { return device.round(); })) << "once the server's thread has opened the line";
  EXPECT_EQ(device.read(0).value, 815.0);
  EXPECT_EQ(door.value(map.find(Area::holding_register, 21)->point), 4711.0);
}

TEST(RtuServer, AnswersItsUnitAloneAndCountsWhatIsBroken) {
  const test::PseudoLine line;
  test::MemoryDoor door(test::points_of_every_type());
  const Server server(make_register_map(door.points(), {.title = "T"}), door, on_line(line.path(), true));
  const Line request = with_crc({station, 3, 0, 20, 0, 1});
  const auto answers = [&] {
    (void)line.send(request);
    const Line answer = line.take(7, milliseconds(500));
    (void)line.send(answer);  // the adapter at the server's end gives it back
    return answer == with_crc({station, 3, 2, 0, 0});
  };
  ASSERT_TRUE(soon(answers)) << "the line is opened in the server's thread";
  Line damaged = request;
  damaged.back() ^= 1U;
  ASSERT_TRUE(line.send(damaged));
  ASSERT_TRUE(soon([&] { return server.status().line.broken == 1; }));
  ASSERT_TRUE(line.send(with_crc({9, 3, 0, 20, 0, 1})));
  EXPECT_EQ(line.take(1, milliseconds(100)), Line{}) << "another unit's";
  ASSERT_TRUE(line.send(with_crc({0, 6, 0, 20, 0, 7})));
  EXPECT_EQ(line.take(1, milliseconds(100)), Line{}) << "a broadcast has no answer";
  EXPECT_EQ(server.status().writes, 1U);
  EXPECT_EQ(server.status().line.broadcasts, 1U);
  EXPECT_EQ(server.status().line.echo_lost, 0U);
}

TEST(RtuServer, ALineThatIsNotThereIsToldOnceAndTriedAgain) {
  const test::ScratchFolder folder;
  const std::string path = folder / "line";
  std::mutex mutex;
  std::vector<std::string> lines;
  ServerOptions options = on_line(path);
  options.listen = "127.0.0.1";
  options.port = 0;
  options.tell = [&](const std::string& line) {
    const std::scoped_lock lock(mutex);
    lines.push_back(line);
  };
  test::MemoryDoor door(test::points_of_every_type());
  const Server server(make_register_map(door.points(), {.title = "T"}), door, options);
  const auto told = [&] {
    const std::scoped_lock lock(mutex);
    return lines.size();
  };
  ASSERT_TRUE(soon([&] { return told() == 1; }));
  const test::ClientSocket client(server.port());
  const auto is_served = [&](const test::PseudoLine& line) {
    return soon([&] {
      (void)line.send(with_crc({station, 3, 0, 20, 0, 1}));
      return line.take(7, milliseconds(200)).size() == 7;
    });
  };
  for (std::size_t round = 1; round <= 2; ++round) {
    auto line = std::make_unique<test::PseudoLine>();
    std::filesystem::remove(path);
    std::filesystem::create_symlink(line->path(), path);
    EXPECT_TRUE(is_served(*line));
    EXPECT_EQ(told(), 2 * round) << "there again";
    line.reset();
    EXPECT_TRUE(soon([&] { return told() == 2 * round + 1; })) << "and lost";
    EXPECT_TRUE(client.send(test::read_one)) << "nobody else notices";
    EXPECT_EQ(client.receive(11).size(), 11U);
  }
}

TEST(SerialLine, IsForOneProgramAndHasRealRates) {
  const test::PseudoLine line;
  const SerialLink link{.path = line.path(), .baud = 9600, .parity = 'O', .stop_bits = 2};
  const OpenedLine first = open_line(link);
  ASSERT_EQ(first.problem, "");
  termios settings{};
  ASSERT_EQ(::tcgetattr(first.line.number(), &settings), 0);
  EXPECT_EQ(::cfgetispeed(&settings), B9600);
  EXPECT_EQ(settings.c_cflag & CSTOPB, tcflag_t{CSTOPB});
  EXPECT_EQ(open_line(link).problem, "another program has it");
  EXPECT_NE(open_line({.path = "/nowhere"}).problem, "");
  EXPECT_NE(open_line({.path = "/dev/null"}).problem, "") << "no line";
  EXPECT_FALSE(is_baud_rate(20000));
  EXPECT_TRUE(is_baud_rate(57600));
}

}  // namespace
}  // namespace hysteron::runtime::modbus
