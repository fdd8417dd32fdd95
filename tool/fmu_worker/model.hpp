// An instance of an FMU, of either version of FMI, as the worker drives it. Declarations written from the
// specifications, FMI 2.0.4 and 3.0.1.
#pragma once

#include <dlfcn.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "codegen/cosimulation/channel.hpp"

namespace hysteron::fmu_worker {

/// What the FMU returned, where it is no success.
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The binary.
class Library {
 public:
  explicit Library(const char* path);
  /// A function of the binary. Throws Refused where it has none of the name.
  template <class Signature>
  [[nodiscard]] Signature* function(const std::string& name) const {
    return reinterpret_cast<Signature*>(find(name));
  }

 private:
  [[nodiscard]] void* find(const std::string& name) const;
  void* handle_ = nullptr;
};

/// Variables of one access, in a row: FMI reads and writes them by one call.
struct Row {
  cosimulation::Access access = cosimulation::Access::Float64;
  const std::uint32_t* references = nullptr;
  std::size_t count = 0;
  void* numbers = nullptr;   ///< of the type of the access, aligned
  std::size_t elements = 0;  ///< numbers: an array of FMI 3.0 has more than one
};

class Instance {
 public:
  Instance() = default;
  virtual ~Instance() = default;
  Instance(const Instance&) = delete;
  Instance& operator=(const Instance&) = delete;

  virtual void enter_initialization() = 0;
  virtual void exit_initialization() = 0;
  virtual void set(const Row& row) = 0;
  virtual void get(const Row& row) = 0;
  virtual void step(double time, double size) = 0;
};

/// A message of the FMU, kept for the one who asks.
void keep_message(cosimulation::ChannelHead& head, int status, const char* text);

/// Throws Refused where a status is none of success: "doStep returned an error".
void require(int status, const char* function);

std::unique_ptr<Instance> new_fmi2(const Library& library, cosimulation::ChannelHead& head, std::size_t lane);
std::unique_ptr<Instance> new_fmi3(const Library& library, cosimulation::ChannelHead& head, std::size_t lane);

}  // namespace hysteron::fmu_worker
