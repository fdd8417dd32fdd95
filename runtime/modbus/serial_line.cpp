#include "runtime/modbus/serial_line.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <termios.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <optional>
#include <system_error>
#include <utility>

namespace hysteron::runtime::modbus {
namespace {

constexpr std::array<std::pair<int, speed_t>, 24> rates{
    {{300, B300},         {600, B600},         {1200, B1200},       {1800, B1800},       {2400, B2400},
     {4800, B4800},       {9600, B9600},       {19200, B19200},     {38400, B38400},     {57600, B57600},
     {115200, B115200},   {230400, B230400},   {460800, B460800},   {500000, B500000},   {576000, B576000},
     {921600, B921600},   {1000000, B1000000}, {1152000, B1152000}, {1500000, B1500000}, {2000000, B2000000},
     {2500000, B2500000}, {3000000, B3000000}, {3500000, B3500000}, {4000000, B4000000}}};

std::optional<speed_t> speed_of(int baud) {
  const auto* const found = std::ranges::find(rates, baud, &std::pair<int, speed_t>::first);
  return found == rates.end() ? std::nullopt : std::optional(found->second);
}

OpenedLine refused(int reason) {
  return {.problem = std::system_category().message(reason)};
}

}  // namespace

bool is_baud_rate(int baud) {
  return speed_of(baud).has_value();
}

OpenedLine open_line(const SerialLink& link) {
  OpenedLine opened{.line = Descriptor(::open(link.path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC))};
  if (!opened.line.is_open()) {
    return refused(errno);
  }
  termios settings{};
  const auto speed = speed_of(link.baud);
  if (::tcgetattr(opened.line.number(), &settings) != 0) {
    return refused(errno);
  }
  if (!speed) {
    return refused(EINVAL);
  }
  if (::flock(opened.line.number(), LOCK_EX | LOCK_NB) != 0) {
    return {.problem = "another program has it"};
  }
  ::cfmakeraw(&settings);
  ::cfsetispeed(&settings, *speed);
  ::cfsetospeed(&settings, *speed);
  settings.c_cflag &= ~static_cast<tcflag_t>(PARENB | PARODD | CSTOPB | CRTSCTS);
  settings.c_cflag |= CREAD | CLOCAL;
  settings.c_cflag |= link.parity == 'N' ? 0U : link.parity == 'O' ? PARENB | PARODD : PARENB;
  settings.c_cflag |= link.stop_bits == 2 ? CSTOPB : 0U;
  settings.c_iflag |=
      link.parity == 'N' ? 0U : INPCK;  // a character of the wrong parity arrives as 0: the checksum tells
  settings.c_cc[VMIN] = 1;              // so that 0 bytes read are the end of the line, not the want of bytes
  settings.c_cc[VTIME] = 0;
  if (::tcsetattr(opened.line.number(), TCSANOW, &settings) != 0) {
    return refused(errno);
  }
  (void)::tcflush(opened.line.number(), TCIOFLUSH);
  return opened;
}

}  // namespace hysteron::runtime::modbus
