#include "runtime/config/history_reading.hpp"

#include "runtime/config/sampled_points.hpp"

namespace hysteron::runtime {

HistoryConfig HistoryReading::read(TomlReader table) {
  HistoryConfig history{.place = table.place("file")};
  table.require("file", "\"history.sqlite\"");
  table.read("file", history.file);
  history.step = read_step(table, *shape_, *found_);
  history.points = read_points(table, *shape_, field_points_, *found_);
  table.read_duration("keep", history.keep);
  std::uint64_t megabytes = history.bytes / 1'000'000;
  table.read_whole("megabytes", megabytes);
  history.bytes = megabytes * 1'000'000;
  return history;
}

}  // namespace hysteron::runtime
