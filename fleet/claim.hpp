// The right to do something alone, among all that share a folder. It ends with its holder, however that one ends.
#pragma once

#include <filesystem>
#include <optional>
#include <utility>

namespace hysteron::fleet {

class Claim {
 public:
  /// Nothing where another holds it. The file is made and stays. Throws std::system_error where it cannot be made.
  [[nodiscard]] static std::optional<Claim> on(const std::filesystem::path& file);

  /// Waits until nobody else holds it.
  [[nodiscard]] static Claim waited_for(const std::filesystem::path& file);

  ~Claim();
  Claim(Claim&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Claim& operator=(Claim&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  Claim(const Claim&) = delete;
  Claim& operator=(const Claim&) = delete;

 private:
  explicit Claim(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace hysteron::fleet
