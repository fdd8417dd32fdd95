// The types of a sequential body: the plain ones of IEC 61131-3 up to 32 bits, and what is made of them.
//
// In the graph there are LREAL, BOOL, DINT and WORD alone. A plain type says which of these carries it, and how many
// bits of it count: a number is taken to its width where it is kept, handed over or compared by a function.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "codegen/language/body.hpp"
#include "codegen/trace/block_type.hpp"

namespace hysteron::bodies {

enum class Plain : std::uint8_t { Bool, Sint, Int, Dint, Usint, Uint, Udint, Byte, Word, Dword, Real, Lreal, Time };

enum class Family : std::uint8_t { Truth, Whole, Bits, Number, Duration };

struct PlainInfo {
  std::string_view name;
  Family family;
  int width;
  bool below_zero;  ///< whole numbers: reaches below 0
  Type carrier;     ///< of a port
};
const PlainInfo& info(Plain type);
/// The plain type of a name, without regard to case; false where there is none.
bool plain_of(std::string_view name, Plain& type);

inline bool is_integer(Plain type) {
  return info(type).family == Family::Whole || info(type).family == Family::Bits;
}
inline bool is_number(Plain type) {
  return info(type).family == Family::Number;
}
/// 32 bits without a sign: carried by the bits of a DINT, compared and divided in a way of their own.
inline bool is_unsigned_32(Plain type) {
  return is_integer(type) && info(type).width == 32 && !info(type).below_zero;
}
std::int64_t lowest(Plain type);
std::int64_t highest(Plain type);

/// Where a body stands: its text, and the array that its expressions are in.
struct Source {
  const language::body::Library* library = nullptr;
  const language::body::Unit* unit = nullptr;
};

struct BodyType;
using TypeRef = std::shared_ptr<const BodyType>;

struct Member {
  std::string name{};  ///< in upper case
  TypeRef type{};
  const language::body::Initial* initial = nullptr;
  language::body::Role role = language::body::Role::Local;
  language::Name written{};
};

struct BodyType {
  enum class Kind : std::uint8_t { Plain, Array, Structure, Block, Library };
  Kind kind = Kind::Plain;
  Plain plain = Plain::Bool;
  std::int64_t low = 0;  ///< of an array's one dimension, further ones are arrays of arrays; or of a subrange
  std::int64_t high = 0;
  bool is_subrange = false;     ///< INT (0..100)
  bool is_enumeration = false;  ///< (OFF, ON)
  TypeRef element{};
  std::vector<Member> members{};                     ///< of a structure or a block of one's own
  Source source{};                                   ///< of a block of one's own
  const hysteron::BlockType* block = nullptr;        ///< of the library
  TypeRef by_clock{};                                ///< of a timer of the standard, of TIMEs: the block of its text
  double start = 0.0;                                ///< of an enumeration its first value, of a subrange the lowest
  const language::body::Initial* initial = nullptr;  ///< of a TYPE with a value of its own
};

/// Finds types by name, and makes them of their specification.
class Types {
 public:
  using Report = std::function<void(int, language::Span, std::string, std::string)>;
  using Constant = std::function<bool(language::ExpressionId, double&)>;

  /// `constant` computes a bound or the value of an enumeration.
  Types(const language::body::Library& library, Report report, Constant constant);

  /// Null where an error was reported.
  TypeRef resolve(const language::body::TypeSpec& spec);
  /// The members of a unit; those whose type was refused are left out.
  std::vector<Member> members(const std::vector<language::body::Declaration>& declarations);
  /// The FUNCTION or FUNCTION_BLOCK of a name, in the file or of the standard; unit is null where there is none.
  [[nodiscard]] Source find_unit(std::string_view name, bool function) const;
  /// What the file declares beside its blocks.
  [[nodiscard]] const language::body::Library& library() const { return library_; }
  /// The value of an enumeration; its type where one is named.
  bool enumerator(std::string_view type, std::string_view name, double& value);

 private:
  TypeRef named(const language::Name& name);
  TypeRef block(const Source& source);
  TypeRef array(const language::body::TypeSpec& spec);
  TypeRef subrange(const language::body::TypeSpec& spec, const TypeRef& base);
  TypeRef enumeration(const language::body::TypeSpec& spec, std::string_view name);
  void read_enumerations();

  const language::body::Library& library_;
  Report report_;
  Constant constant_;
  std::map<std::string, TypeRef> known_{};
  std::map<std::string, double> enumerators_{};  ///< by name, and by TYPE#NAME
  bool enumerations_read_ = false;
  int depth_ = 0;
};

}  // namespace hysteron::bodies
