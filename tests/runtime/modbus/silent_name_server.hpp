// Of the test program's own getaddrinfo: silent.test has the address 127.0.0.9, and no answer for as long as the name
// server is silent; known.test has 127.0.0.8.
#pragma once

#include <atomic>

namespace hysteron::test {

extern std::atomic<bool> name_server_is_silent;
extern std::atomic<int> name_server_asked;  ///< in this process

}  // namespace hysteron::test
