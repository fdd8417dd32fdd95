// The lock file of a register map: the text that keeps addresses through edits of a diagram.
//
//   # Addresses of PIEZO_FF. Keep this file with the diagram.
//   holding 0 real64 HYST.C1
//   coil 0 boolean task.commit
//   holding 4.3 boolean READY
//
// A name stands there once for each type and area that its point has had. The address of another type or area is kept
// from all others, and is the point's again with that type or area.
#pragma once

#include <string>
#include <vector>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

struct LockLine {
  std::string name{};
  RegisterType type = PointType::boolean;
  Stretch at{};
  Place place{};
};

/// The lines of a lock file that are sound; the others become errors HY820 to HY822. Holding registers end before
/// `holding_end`.
[[nodiscard]] std::vector<LockLine> read_lock(const std::string& file, const std::string& text,
                                              std::uint32_t holding_end, Diagnostics& diagnostics);

}  // namespace hysteron::runtime::modbus
