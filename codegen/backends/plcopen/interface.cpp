#include "codegen/backends/plcopen/interface.hpp"

#include <fmt/format.h>

#include "codegen/backends/st/printer.hpp"

namespace hysteron::plcopen {
namespace {

class Interface {
 public:
  Interface(const Definitions& definitions, std::uint32_t index, const KnownValues& values, const Names& names,
            const NetworkOptions& options)
      : definitions_(definitions), index_(index), values_(values), names_(names), options_(options) {}

  /// The annotations of a variable, as the text has them: they are read by people, and by an import.
  static std::string remark_of(const std::vector<language::Annotation>& annotations) {
    std::string text;
    for (const auto& one : annotations) {
      text += fmt::format("{}@{}{}{}", text.empty() ? "" : " ", one.key, one.value.empty() ? "" : " ", one.value);
    }
    return text;
  }

  [[nodiscard]] StVariable variable_of(const Declared& declared) const {
    StVariable variable{.name = names_.at(language::upper(declared.field.name)),
                        .remark = remark_of(declared.variable->annotations)};
    if (declared.kind == Declared::Kind::LibraryBlock) {
      variable.type = declared.block->about.name;
    } else if (declared.kind == Declared::Kind::UserBlock) {
      variable.type = definitions_.list[declared.definition].block->name.text;
    } else {
      variable.type = st_type(declared.field.type, options_.float32);
      if (declared.has_preset) {
        variable.values.push_back(plain(declared.field.type, declared.field.preset));
      }
    }
    if (declared.kind == Declared::Kind::Parameter) {
      if (const auto tuned = values_.parameter(index_, declared.field.name); tuned.value) {
        variable.values = {plain(declared.field.type, *tuned.value)};
      }
    }
    return variable;
  }

  [[nodiscard]] std::vector<StSection> run() const {
    std::vector<StSection> sections;
    const auto section = [&](std::string keyword, auto belongs) {
      StSection made{.keyword = std::move(keyword)};
      for (const Declared& declared : definitions_.list[index_].variables) {
        if (belongs(declared.kind)) {
          made.variables.push_back(variable_of(declared));
        }
      }
      if (!made.variables.empty()) {
        sections.push_back(std::move(made));
      }
    };
    using Kind = Declared::Kind;
    section("VAR_INPUT", [](Kind kind) { return kind == Kind::Input || kind == Kind::Parameter; });
    section("VAR_OUTPUT", [](Kind kind) { return kind == Kind::Output; });
    section("VAR CONSTANT", [](Kind kind) { return kind == Kind::Constant; });
    section("VAR",
            [](Kind kind) { return kind == Kind::Local || kind == Kind::LibraryBlock || kind == Kind::UserBlock; });
    return sections;
  }

 private:
  [[nodiscard]] std::string plain(Type type, double value) const {
    return st_literal(type, value, {.float32 = options_.float32, .small_literals = options_.small_literals});
  }

  const Definitions& definitions_;
  std::uint32_t index_;
  const KnownValues& values_;
  const Names& names_;
  const NetworkOptions& options_;
};

}  // namespace

Names names_in(const Definition& definition, Identifiers& identifiers) {
  Names names;
  for (const Declared& declared : definition.variables) {
    names[language::upper(declared.field.name)] = identifiers.make({declared.variable->name.text});
  }
  return names;
}

std::vector<StSection> interface_of(const Definitions& definitions, std::uint32_t index, const KnownValues& values,
                                    const Names& names, const NetworkOptions& options) {
  return Interface(definitions, index, values, names, options).run();
}

}  // namespace hysteron::plcopen
