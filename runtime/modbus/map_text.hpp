// A register map in print: for spreadsheets, programs, people and C++ clients.
#pragma once

#include <string>

#include "runtime/modbus/register_map.hpp"

namespace hysteron::runtime::modbus {

/// A line a point: area,address,registers,type,name,unit,low,high,access,kind,meaning,bit,scale,offset,word_order,
/// retained (true or false).
[[nodiscard]] std::string as_csv(const RegisterMap& map);
[[nodiscard]] std::string as_json(const RegisterMap& map);
[[nodiscard]] std::string as_markdown(const RegisterMap& map);
/// A header of its own: a table and `at("HYST.C1")`, which is looked up by the compiler and refuses unknown names.
[[nodiscard]] std::string as_cpp(const RegisterMap& map);

/// What the hash of a map is of, besides its word order: the same without `retained`, which moves no value.
[[nodiscard]] std::string hashed_text(const RegisterMap& map);

/// As in many manuals: the digit of the area and the address counted from 1, 400017; of a bit, 400017.3.
[[nodiscard]] std::string reference_number(const Stretch& at);

}  // namespace hysteron::runtime::modbus
