#include "records/table.hpp"

#include <algorithm>
#include <iterator>

#include "support/names.hpp"
#include "support/whole_number.hpp"

namespace hysteron::records {

std::vector<std::string> names_of(const Table& table) {
  std::vector<std::string> names;
  names.reserve(table.columns.size());
  for (const TableColumn& column : table.columns) {
    names.push_back(column.name);
  }
  return names;
}

std::vector<std::size_t> columns_called(const Table& table, std::string_view name) {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (equal_ignoring_case(table.columns[i].name, name)) {
      found.push_back(i);
    }
  }
  if (found.size() > 1) {  // t and T: the one that is written so, where it is one alone
    std::vector<std::size_t> exact;
    std::ranges::copy_if(found, std::back_inserter(exact),
                         [&](std::size_t i) { return table.columns[i].name == name; });
    found = exact.size() == 1 ? exact : found;
  }
  const auto number = whole_number<std::size_t>(name, 1, table.columns.size());
  if (found.empty() && number) {
    found.push_back(*number - 1);
  }
  return found;
}

}  // namespace hysteron::records
