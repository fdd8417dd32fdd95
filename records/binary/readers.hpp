// The readers of binary formats: a file each, by a library that knows the format.
#pragma once

#include <string>

#include "records/read_options.hpp"
#include "records/table.hpp"

namespace hysteron::records {

// Each throws InputError HY513 where the file is broken, or holds nothing that is a signal; HY501 where it is too
// short.

/// MAT-files of versions 5 to 7.3, by matio: vectors, matrices, structures of them, and Simulink's structures with
/// time.
[[nodiscard]] Table read_mat(const std::string& file, std::string bytes, const ReadOptions& options);

/// HDF5, by its own library: data sets of numbers in one or two dimensions, and tables of numbers.
[[nodiscard]] Table read_hdf5(const std::string& file, std::string bytes, const ReadOptions& options);

/// WAV of any encoding, by libsndfile: a column for each channel.
[[nodiscard]] Table read_wav(const std::string& file, std::string bytes, const ReadOptions& options);

}  // namespace hysteron::records
