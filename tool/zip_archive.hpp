// A ZIP archive made in memory: the same files give the same bytes, at any time, by any user.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hysteron {

struct ArchivedFile {
  std::string name{};  ///< within the archive; folders by '/'
  std::string contents{};
  bool plain = false;  ///< kept uncompressed, so that its text can be read in the archive's bytes
};

/// The bytes of an archive with these files in this order. All have one date, the oldest that ZIP knows. Throws
/// std::runtime_error where memory ends or two files have one name.
std::string zip_archive(const std::vector<ArchivedFile>& files);

}  // namespace hysteron
