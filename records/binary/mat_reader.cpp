// MAT-files, by matio.
#include <fmt/format.h>
#include <matio.h>

#include <cstdint>
#include <memory>
#include <utility>

#include "records/binary/array_list.hpp"
#include "records/binary/readers.hpp"
#include "records/time/time_unit.hpp"
#include "support/names.hpp"

namespace hysteron::records {
namespace {

constexpr const char* save_numbers =
    "in MATLAB, take the numbers out and save them: t = x.Time; u = x.Data; save(\"log.mat\", \"t\", \"u\").";

struct CloseMat {
  void operator()(mat_t* file) const { Mat_Close(file); }
};
struct FreeMat {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};

template <class T>
std::vector<double> numbers_of(const matvar_t& variable, std::size_t count) {
  const auto* const data = static_cast<const T*>(variable.data);
  return {data, data + count};
}

/// What kind of numbers they are, and how many; none of anything else.
std::size_t elements_of(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) {
    count *= variable.dims[i];
  }
  return count;
}

std::vector<double> numbers_of(const matvar_t& variable) {
  const std::size_t count = elements_of(variable);
  if (variable.data == nullptr || count * static_cast<std::size_t>(variable.data_size) > variable.nbytes) {
    return {};
  }
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return numbers_of<double>(variable, count);
    case MAT_C_SINGLE:
      return numbers_of<float>(variable, count);
    case MAT_C_INT8:
      return numbers_of<std::int8_t>(variable, count);
    case MAT_C_UINT8:
      return numbers_of<std::uint8_t>(variable, count);
    case MAT_C_INT16:
      return numbers_of<std::int16_t>(variable, count);
    case MAT_C_UINT16:
      return numbers_of<std::uint16_t>(variable, count);
    case MAT_C_INT32:
      return numbers_of<std::int32_t>(variable, count);
    case MAT_C_UINT32:
      return numbers_of<std::uint32_t>(variable, count);
    case MAT_C_INT64:
      return numbers_of<std::int64_t>(variable, count);
    case MAT_C_UINT64:
      return numbers_of<std::uint64_t>(variable, count);
    default:
      return {};
  }
}

bool is_number_class(const matvar_t& variable) {
  return variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
}

/// Whether a broken file claims more numbers than a record has.
bool is_too_large(const matvar_t& variable) {
  std::size_t count = 1;
  for (int i = 0; i < variable.rank; ++i) {
    if (variable.dims == nullptr || variable.dims[i] > most_numbers || (count *= variable.dims[i]) > most_numbers) {
      return true;
    }
  }
  return false;
}

std::string text_of(const matvar_t* variable) {
  std::string text;
  if (variable == nullptr || variable->class_type != MAT_C_CHAR || variable->data == nullptr) {
    return text;
  }
  const std::size_t size = variable->data_size > 0 ? static_cast<std::size_t>(variable->data_size) : 1;
  const auto* const bytes = static_cast<const unsigned char*>(variable->data);
  for (std::size_t at = 0; at + size <= variable->nbytes; at += size) {
    text += size == 1 || bytes[at + 1] == 0 ? static_cast<char>(bytes[at]) : '_';
  }
  return text;
}

class Variables {
 public:
  void take(const std::string& path, matvar_t& variable) {
    if (variable.class_type == MAT_C_STRUCT) {
      take_structure(path, variable);
    } else if (is_number_class(variable)) {
      take_numbers(path, variable);
    } else if (variable.class_type == MAT_C_OPAQUE || variable.class_type == MAT_C_OBJECT ||
               variable.class_type == MAT_C_FUNCTION) {
      list_.refuse(path, fmt::format("{} is an object of MATLAB, a timeseries, table or Dataset say.", path),
                   save_numbers);
    } else if (variable.class_type == MAT_C_CELL || variable.class_type == MAT_C_SPARSE) {
      list_.refuse(path,
                   fmt::format("{} is a {}.", path, variable.class_type == MAT_C_CELL ? "cell array" : "sparse matrix"),
                   save_numbers);
    }
  }

  [[nodiscard]] ArrayList& list() { return list_; }

 private:
  void take_numbers(const std::string& path, const matvar_t& variable) {
    if (variable.isComplex != 0) {
      list_.refuse(path, fmt::format("{} has complex numbers.", path), "save its real and its imaginary part.");
      return;
    }
    std::size_t rows = variable.rank > 0 ? variable.dims[0] : 0;
    std::size_t columns = variable.rank > 1 ? variable.dims[1] : 1;
    std::size_t deep = 1;
    for (int i = 2; i < variable.rank; ++i) {
      deep *= variable.dims[i];
    }
    if (rows == 1 && columns == 1 && deep > 1) {  // 1 × 1 × N, as timeseries of scalars are kept
      rows = deep;
      deep = 1;
    }
    if (deep > 1) {
      list_.refuse(path, fmt::format("{} has {} dimensions.", path, variable.rank), save_numbers);
      return;
    }
    std::vector<double> values = numbers_of(variable);
    if (values.size() == rows * columns) {
      list_.add({.path = path,
                 .rows = rows,
                 .columns = columns,
                 .values = std::move(values),
                 .is_truth = variable.isLogical != 0});
    }
  }

  /// Structures with time of Simulink, {time, signals}; time and data; else each field by its name.
  void take_structure(const std::string& path, matvar_t& variable) {
    const unsigned fields = Mat_VarGetNumberOfFields(&variable);
    char* const* const names = Mat_VarGetStructFieldnames(&variable);
    const std::size_t count = elements_of(variable);
    if (fields == 0 || names == nullptr || variable.data == nullptr || count == 0) {
      return;
    }
    matvar_t* const signals = Mat_VarGetStructFieldByName(&variable, "signals", 0);
    if (count == 1 && signals != nullptr && signals->class_type == MAT_C_STRUCT) {
      if (matvar_t* const time = Mat_VarGetStructFieldByName(&variable, "time", 0)) {
        take(path + ".time", *time);
      }
      take_signals(path, *signals);
      return;
    }
    if (count > 1) {
      list_.refuse(path, fmt::format("{} is an array of {} structures.", path, count), save_numbers);
      return;
    }
    const bool has_time = fields == 2 && (time_name(names[0]) || time_name(names[1]));
    for (unsigned i = 0; i < fields; ++i) {
      matvar_t* const field = Mat_VarGetStructFieldByIndex(&variable, i, 0);
      if (field != nullptr) {
        const bool is_data = has_time && is_one_of(names[i], {"data", "values", "value"});
        take(is_data ? path : path + "." + names[i], *field);
      }
    }
  }

  void take_signals(const std::string& path, matvar_t& signals) {
    const std::size_t count = elements_of(signals);
    for (std::size_t i = 0; i < count; ++i) {
      matvar_t* const values = Mat_VarGetStructFieldByName(&signals, "values", i);
      if (values == nullptr) {
        continue;
      }
      const std::string label = text_of(Mat_VarGetStructFieldByName(&signals, "label", i));
      take(!label.empty() ? path + "." + label : count == 1 ? path : fmt::format("{}_{}", path, i + 1), *values);
    }
  }

  ArrayList list_{};
};

}  // namespace

Table read_mat(const std::string& file, std::string bytes, const ReadOptions& options) {
  const std::lock_guard lock(one_binary_file_at_a_time());
  const NamedBytes named(bytes);
  Mat_LogInitFunc("hysteron", [](int, auto* /*text*/) {});  // the text is const in newer versions of matio
  const std::unique_ptr<mat_t, CloseMat> opened(Mat_Open(named.name().c_str(), MAT_ACC_RDONLY));
  if (opened == nullptr) {
    refuse_broken(file, "a MAT-file of MATLAB");
  }
  Variables variables;
  for (;;) {
    const std::unique_ptr<matvar_t, FreeMat> variable(Mat_VarReadNextInfo(opened.get()));
    if (variable == nullptr) {
      break;
    }
    const std::string name = variable->name != nullptr ? variable->name : "";
    if (name == "dataInfo") {
      throw InputError(error::unread_format, {.file = file},
                       "The file is a result of Modelica: a table of names beside two tables of numbers.",
                       "write the result as CSV: in OpenModelica, simulate(MODEL, outputFormat=\"csv\"); in Dymola, "
                       "export the signals from the plot.");
    }
    if (is_too_large(*variable)) {
      variables.list().refuse_size(name);
      continue;
    }
    const bool is_of_matlab = name.starts_with("__");  // what its objects are kept in
    if (!name.empty() && !is_of_matlab && Mat_VarReadDataAll(opened.get(), variable.get()) == 0) {
      variables.take(name, *variable);
    }
  }
  return variables.list().table(file, options);
}

}  // namespace hysteron::records
