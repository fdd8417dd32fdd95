// A generated host as a package of Debian and as a container: what else stands in its folder.
#pragma once

#include <string>
#include <vector>

#include "codegen/backends/cpp/cpp.hpp"
#include "tool/host_unit.hpp"

namespace hysteron::tool {

/// Debian's packages that a host is built with, as words of a command line; `page` where it has the live page.
[[nodiscard]] std::string build_packages(bool page);

/// For the end of the host's CMakeLists.txt: `cpack` in the build folder then makes a package of Debian.
[[nodiscard]] std::string package_of_cmake(const HostNames& names);

/// The recipe of the container, and what the package does where it is installed and removed.
[[nodiscard]] std::vector<GeneratedFile> package_files(const HostNames& names, bool page);

}  // namespace hysteron::tool
