// A name server that gives no answer for some names, for as long as a test wants: for the whole test program,
// getaddrinfo is this one, which hands all other names on.
#include "tests/runtime/modbus/silent_name_server.hpp"

#include <dlfcn.h>
#include <netdb.h>

#include <chrono>
#include <cstring>
#include <thread>

namespace {

using LookUp = int (*)(const char*, const char*, const addrinfo*, addrinfo**);

LookUp of_the_system() {
  static const auto function = reinterpret_cast<LookUp>(::dlsym(RTLD_NEXT, "getaddrinfo"));
  return function;
}

}  // namespace

namespace hysteron::test {

std::atomic<bool> name_server_is_silent{true};
std::atomic<int> name_server_asked{0};

}  // namespace hysteron::test

extern "C" __attribute__((visibility("default"))) int getaddrinfo(const char* host, const char* service,
                                                                  const addrinfo* hints, addrinfo** found) {
  using namespace hysteron::test;
  const bool is_name = host != nullptr && (hints == nullptr || (hints->ai_flags & AI_NUMERICHOST) == 0);
  if (is_name && std::strcmp(host, "silent.test") == 0) {
    ++name_server_asked;
    while (name_server_is_silent) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return of_the_system()("127.0.0.9", service, hints, found);
  }
  if (is_name && std::strcmp(host, "known.test") == 0) {
    return of_the_system()("127.0.0.8", service, hints, found);
  }
  return of_the_system()(host, service, hints, found);
}
