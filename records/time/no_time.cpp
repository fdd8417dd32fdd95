#include "records/time/no_time.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "records/time/time_candidates.hpp"
#include "records/time/time_unit.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/option_words.hpp"
#include "support/rounded_text.hpp"

namespace hysteron::records {

void refuse_without_time(const Table& table) {
  const std::vector<std::size_t> rising = rising_columns(table);
  const auto counts_rows = [&](std::size_t i) {
    const std::vector<double>& values = table.columns[i].values;
    return is_one_of(table.columns[i].name, {"sample", "samples", "index", "row", "count", "counter", "scan", "number",
                                             "no", "no.", "nr", "nr.", "n", "k", "i", "#", "point", "record"}) &&
           (values.front() == 0.0 || values.front() == 1.0) &&
           std::ranges::adjacent_find(values, [](double a, double b) { return b != a + 1.0; }) == values.end();
  };
  const bool named = std::ranges::any_of(table.columns, [](const TableColumn& one) { return one.is_named; });
  std::string mend =
      "state how many rows a second it has, such as --rate 1kHz, or name its column, as --time NAME[ms].";
  if (table.stated) {
    mend = fmt::format(
        "above the rows stands \"{}\": read it with --rate {}Hz, or name the column of the time, as --time NAME[ms].",
        table.stated->words, rounded_text(1.0 / table.stated->period));
  } else if (const auto count = std::ranges::find_if(rising, counts_rows); count != rising.end()) {
    const std::string& name = table.columns[*count].name;
    mend = fmt::format(
        "column {} counts the rows: state how many there are in a second, such as --rate 1kHz; or, if it is a time, "
        "read it with --time {}.",
        name, option_value(name + "[s]"));
  } else if (!rising.empty()) {
    const std::string& name = table.columns[rising.front()].name;
    const auto unit = unit_in_name(name);
    mend = fmt::format(
        "column {} rises from row to row: if that is the time, read it with --time {}; without a "
        "time, state the rate, such as --rate 1kHz.",
        name, option_value(fmt::format("{}[{}]", name, unit ? unit->name : std::string_view("s"))));
  }
  if (!named) {
    mend += " The columns have no names: give them, as --column U=2.";
    throw InputError(error::missing_header, table.place, "There is no row of names above the numbers.", mend);
  }
  throw InputError(error::missing_column, table.place, "There is no column of time.", mend);
}

}  // namespace hysteron::records
