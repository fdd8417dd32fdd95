#include "tool/elf_symbols.hpp"

#include <fmt/format.h>
#include <gelf.h>

#include <memory>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/text_file.hpp"

namespace hysteron::tool {
namespace {

[[noreturn]] void refuse_program(const std::string& path, std::string cause, std::string mend) {
  throw InputError(error::unfit_elf, {.file = path}, std::move(cause), std::move(mend));
}

void add_symbols(Elf* elf, Elf_Scn* section, const GElf_Shdr& header, std::vector<ElfSymbol>& variables) {
  Elf_Data* const data = elf_getdata(section, nullptr);
  if (data == nullptr || header.sh_entsize == 0) {
    return;
  }
  const std::size_t count = data->d_size / header.sh_entsize;
  for (std::size_t i = 0; i < count; ++i) {
    GElf_Sym symbol;
    if (gelf_getsym(data, static_cast<int>(i), &symbol) == nullptr) {
      return;
    }
    const auto type = GELF_ST_TYPE(symbol.st_info);
    const char* const name = elf_strptr(elf, header.sh_link, symbol.st_name);
    if (name != nullptr && symbol.st_shndx != SHN_UNDEF && (type == STT_OBJECT || type == STT_NOTYPE) &&
        name[0] != '\0') {
      variables.push_back({.name = name, .address = symbol.st_value, .size = symbol.st_size});
    }
  }
}

}  // namespace

ElfSymbols read_elf_symbols(const std::string& path) {
  std::string bytes = read_text_file(path);
  elf_version(EV_CURRENT);
  const std::unique_ptr<Elf, int (*)(Elf*)> elf(elf_memory(bytes.data(), bytes.size()), elf_end);
  GElf_Ehdr head;
  if (elf == nullptr || elf_kind(elf.get()) != ELF_K_ELF || gelf_getehdr(elf.get(), &head) == nullptr) {
    refuse_program(path, fmt::format("{} is no ELF file.", path),
                   "give the file that the linker writes before objcopy makes a .bin or .hex of it.");
  }
  if (head.e_type == ET_REL) {
    refuse_program(path, fmt::format("{} is an object file: its variables have no addresses yet.", path),
                   "give the program that the linker makes of it.");
  }
  ElfSymbols found{.variables = {}, .big_endian = head.e_ident[EI_DATA] == ELFDATA2MSB};
  for (Elf_Scn* section = elf_nextscn(elf.get(), nullptr); section != nullptr;
       section = elf_nextscn(elf.get(), section)) {
    GElf_Shdr header;
    if (gelf_getshdr(section, &header) != nullptr && header.sh_type == SHT_SYMTAB) {
      add_symbols(elf.get(), section, header, found.variables);
    }
  }
  if (found.variables.empty()) {
    refuse_program(path, fmt::format("{} has no table of symbols.", path),
                   "link it without -s, and give the file before strip.");
  }
  return found;
}

}  // namespace hysteron::tool
