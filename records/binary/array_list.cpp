#include "records/binary/array_list.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include "records/column_table.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"

namespace hysteron::records {
namespace {

std::string_view last_name(std::string_view path) {
  const auto dot = path.rfind('.');
  return dot == std::string_view::npos ? path : path.substr(dot + 1);
}

bool is_time(const NumberArray& array) {
  return (array.rows == 1 || array.columns == 1) && time_name(last_name(array.path)).has_value();
}

}  // namespace

void ArrayList::add(NumberArray array) {
  if (array.values.size() > 1) {  // a constant beside the record is no signal
    arrays_.push_back(std::move(array));
  }
}

void ArrayList::refuse(const std::string& path, std::string cause, std::string mend) {
  refused_.push_back({.path = path, .cause = std::move(cause), .mend = std::move(mend)});
}

void ArrayList::refuse_size(const std::string& path) {
  refuse(path, fmt::format("{} claims more than {} numbers.", path, most_numbers), "save a shorter record.");
}

/// log.t, log.u, log.y are t, u and y.
void ArrayList::leave_out_common_names() {
  for (;;) {
    std::optional<std::string> common;
    for (const NumberArray& one : arrays_) {
      const auto dot = one.path.find('.');
      if (dot == std::string::npos || (common && one.path.compare(0, dot, *common) != 0)) {
        return;
      }
      common = one.path.substr(0, dot);
    }
    if (!common) {
      return;
    }
    for (NumberArray& one : arrays_) {
      one.path.erase(0, common->size() + 1);
    }
  }
}

/// a.t and b.t that hold the same times are one column t.
void ArrayList::merge_times() {
  const auto first = std::ranges::find_if(arrays_, is_time);
  if (first == arrays_.end()) {
    return;
  }
  std::size_t times = 0;
  for (const NumberArray& one : arrays_) {
    if (is_time(one)) {
      ++times;
      if (one.values != first->values || one.unit != first->unit) {
        return;
      }
    }
  }
  if (times > 1 || first->path.find('.') != std::string::npos) {
    const std::string name(last_name(first->path));
    NumberArray time = std::move(*first);
    time.path = name;
    std::erase_if(arrays_, [&](const NumberArray& one) { return one.values.empty() || is_time(one); });
    arrays_.insert(arrays_.begin(), std::move(time));
  }
}

Table ArrayList::table(const std::string& file, const ReadOptions& options) {
  if (arrays_.empty()) {
    throw InputError(error::unread_format, {.file = file},
                     refused_.empty() ? "The file holds no array of numbers."
                                      : fmt::format("The file holds no array of numbers; {}: {}", refused_.front().path,
                                                    refused_.front().cause),
                     refused_.empty() ? "save the time and each signal as a vector." : refused_.front().mend);
  }
  leave_out_common_names();
  merge_times();
  std::vector<NumberColumn> columns;
  for (NumberArray& one : arrays_) {
    const bool is_vector = one.rows == 1 || one.columns == 1;
    const bool by_rows = !is_vector && one.rows < one.columns;
    const std::size_t signals = is_vector ? 1 : std::min(one.rows, one.columns);
    const std::size_t length = one.values.size() / signals;
    for (std::size_t i = 0; i < signals; ++i) {
      NumberColumn column{.name = is_vector ? one.path : fmt::format("{}_{}", one.path, i + 1),
                          .unit = one.unit,
                          .is_truth = one.is_truth};
      column.values.resize(length);
      for (std::size_t k = 0; k < length; ++k) {
        column.values[k] = one.values[by_rows ? k * signals + i : i * length + k];
      }
      columns.push_back(std::move(column));
    }
  }
  for (Refused& one : refused_) {
    columns.push_back({.name = one.path,
                       .fault = Diagnostic{.number = error::text_for_number,
                                           .place = {.file = file},
                                           .cause = std::move(one.cause),
                                           .mend = std::move(one.mend)}});
  }
  return table_of(file, std::move(columns), options);
}

void refuse_broken(const std::string& file, std::string_view format) {
  throw InputError(error::unread_format, {.file = file},
                   fmt::format("The file begins as {}, and cannot be read as such: it is cut off or broken.", format),
                   "save or copy it again.");
}

std::mutex& one_binary_file_at_a_time() {
  static std::mutex mutex;
  return mutex;
}

NamedBytes::NamedBytes(std::string_view bytes)
    : name_((std::filesystem::temp_directory_path() / "hysteron-record-XXXXXX").string()) {
  const int descriptor = ::mkstemp(name_.data());
  std::size_t written = 0;
  while (descriptor >= 0 && written < bytes.size()) {
    const ssize_t now = ::write(descriptor, bytes.data() + written, bytes.size() - written);
    if (now <= 0) {
      break;
    }
    written += static_cast<std::size_t>(now);
  }
  const int reason = errno;
  if (descriptor >= 0) {
    ::close(descriptor);
  }
  if (descriptor < 0 || written < bytes.size()) {
    if (descriptor >= 0) {
      ::unlink(name_.c_str());
    }
    throw InputError(
        error::unwritable_file, {.file = name_},
        fmt::format("A temporary file for the record cannot be written: {}.", std::generic_category().message(reason)),
        "make room in the folder of temporary files, or name another by TMPDIR.");
  }
}

NamedBytes::~NamedBytes() {
  ::unlink(name_.c_str());
}

}  // namespace hysteron::records
