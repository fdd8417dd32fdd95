#include "runtime/config/history_reading.hpp"

#include "runtime/config/sampled_points.hpp"
#include "support/errors.hpp"

namespace hysteron::runtime {

HistoryConfig HistoryReading::read(TomlReader table) {
  HistoryConfig history{.place = table.place()};
  if (!table.has("file")) {
    found_->error(error::wrong_run_value, table.place(), table.name() + " needs the key file.",
                  "write it as in file = \"history.sqlite\", or remove the table.");
  }
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
