// Times of day in one number, as loggers of vehicles and receivers of GPS write them: 100059.990 is 10:00:59.990.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace hysteron::records {

/// The seconds since midnight. Nothing unless the numbers themselves show it: all are times of day, they jump at a full
/// minute, and as times of day they do not.
[[nodiscard]] std::optional<std::vector<double>> unpacked_clock(std::span<const double> numbers);

}  // namespace hysteron::records
