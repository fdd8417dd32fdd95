#include "codegen/backends/batch/batch.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "codegen/backends/batch/dialect.hpp"
#include "codegen/backends/batch/lanes.hpp"
#include "codegen/backends/c_family/names.hpp"
#include "codegen/backends/c_family/words.hpp"
#include "codegen/backends/cpp/cpp.hpp"
#include "codegen/backends/cpp/cpp_structs.hpp"
#include "codegen/backends/shared/generated_file.hpp"
#include "codegen/graph/fmu_block.hpp"
#include "codegen/program_hash.hpp"
#include "support/names.hpp"
#include "support/numbers.hpp"

namespace hysteron {
namespace {

const std::vector<std::string_view>& words() {
  static const std::vector<std::string_view> list = [] {
    std::vector<std::string_view> all(cpp_words.begin(), cpp_words.end());
    all.insert(all.end(), {"lanes", "width", "sample_time"});
    return all;
  }();
  return list;
}

/// A value of a member. Functions on vectors are known only to the code behind the structures.
std::string in_all_lanes(Type type, double value) {
  static const DialectOfC plain = [] {
    DialectOfC dialect = batch_dialect;
    dialect.literal_begin = "HYSTERON_ALL(";
    return dialect;
  }();
  return type == Type::Bool ? fmt::format("HYSTERON_ALL({})", value != 0.0 ? -1 : 0)
                            : literal_of(plain, type, value, false);
}

/// The counter of steps is one for all instances of a pack.
class BatchWriter final : public WriterOfC {
 public:
  using WriterOfC::WriterOfC;

 private:
  void set_cell(std::uint32_t cell, ValueId value, std::string& text) override {
    if (routine.longest_period > 1 && cell == routine.counter) {
      printer().print_cell(cell, text);
      text += " = 0;\n";
      return;
    }
    text += "lanes::set(";
    printer().print_cell(cell, text);
    end_call(value, text);
  }
  void set_output(std::uint32_t output, ValueId value, std::string& text) override {
    append(text, "lanes::set(", batch_dialect.output, layout().outputs[output]);
    end_call(value, text);
  }
  void fill_cell(std::uint32_t cell, ValueId value, std::string& text) override {
    text += "lanes::fill(";
    printer().print_cell(cell, text);
    end_call(value, text);
  }
  void end_call(ValueId value, std::string& text) const {
    text += ", ";
    expressions.print(value, text);
    text += ");\n";
  }
  [[nodiscard]] std::string_view word_for(const Value& /*value*/) const override { return "t"; }
};

/// {0}: the guard; {1}: the namespace.
constexpr std::string_view head = R"(#if !defined({0}) && !defined(HYSTERON_LANES)
#define {0}

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

#if defined(__FAST_MATH__)
#error "compile without -ffast-math: it changes what a step computes"
#endif

#if defined(__x86_64__) && !defined(__clang__)  // Clang has no pragma for functions of a wider processor
#define HYSTERON_WIDE
#include <immintrin.h>
#endif

#define HYSTERON_ALWAYS __attribute__((always_inline))
#define HYSTERON_INLINE inline HYSTERON_ALWAYS
#define HYSTERON_ALL(x) {{x, x, x, x, x, x, x, x}}
#define HYSTERON_MEMORY(type) {1}::type
#if defined(HYSTERON_BATCH_FAST) && defined(__x86_64__) && defined(__GLIBC__)
#define HYSTERON_LIBMVEC
#endif

namespace {1} {{

constexpr std::size_t width = 8;  // instances in a pack

// One value of each instance of a pack.
struct alignas(64) Real {{
  double lane[width];
}};

// The same of integers, and of truth values: FALSE is 0, TRUE is -1.
struct alignas(64) Int {{
  std::int64_t lane[width];
}};

// Functions of the C library, lane by lane. They stand outside of the code for wide registers: a processor pays for
// each change between the two.
template <class Function>
__attribute__((noinline)) Real c_library(const Real& x, Function function) {{
  Real result;
  for (std::size_t i = 0; i < width; ++i) {{
    result.lane[i] = function(x.lane[i]);
  }}
  return result;
}}
template <class Function>
__attribute__((noinline)) Real c_library(const Real& x, const Real& y, Function function) {{
  Real result;
  for (std::size_t i = 0; i < width; ++i) {{
    result.lane[i] = function(x.lane[i], y.lane[i]);
  }}
  return result;
}}

)";

/// The code is compiled for each width of registers, and the processor that it runs on chooses. {0}: the guard.
constexpr std::string_view passes = R"(// The code below, for each width of registers.
#ifdef HYSTERON_WIDE
#pragma GCC push_options
#pragma GCC target("avx512f,avx512dq,avx512vl,prefer-vector-width=512")
#define HYSTERON_LANES 8
#include "{0}.hpp"
#undef HYSTERON_LANES
#undef HYSTERON_PARTS
#pragma GCC pop_options
#pragma GCC push_options
#pragma GCC target("avx2")
#define HYSTERON_LANES 4
#include "{0}.hpp"
#undef HYSTERON_LANES
#undef HYSTERON_PARTS
#pragma GCC pop_options
#endif
#define HYSTERON_LANES 2
#include "{0}.hpp"
#undef HYSTERON_LANES
#undef HYSTERON_PARTS

namespace {0} {{

/// How many lanes a register of this processor takes: 8 with AVX-512, 4 with AVX2, else 2.
inline int lanes_of_processor() {{
#ifdef HYSTERON_WIDE
  static const int lanes = __builtin_cpu_supports("avx512dq") && __builtin_cpu_supports("avx512vl") ? 8
                           : __builtin_cpu_supports("avx2")                                       ? 4
                                                                                                  : 2;
  return lanes;
#else
  return 2;
#endif
}}

/// Puts the states of packs to their beginning.
inline void reset(std::size_t packs, const Params* params, State* state) {{ by_2::reset(packs, params, state); }}

/// One step of packs: outputs from inputs and states, and the states moved on. The width is stated for comparisons.
inline void step(std::size_t packs, const Params* params, State* state, const In* in, Out* out,
                 int lanes = lanes_of_processor()) {{
#ifdef HYSTERON_WIDE
  if (lanes == 8) {{
    return by_8::step(packs, params, state, in, out);
  }}
  if (lanes == 4) {{
    return by_4::step(packs, params, state, in, out);
  }}
#endif
  (void)lanes;
  by_2::step(packs, params, state, in, out);
}}

}}  // namespace {0}

#undef HYSTERON_ALWAYS
#undef HYSTERON_INLINE
#undef HYSTERON_ALL
#undef HYSTERON_MEMORY
#undef HYSTERON_LIBMVEC
#undef HYSTERON_WIDE

#elif defined(HYSTERON_LANES)

namespace {0} {{
#if HYSTERON_LANES == 8
namespace by_8 {{
#elif HYSTERON_LANES == 4
namespace by_4 {{
#else
namespace by_2 {{
#endif

)";

constexpr std::string_view loops = R"(
inline void reset(std::size_t packs, const Params* params, State* state) {
  for (std::size_t i = 0; i < packs; ++i) {
    reset_pack(params[i], state[i]);
  }
}

inline void step(std::size_t packs, const Params* params, State* state, const In* in, Out* out) {
  for (std::size_t i = 0; i < packs; ++i) {
    step_pack(params[i], state[i], in[i], out[i]);
  }
}

}  // namespace, by width
)";

class BatchHeader {
 public:
  explicit BatchHeader(const Program& program)
      : program_(program),
        graph_(program.graph),
        routine_(make_routine(program)),
        layout_(graph_, routine_, words()),
        printer_(graph_, routine_, layout_.names(), batch_dialect, false),
        locals_(words()),
        writer_(graph_, routine_, printer_, locals_, layout_.names(), batch_dialect),
        name_(namespace_identifier(graph_.name) + "_batch") {}

  [[nodiscard]] BatchNames names() const {
    BatchNames all{.space = name_};
    for (const Member& member : layout_.names().parameters) {
      all.parameters.push_back(std::string(member.group) + (member.group.empty() ? "" : ".") +
                               std::string(member.name));
    }
    all.inputs.assign(layout_.names().inputs.begin(), layout_.names().inputs.end());
    all.outputs.assign(layout_.names().outputs.begin(), layout_.names().outputs.end());
    return all;
  }

  GeneratedFile run() {
    std::string text = banner();
    append(text, fmt::format(head, in_capitals(name_) + "_HPP", name_));
    append_structs(text);
    append(text, "}  // namespace ", name_, "\n\n", fmt::format(passes, name_), lanes_text);
    append_functions(text);
    append(text, loops, "}  // namespace ", name_, "\n\n#endif\n");
    return {name_ + ".hpp", std::move(text)};
  }

 private:
  [[nodiscard]] std::string banner() const {
    return fmt::format(
               "// {}: generated by Hysteron from a block diagram; edit the diagram, not this file.\n//\n"
               "// Eight instances at a time, in the lanes of a vector: instance i is lane i % 8 of pack i / 8.\n"
               "// Sample time {} s. State: {} bytes an instance. Operations a step: {}.\n"
               "// Hash of diagram and parameters: {}.\n"
               "// C++17 with the vectors of GCC; Clang takes the narrowest registers. Compile with\n// {} {}:\n"
               "// then each lane has the bits that `hysteron run` shows. With -DHYSTERON_BATCH_FAST and -lmvec, exp,\n"
               "// log, pow and the like are libmvec's, within 4 units in the last place.\n//\n",
               graph_.name, number_text(graph_.sample_time()), state_bytes(routine_, false), routine_.operations,
               program_hash(program_), cpp_numeric_flags, batch_flags) +
           schedule_lines(program_, "//", "...");
  }

  void append_structs(std::string& text) const {
    CppStructs<decltype(&in_all_lanes)>{.graph = graph_,
                                        .routine = routine_,
                                        .names = layout_.names(),
                                        .dialect = batch_dialect,
                                        .literal = in_all_lanes,
                                        .in_braces = true,
                                        .counter_meaning = "of steps, the same for all instances"}
        .append_to(text);
  }

  void append_functions(std::string& text) {
    append(text, "HYSTERON_INLINE void reset_pack(const Params& params, State& state) {\n",
           "  (void)params;\n  (void)state;\n");
    std::string body;
    writer_.write_reset(body);
    append_body(text, body);
    append(text,
           "}\n\nHYSTERON_INLINE void step_pack(const Params& params, State& state, const In& "
           "in, Out& out) {\n  (void)params;\n  (void)state;\n  (void)in;\n  (void)out;\n");
    body.clear();
    writer_.write(routine_.step, body);
    writer_.write_counter(body);
    append_body(text, body);
    append(text, "}\n");
  }

  /// The sample time is known only where it is used.
  void append_body(std::string& text, const std::string& body) const {
    if (body.find("sample_time") != std::string::npos) {
      append(text, "  const Real sample_time = ", printer_.literal(Type::Real, graph_.sample_time()), ";  // s\n");
    }
    append(text, body);
  }

  const Program& program_;
  const Graph& graph_;
  Routine routine_;
  StructLayout layout_;
  PrinterOfC printer_;
  Identifiers locals_;
  BatchWriter writer_;
  std::string name_;
};

}  // namespace

GeneratedFile generate_batch(const Program& program) {
  require_generable(program.graph);
  return BatchHeader(program).run();
}

std::string lane_of_number(Type type, std::string_view number) {
  switch (type) {
    case Type::Real:
      return std::string(number);
    case Type::Bool:
      return fmt::format("({} != 0.0 ? -1 : 0)", number);
    default:
      return fmt::format("static_cast<std::int64_t>({})", number);
  }
}

std::string number_of_lane(Type type, std::string_view lane) {
  return type == Type::Bool ? fmt::format("static_cast<double>({} & 1)", lane)
                            : fmt::format("static_cast<double>({})", lane);
}

BatchNames batch_names(const Program& program) {
  require_generable(program.graph);
  return BatchHeader(program).names();
}

}  // namespace hysteron
