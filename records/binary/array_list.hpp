// The arrays of a binary file, in folders or structures, as the columns of one table.
#pragma once

#include <cstddef>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

/// Numbers in one or two dimensions, column after column.
struct NumberArray {
  std::string path{};  ///< run.speed: the names of what it lies in, and its own
  std::string unit{};
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values{};
  bool is_truth = false;
};

/// More numbers than any record has: what says so in a broken file would take all the memory.
inline constexpr std::size_t most_numbers = std::size_t{1} << 28U;

class ArrayList {
 public:
  /// A vector is a column. A matrix gives the columns NAME_1, NAME_2, …; one with fewer rows than columns, its rows.
  void add(NumberArray array);

  /// What is there and no signal. Nobody is troubled by it who does not ask for it.
  void refuse(const std::string& path, std::string cause, std::string mend);
  /// One that claims more than most_numbers.
  void refuse_size(const std::string& path);

  /// The names are as short as they can be: what all lie in is left out. Times that are the same are one. Throws
  /// InputError HY513 where there is no array of numbers.
  [[nodiscard]] Table table(const std::string& file, const ReadOptions& options);

 private:
  struct Refused {
    std::string path{};
    std::string cause{};
    std::string mend{};
  };

  void leave_out_common_names();
  void merge_times();

  std::vector<NumberArray> arrays_{};
  std::vector<Refused> refused_{};
};

/// HY513: the file is of a known format and cannot be read.
[[noreturn]] void refuse_broken(const std::string& file, std::string_view format);

/// HDF5, which reads MAT-files of version 7.3 too, serves one thread at a time.
[[nodiscard]] std::mutex& one_binary_file_at_a_time();

/// Bytes in a temporary file, for libraries that open names alone; it is gone with this.
class NamedBytes {
 public:
  explicit NamedBytes(std::string_view bytes);
  ~NamedBytes();
  NamedBytes(const NamedBytes&) = delete;
  NamedBytes& operator=(const NamedBytes&) = delete;
  NamedBytes(NamedBytes&&) = delete;
  NamedBytes& operator=(NamedBytes&&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }

 private:
  std::string name_{};
};

}  // namespace hysteron::records
