// HDF5: data sets of numbers, and tables whose rows are structures of numbers. By its own library.
#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "records/binary/array_list.hpp"
#include "records/binary/readers.hpp"

namespace hysteron::records {
namespace {

constexpr const char* save_data_sets = "save the time and each signal as a data set of numbers in one dimension.";

/// A handle of the library, closed by the function of its kind.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle(Handle&&) = delete;
  Handle& operator=(Handle&&) = delete;

  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool good() const { return id_ >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// /run/speed as run.speed.
std::string path_of(std::string_view name) {
  std::string path(name.substr(name.starts_with('/') ? 1 : 0));
  std::ranges::replace(path, '/', '.');
  return path;
}

bool is_number_type(hid_t type) {
  const H5T_class_t kind = H5Tget_class(type);
  return kind == H5T_INTEGER || kind == H5T_FLOAT;
}

/// h5py keeps a Boolean as an enumeration of FALSE and TRUE.
bool is_truth_type(hid_t type) {
  return H5Tget_class(type) == H5T_ENUM && H5Tget_nmembers(type) == 2 && H5Tget_size(type) == 1;
}

/// The text of an attribute; empty where there is none.
std::string text_attribute(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) {
    return {};
  }
  const Handle attribute(H5Aopen(object, name, H5P_DEFAULT), &H5Aclose);
  const Handle type(attribute.good() ? H5Aget_type(attribute.id()) : -1, &H5Tclose);
  const Handle space(attribute.good() ? H5Aget_space(attribute.id()) : -1, &H5Sclose);
  if (!type.good() || !space.good() || H5Tget_class(type.id()) != H5T_STRING ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    return {};
  }
  std::string text;
  if (H5Tis_variable_str(type.id()) > 0) {
    char* value = nullptr;
    const Handle memory(H5Tcopy(type.id()), &H5Tclose);
    if (H5Aread(attribute.id(), memory.id(), static_cast<void*>(&value)) >= 0 && value != nullptr) {
      text = value;
      H5free_memory(value);
    }
  } else if (constexpr std::size_t longest = 64; H5Tget_size(type.id()) <= longest) {
    std::array<char, longest + 1> value{};
    if (H5Aread(attribute.id(), type.id(), value.data()) >= 0) {
      text = value.data();
    }
  }
  return text;
}

std::string unit_of(hid_t object) {
  for (const char* const name : {"unit", "units", "Unit", "Units", "UNIT", "UNITS"}) {
    if (std::string unit = text_attribute(object, name); !unit.empty()) {
      return unit;
    }
  }
  return {};
}

class DataSets {
 public:
  void take(hid_t file, const char* name) {
    const Handle set(H5Dopen2(file, name, H5P_DEFAULT), &H5Dclose);
    const Handle type(set.good() ? H5Dget_type(set.id()) : -1, &H5Tclose);
    const Handle space(set.good() ? H5Dget_space(set.id()) : -1, &H5Sclose);
    if (!type.good() || !space.good() || H5Sget_simple_extent_type(space.id()) != H5S_SIMPLE) {
      return;
    }
    const std::string path = path_of(name);
    std::array<hsize_t, H5S_MAX_RANK> size{};
    const int rank = H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
    hsize_t count = 1;
    for (int i = 0; i < rank; ++i) {
      if (size.at(static_cast<std::size_t>(i)) > most_numbers ||
          (count *= size.at(static_cast<std::size_t>(i))) > most_numbers) {
        list_.refuse_size(path);
        return;
      }
    }
    if (H5Tget_class(type.id()) == H5T_COMPOUND && rank == 1) {
      take_table(set.id(), type.id(), path, count);
    } else if (!is_number_type(type.id()) && !is_truth_type(type.id())) {
      list_.refuse(path, fmt::format("{} holds no numbers.", path), save_data_sets);
    } else if (rank > 2) {
      list_.refuse(path, fmt::format("{} has {} dimensions.", path, rank), save_data_sets);
    } else if (rank > 0) {
      take_numbers(set.id(), type.id(), path, size[0], rank == 2 ? size[1] : 1);
    }
  }

  [[nodiscard]] ArrayList& list() { return list_; }

 private:
  void take_numbers(hid_t set, hid_t type, const std::string& path, hsize_t rows, hsize_t columns) {
    NumberArray array{
        .path = path, .unit = unit_of(set), .rows = rows, .columns = columns, .is_truth = is_truth_type(type)};
    std::vector<double> by_rows(rows * columns);
    if (!by_rows.empty() && !read(set, type, by_rows)) {
      list_.refuse(path,
                   fmt::format("{} cannot be read: it is broken, or packed by a filter that is not installed.", path),
                   "save it again, packed by gzip or not at all.");
      return;
    }
    array.values.resize(by_rows.size());
    for (std::size_t row = 0; row < rows; ++row) {
      for (std::size_t column = 0; column < columns; ++column) {
        array.values[column * rows + row] = by_rows[row * columns + column];
      }
    }
    list_.add(std::move(array));
  }

  static bool read(hid_t set, hid_t type, std::vector<double>& values) {
    if (!is_truth_type(type)) {
      return H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
    }
    std::vector<unsigned char> bytes(values.size());
    const bool good = H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()) >= 0;
    std::ranges::copy(bytes, values.begin());
    return good;
  }

  /// Each member that is a number is a column.
  void take_table(hid_t set, hid_t type, const std::string& path, hsize_t rows) {
    const int members = H5Tget_nmembers(type);
    for (int i = 0; i < members; ++i) {
      const auto index = static_cast<unsigned>(i);
      const Handle member(H5Tget_member_type(type, index), &H5Tclose);
      char* const name = H5Tget_member_name(type, index);
      if (name == nullptr) {
        continue;
      }
      const std::string own = fmt::format("{}.{}", path, name);
      const Handle one(H5Tcreate(H5T_COMPOUND, sizeof(double)), &H5Tclose);
      std::vector<double> values(rows);
      const bool numbers = member.good() && is_number_type(member.id());
      const bool good = numbers && one.good() && H5Tinsert(one.id(), name, 0, H5T_NATIVE_DOUBLE) >= 0 &&
                        (rows == 0 || H5Dread(set, one.id(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
      H5free_memory(name);
      if (good) {
        list_.add({.path = own, .rows = rows, .columns = 1, .values = std::move(values)});
      } else {
        list_.refuse(own, fmt::format("{} {}.", own, numbers ? "cannot be read" : "holds no numbers"), save_data_sets);
      }
    }
  }

  ArrayList list_{};
};

/// The names of all data sets, in the order of their names. What H5Ovisit2 tells of each is another type since
/// HDF5 1.12.
template <class Info>
herr_t collect(hid_t /*root*/, const char* name, const Info* info, void* names) {
  if (info->type == H5O_TYPE_DATASET) {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
  }
  return 0;
}

}  // namespace

Table read_hdf5(const std::string& file, std::string bytes, const ReadOptions& options) {
  const std::lock_guard lock(one_binary_file_at_a_time());
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), &H5Pclose);
  constexpr std::size_t growth = 1U << 16U;
  if (H5Pset_fapl_core(access.id(), growth, 0) < 0 || H5Pset_file_image(access.id(), bytes.data(), bytes.size()) < 0) {
    refuse_broken(file, "HDF5");
  }
  const Handle opened(H5Fopen("record", H5F_ACC_RDONLY, access.id()), &H5Fclose);
  std::vector<std::string> names;
  if (!opened.good() || H5Ovisit2(opened.id(), H5_INDEX_NAME, H5_ITER_INC, &collect, &names, H5O_INFO_BASIC) < 0) {
    refuse_broken(file, "HDF5");
  }
  DataSets sets;
  for (const std::string& name : names) {
    sets.take(opened.id(), name.c_str());
  }
  return sets.list().table(file, options);
}

}  // namespace hysteron::records
