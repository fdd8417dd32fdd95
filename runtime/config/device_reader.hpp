// What a run file says of devices: how each is reached, and where on it the task's inputs and outputs lie.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "runtime/config/run_config.hpp"
#include "runtime/config/toml_reader.hpp"

namespace hysteron::runtime {

class DeviceReader {
 public:
  /// The name of the file is not copied.
  DeviceReader(const std::string& file, const ProgramShape& shape, RunConfig& config, Diagnostics& found)
      : file_(&file), shape_(&shape), config_(&config), found_(&found) {}
  DeviceReader(const std::string&& file, const ProgramShape&, RunConfig&, Diagnostics&) = delete;

  /// A table [devices.NAME]; all of them before inputs and outputs.
  void read_device(const std::string& name, TomlReader table);
  /// Of a table [outputs.NAME]: where it goes; `longest_age` in nanoseconds, 0 where none is given. An output of an
  /// integer type is limited to what the type holds.
  void read_output(std::size_t port, std::int64_t longest_age, TomlReader& table);
  /// Of a table [inputs.NAME]: where it comes from.
  void read_input(std::size_t port, std::int64_t longest_age, TomlReader& table);
  /// What can be said only once all have been read.
  void finish();

 private:
  struct Named {
    std::string name;  ///< of the value's port
    Place place;
    DeviceLink link;
    bool written = false;
  };
  struct Told {
    std::size_t port = 0;
    Tells tells = Tells::age;
    std::string of;
    Place place;
  };

  std::optional<DeviceLink> read_link(const ProgramSignal& port, bool written, std::int64_t longest_age,
                                      TomlReader& table);
  /// Where it lies and how, checked; the device is known.
  bool read_place(modbus::RemoteValue& value, modbus::WordOrder usual, TomlReader& table);
  /// HY860 as a warning, where a place on a device does not hold the declared range.
  void warn_of_range(const std::string& name, const modbus::PointFormat& format, double low, double high,
                     const TomlReader& table, const std::string& mend);
  void read_told(std::size_t port, std::string_view key, Tells tells, TomlReader& table);
  void wrong(Place place, const std::string& cause, const std::string& mend);
  void refuse_twice();

  const std::string* file_;
  const ProgramShape* shape_;
  RunConfig* config_;
  Diagnostics* found_;
  std::vector<modbus::WordOrder> orders_;  ///< by device, of values that name none
  std::vector<Named> values_;
  std::vector<Told> told_;
};

}  // namespace hysteron::runtime
