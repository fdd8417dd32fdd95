// Figures of records: columns over time, one over another, and parameters over the files that hold them.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "codegen/parameters/parameter_file.hpp"
#include "plots/figure.hpp"
#include "records/record.hpp"

namespace hysteron::tool {

struct NamedRecord {
  std::string name{};  ///< in the legend
  records::Record record;
};

/// Each column over time in a panel of its own, with a gap where rows are missing, the same column of several records
/// together. Of two records with the same times, what the second has more than the first is a panel below. Units of the
/// second are brought to those of the first. Throws InputError: HY502 for a chosen column that none has, HY729 where
/// units of two do not meet.
[[nodiscard]] plots::Figure figure_over_time(std::span<const NamedRecord> records,
                                             const std::vector<std::string>& chosen = {});

/// Null where the record has no such column, or one that holds something else than numbers.
[[nodiscard]] const records::Column* readable(const records::Record& record, const std::string& name);

/// Brings columns of one name to the unit that they have in the first of the records that states one, and notes it.
/// Throws InputError HY729 where one cannot be brought there.
void bring_to_one_unit(std::span<NamedRecord> records);

/// The values of a column in a unit, where both are known; as they are where one is not. Throws InputError HY729 where
/// one cannot be brought to the other.
[[nodiscard]] std::vector<double> values_in_unit(const std::string& unit, const records::Column& column,
                                                 const records::Record& record);

/// One column over another, in all records that have the second; the first is taken from another record of the same
/// times where one lacks it, as a run has not the inputs of its record. Throws InputError HY502 where none has.
[[nodiscard]] plots::Figure figure_in_plane(std::span<const NamedRecord> records, const std::string& abscissa,
                                            const std::string& ordinate);

struct NamedParameters {
  std::string name{};
  parameters::ParameterFile file{};
};

/// Each number that stands in more than one file, over the files; those that are the same in all are left out.
[[nodiscard]] plots::Figure figure_of_parameters(std::span<const NamedParameters> files);

}  // namespace hysteron::tool
