// Where a linked program has its variables: the symbol table of an ELF file, read by libelf.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace hysteron::tool {

struct ElfSymbol {
  std::string name{};
  std::uint64_t address = 0;
  std::uint64_t size = 0;
};

struct ElfSymbols {
  std::vector<ElfSymbol> variables{};  ///< defined in the file, of any binding
  bool big_endian = false;
};

/// Throws InputError: HY100 where the file cannot be read, HY745 where it is no linked ELF program or has no symbols.
[[nodiscard]] ElfSymbols read_elf_symbols(const std::string& path);

}  // namespace hysteron::tool
