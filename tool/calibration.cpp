#include "tool/calibration.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <set>

#include "codegen/backends/a2l/a2l.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "support/errors.hpp"
#include "support/names.hpp"
#include "support/whole_number.hpp"
#include "tool/elf_symbols.hpp"

namespace hysteron::tool {
namespace {

[[noreturn]] void refuse_choice(std::string cause, std::string mend) {
  throw InputError(error::bad_usage, {}, std::move(cause), std::move(mend));
}

struct Named {
  A2lObject object{};
  bool by_user = false;
  bool within = false;  ///< an offset is given: the variable may hold more
};
using NamedObjects = std::array<Named, c_structure_names.size()>;

/// NAME or NAME+OFFSET; the offset in bytes, as 64 or 0x40.
bool read_symbol(std::string_view text, Named& named) {
  A2lObject& object = named.object;
  const auto plus = text.rfind('+');
  object.symbol = text.substr(0, plus);
  if (plus == std::string_view::npos) {
    return !text.empty();
  }
  named.within = true;
  std::string_view digits = text.substr(plus + 1);
  const bool hexadecimal = digits.starts_with("0x") || digits.starts_with("0X");
  digits.remove_prefix(hexadecimal ? 2 : 0);
  using Offset = decltype(object.offset);
  constexpr std::numeric_limits<Offset> limits;
  const auto offset = whole_number(digits, limits.min(), limits.max(), hexadecimal ? 16 : 10);
  object.offset = offset.value_or(0);
  return !object.symbol.empty() && offset.has_value();
}

NamedObjects named_objects(const CalibrationOptions& options) {
  NamedObjects objects;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    objects[i].object.symbol = c_structure_names[i];
  }
  for (const std::string& one : options.symbols) {
    const auto equal = one.find('=');
    const auto* const found = std::ranges::find(c_structure_names, std::string_view(one).substr(0, equal));
    Named* const named = found == c_structure_names.end() ? nullptr : &objects[found - c_structure_names.begin()];
    if (equal == std::string::npos || named == nullptr ||
        !read_symbol(std::string_view(one).substr(equal + 1), *named)) {
      refuse_choice(fmt::format("{} does not name a structure of the step and its symbol.", one),
                    fmt::format("write --symbol params=NAME or --symbol params=NAME+OFFSET; the structures are {}.",
                                fmt::join(c_structure_names, ", ")));
    }
    if (std::exchange(named->by_user, true)) {
      refuse_choice(fmt::format("The symbol of {} is given twice.", *found), "keep one of the two.");
    }
  }
  return objects;
}

/// The addresses of one program.
class Linked {
 public:
  Linked(const Program& program, const CalibrationOptions& options, bool float32)
      : path_(options.elf),
        prefix_(namespace_identifier(program.graph.name)),
        sizes_(a2l_sizes(program, float32)),
        elf_(read_elf_symbols(options.elf)) {}

  [[nodiscard]] bool big_endian() const { return elf_.big_endian; }

  void locate(std::size_t structure, Named& named, Diagnostics& warnings) const {
    A2lObject& object = named.object;
    const std::string type = fmt::format("{}_{}", prefix_, c_structure_names[structure]);
    std::vector<ElfSymbol> found;
    for (const ElfSymbol& one : elf_.variables) {
      if (one.name == object.symbol &&
          std::ranges::none_of(found, [&](const ElfSymbol& same) { return same.address == one.address; })) {
        found.push_back(one);
      }
    }
    if (found.empty() && !named.by_user && structure != static_cast<std::size_t>(CStructure::Params)) {
      object.there = false;
      warnings.warning(
          error::unfit_elf, {.file = path_},
          fmt::format("There is no variable {}: what {} holds is left out of the A2L.", object.symbol, type),
          hint(structure));
      return;
    }
    if (found.empty()) {
      refuse_elf(fmt::format("There is no variable {}.", object.symbol), near(object.symbol, structure));
    }
    if (found.size() > 1) {
      refuse_elf(fmt::format("{} variables are called {}.", found.size(), object.symbol),
                 "give the one that the step uses a name of its own.");
    }
    const ElfSymbol& symbol = found.front();
    const std::size_t size = sizes_[structure];
    const bool fits = named.within ? symbol.size >= size && object.offset <= symbol.size - size : symbol.size == size;
    if (!fits) {
      refuse_elf(
          fmt::format("{} has {} bytes, and {} has {}{}.", object.symbol, symbol.size, type, size,
                      object.offset == 0 ? "" : fmt::format(" behind {}", object.offset)),
          "link the C of this diagram, with the same --float32, for a processor that aligns numbers to their size.");
    }
    const std::uint64_t last = symbol.address + object.offset + size;
    if (last > std::numeric_limits<std::uint32_t>::max()) {
      refuse_elf(
          fmt::format("{} lies at 0x{:X}, beyond the 32 bits of an address in A2L.", object.symbol, symbol.address),
          "link it to lower addresses (-no-pie on a computer).");
    }
    object.address = static_cast<std::uint32_t>(symbol.address + object.offset);
  }

 private:
  static std::string hint(std::size_t structure) {
    return fmt::format("make it a variable outside of any function, and name it: --symbol {}=NAME.",
                       c_structure_names[structure]);
  }

  [[nodiscard]] std::string near(std::string_view name, std::size_t structure) const {
    std::vector<std::string> names;
    for (const ElfSymbol& one : elf_.variables) {
      names.push_back(one.name);
    }
    const std::string nearest(nearest_name(name, names));
    return nearest.empty() ? hint(structure) : fmt::format("did you mean {}? Else {}", nearest, hint(structure));
  }

  [[noreturn]] void refuse_elf(std::string cause, std::string mend) const {
    throw InputError(error::unfit_elf, {.file = path_}, std::move(cause), std::move(mend));
  }

  std::string path_;
  std::string prefix_;
  std::array<std::size_t, c_structure_names.size()> sizes_;
  ElfSymbols elf_;
};

}  // namespace

void check_calibration(const CalibrationOptions& options) {
  if (!options.wanted && (!options.elf.empty() || !options.symbols.empty())) {
    refuse_choice("A linked program and its symbols are for an A2L file, and none is asked for.",
                  "write --a2l, or leave out --elf and --symbol.");
  }
  (void)named_objects(options);
}

GeneratedFile calibration_file(const Program& program, const CalibrationOptions& options, bool float32,
                               Diagnostics& warnings) {
  NamedObjects objects = named_objects(options);
  A2lOptions a2l{.float32 = float32};
  if (!options.elf.empty()) {
    const Linked linked(program, options, float32);
    a2l.big_endian = linked.big_endian();
    for (std::size_t i = 0; i < objects.size(); ++i) {
      linked.locate(i, objects[i], warnings);
    }
  }
  for (std::size_t i = 0; i < objects.size(); ++i) {
    a2l.objects[i] = objects[i].object;
  }
  return generate_a2l(program, a2l);
}

}  // namespace hysteron::tool
