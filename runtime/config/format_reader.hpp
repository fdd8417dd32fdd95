// What a run file says of how a value lies in registers, of the server or of a device: one set of keys for both.
#pragma once

#include <cstdint>
#include <optional>

#include "runtime/config/toml_reader.hpp"
#include "runtime/modbus/point_format.hpp"

namespace hysteron::runtime {

/// The keys type, scale, offset and word_order; nothing where there is none of them.
[[nodiscard]] std::optional<modbus::GivenFormat> read_format(TomlReader& table);

/// The key bit; -1 where it is not there.
[[nodiscard]] std::int8_t read_bit(TomlReader& table);

}  // namespace hysteron::runtime
