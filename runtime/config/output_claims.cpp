#include "runtime/config/output_claims.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/resource.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstddef>
#include <cstring>
#include <filesystem>
#include <map>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

#include "runtime/modbus/host_names.hpp"
#include "runtime/modbus/value_bits.hpp"
#include "support/sha256.hpp"

namespace hysteron::runtime {
namespace {

/// As digits; what leads to this machine without naming it, and IPv4 in the clothes of IPv6, as what it stands for.
std::string digits_of(const std::string& address) {
  std::array<char, INET6_ADDRSTRLEN> text{};
  in6_addr six{};
  in_addr four{};
  if (::inet_pton(AF_INET6, address.c_str(), &six) == 1) {
    if (IN6_IS_ADDR_V4MAPPED(&six)) {
      return ::inet_ntop(AF_INET, &six.s6_addr[12], text.data(), text.size());
    }
    six = IN6_IS_ADDR_UNSPECIFIED(&six) ? in6addr_loopback : six;
    return ::inet_ntop(AF_INET6, &six, text.data(), text.size());
  }
  if (::inet_pton(AF_INET, address.c_str(), &four) == 1) {
    four.s_addr = four.s_addr == htonl(INADDR_ANY) ? htonl(INADDR_LOOPBACK) : four.s_addr;
    return ::inet_ntop(AF_INET, &four, text.data(), text.size());
  }
  return address;  // of one network interface: fe80::1%eth0
}

/// By what the system reaches a device: all addresses of a host, the one file of a serial line. As the run file spells
/// it where that leads to nothing.
std::set<std::string> ways_to(const std::variant<modbus::TcpLink, modbus::SerialLink>& link) {
  if (const auto* const serial = std::get_if<modbus::SerialLink>(&link)) {
    std::error_code none;
    const auto path = std::filesystem::canonical(serial->path, none);
    return {none ? serial->path : path.string()};
  }
  const auto& tcp = std::get<modbus::TcpLink>(link);
  std::set<std::string> ways;
  for (const std::string& address : tcp.known) {
    ways.insert(fmt::format("{}:{}", digits_of(address), tcp.port));
  }
  return ways.empty() ? std::set<std::string>{text_of(link)} : ways;
}

std::string name_of(const std::string& way, std::uint8_t unit, modbus::Area area, std::uint32_t address) {
  return "hysteron-output-" + sha256(fmt::format("{} {} {} {}", way, unit, static_cast<int>(area), address));
}

/// These go to the device in one write, which is of this task alone.
bool are_bits_of_one_register(const RunConfig& config, const DeviceLink& a, const DeviceLink& b) {
  const auto at = [&](const DeviceLink& link) { return config.devices[link.device].values[link.value].at; };
  return a.device == b.device && at(a).is_bit() && at(b).is_bit() && !at(a).overlaps(at(b));
}

/// Out of the way of devices and clients: select has room for the descriptors below FD_SETSIZE alone. Where the limits
/// do not let it, it stays where it is.
void move_up(Descriptor& socket) {
  rlimit limit{};
  if (::getrlimit(RLIMIT_NOFILE, &limit) == 0 && limit.rlim_cur < limit.rlim_max) {
    limit.rlim_cur = limit.rlim_max;
    (void)::setrlimit(RLIMIT_NOFILE, &limit);
  }
  if (const int higher = ::fcntl(socket.number(), F_DUPFD_CLOEXEC, FD_SETSIZE); higher >= 0) {
    socket = Descriptor(higher);
  }
}

struct Address {
  sockaddr_un text{};
  socklen_t size = 0;
};

/// A name that is in no file system: a zero byte stands before it.
Address address_of(const std::string& name) {
  Address address;
  address.text.sun_family = AF_UNIX;
  std::memcpy(static_cast<char*>(address.text.sun_path) + 1, name.data(), name.size());
  address.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + name.size());
  return address;
}

Descriptor new_socket() {
  return Descriptor(::socket(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
}

Descriptor socket_or_throw() {
  Descriptor socket = new_socket();
  if (!socket.is_open()) {
    throw std::system_error(errno, std::system_category(), "a socket to claim an output by");
  }
  return socket;
}

bool bind_to(const Descriptor& socket, const std::string& name) {
  const Address address = address_of(name);
  return ::bind(socket.number(), reinterpret_cast<const sockaddr*>(&address.text), address.size) == 0;
}

/// False where another has the name.
bool bind_or_throw(const Descriptor& socket, const std::string& name) {
  const bool is_bound = bind_to(socket, name);
  if (!is_bound && errno != EADDRINUSE) {
    throw std::system_error(errno, std::system_category(), "the name by which an output is claimed");
  }
  return is_bound;
}

bool connect_to(const Descriptor& socket, const std::string& name) {
  const Address address = address_of(name);
  return ::connect(socket.number(), reinterpret_cast<const sockaddr*>(&address.text), address.size) == 0;
}

/// Who listens at the other end: nothing where that is neither this user nor root, whose word would not count.
std::optional<pid_t> trusted_peer(const Descriptor& socket) {
  ucred peer{};
  socklen_t size = sizeof peer;
  const bool is_known = ::getsockopt(socket.number(), SOL_SOCKET, SO_PEERCRED, &peer, &size) == 0;
  return is_known && (peer.uid == ::geteuid() || peer.uid == 0) ? std::optional(peer.pid) : std::nullopt;
}

/// The name under which the guard listens once its task is gone.
std::string guard_name(const std::string& name) {
  return name + "-guard";
}

/// Whether who is at the other end is still there: nobody sends anything.
bool is_there(const Descriptor& socket) {
  char nothing = 0;
  return ::recv(socket.number(), &nothing, 1, MSG_DONTWAIT) < 0 && errno == EAGAIN;
}

}  // namespace

OutputClaims::OutputClaims(const RunConfig& config) {
  std::vector<std::set<std::string>> ways;
  for (const modbus::DeviceOptions& device : config.devices) {
    ways.push_back(ways_to(device.link));
  }
  std::map<std::string, std::size_t> outputs;
  for (std::size_t i = 0; i < config.device_outputs.size(); ++i) {
    const DeviceLink& link = config.device_outputs[i].link;
    const modbus::DeviceOptions& device = config.devices[link.device];
    const modbus::RemoteValue& value = device.values[link.value];
    const auto width = static_cast<std::uint32_t>(modbus::registers_of(value.format.type));
    for (const std::string& way : ways[link.device]) {
      for (std::uint32_t address = value.at.address; address < value.at.address + width; ++address) {
        const std::string name = name_of(way, device.unit, value.at.area, address);
        const auto [first, is_new] = outputs.emplace(name, i);
        if (is_new) {
          claims_.push_back({.name = name, .output = i, .address = address});
        } else if (!are_bits_of_one_register(config, link, config.device_outputs[first->second].link)) {
          own_ = own_ ? own_ : Holder{.output = i, .address = address, .own = first->second};
        }
      }
    }
  }
}

std::optional<OutputClaims::Holder> OutputClaims::claim() {
  if (own_ || !sockets_.empty()) {
    return own_;  // or claimed before
  }
  std::vector<Descriptor> sockets;
  for (const Claim& claim : claims_) {
    sockets.push_back(socket_or_throw());
    move_up(sockets.back());
    if (!bind_or_throw(sockets.back(), claim.name)) {
      Holder holder{.output = claim.output, .address = claim.address, .guard = guard_of(claim)};
      holder.is_foreign = !holder.guard && !is_of_a_task(claim);
      if (holder.is_foreign && passes_over_foreign_) {
        continue;
      }
      // None is kept: of two tasks that wait for one another's outputs, each would wait for ever.
      return holder;
    }
    (void)::listen(sockets.back().number(), SOMAXCONN);
  }
  sockets_ = std::move(sockets);
  asked_.reset();
  return std::nullopt;
}

/// The guard listens and never accepts, so each connection stays in its queue: where that is full, it is a guard still.
std::optional<pid_t> OutputClaims::guard_of(const Claim& claim) {
  if (asked_ && asked_->name == claim.name && is_there(asked_->socket)) {
    return asked_->guard;
  }
  asked_.reset();
  Descriptor socket = socket_or_throw();
  if (!connect_to(socket, guard_name(claim.name))) {
    return errno == EAGAIN ? std::optional<pid_t>(0) : std::nullopt;
  }
  const auto guard = trusted_peer(socket);
  if (guard) {
    asked_ = Asked{.name = claim.name, .socket = std::move(socket), .guard = *guard};
  }
  return guard;
}

bool OutputClaims::is_of_a_task(const Claim& claim) {
  const Descriptor socket = socket_or_throw();
  return connect_to(socket, claim.name) && trusted_peer(socket);
}

bool OutputClaims::end_guard() {
  // The connection ends with the guard: while it is there, the number of its process is no other's.
  const auto process = asked_ && is_there(asked_->socket) ? asked_->guard : 0;
  return process > 0 && ::kill(process, SIGKILL) == 0;
}

void OutputClaims::guard_listens() {
  guards_.clear();
  for (const Claim& claim : claims_) {
    guards_.push_back(new_socket());
    (void)bind_to(guards_.back(), guard_name(claim.name));
    (void)::listen(guards_.back().number(), SOMAXCONN);
  }
}

void OutputClaims::drain() const noexcept {
  for (const Descriptor& socket : sockets_) {
    for (int taken = 0; taken >= 0 && socket.is_open();) {
      taken = ::accept4(socket.number(), nullptr, nullptr, SOCK_CLOEXEC);
      if (taken >= 0) {
        (void)::close(taken);
      }
    }
  }
}

void look_up_hosts(RunConfig& config, std::chrono::milliseconds patience) {
  // Each name is asked for once: devices that share a connection have the same link.
  std::map<std::string, std::vector<modbus::TcpLink*>> links;
  for (modbus::DeviceOptions& device : config.devices) {
    if (auto* const link = std::get_if<modbus::TcpLink>(&device.link)) {
      links[link->host].push_back(link);
    }
  }
  std::vector<std::string> hosts;
  hosts.reserve(links.size());
  for (const auto& [host, of_host] : links) {
    hosts.push_back(host);
  }
  const auto found = modbus::addresses_within(hosts, patience);
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    for (modbus::TcpLink* const link : links[hosts[i]]) {
      link->known = found[i];
    }
  }
}

}  // namespace hysteron::runtime
