// A sequential body as a graph: it is executed once with wires for values.
//
// An IF executes both sides and merges them by SEL; a CASE is a chain of them; a loop is unrolled, up to where the
// ranges of its numbers end it; a RETURN, EXIT or CONTINUE under a condition merges what follows with what stood
// before. A variable that is read before it is written in the step is a cell of memory: a HY_DELAY of its type that is
// wired to what the variable holds at the end. Blocks and functions of one's own are executed in place. A block of the
// library is a node: it can be called once in a step, and under no condition, since its memory moves on in every step.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "codegen/graph/body/assigned.hpp"
#include "codegen/graph/body/computer.hpp"
#include "codegen/graph/body/globals.hpp"
#include "codegen/graph/body/place.hpp"

namespace hysteron::bodies {

/// Between which numbers a variable that is memory stays in every step: of its bits, read as a DINT.
struct MemoryRange {
  std::int64_t low = 0;
  std::int64_t high = 0;
};
using MemoryRanges = std::map<std::string, MemoryRange>;  ///< by path

/// What a body needs of the graph around it.
struct Surroundings {
  GraphBuilder& builder;
  Computer::Report report;
  std::function<Wire(Parameter)> add_parameter;  ///< one that may be set from outside
  std::string path{};                            ///< of the instance: "" or ending in a dot
  Rate rate{};
  std::int64_t sample_time_ns = 0;       ///< of one of its steps; 0: not stated
  const MemoryRanges* memory = nullptr;  ///< proved, or to be proved
  bool proving = false;                  ///< a variable that is not in it keeps its initial value, so far
};

/// A plain variable at the border of a block, or a plain one within such a variable: AXIS_POS, X[0].
struct BorderPort {
  std::string name{};
  Plain type = Plain::Bool;
  language::body::Role role = language::body::Role::Input;
  double initial = 0.0;
  language::Name written{};
  std::size_t declaration = 0;  ///< beside Unit::declarations
  std::string output{};         ///< of a VAR_IN_OUT that the body writes: X_OUT, X_OUT[0], AXIS_POS_OUT
  bool within = false;          ///< a structure
  std::optional<std::pair<double, double>> range{};  ///< of a subrange
};

/// A whole number that is memory: where it begins, and what a step leaves in it.
struct Kept {
  std::string path{};
  std::int64_t initial = 0;
  MemoryRange next{};
  MemoryRange type{};
};

class Body {
 public:
  Body(const language::body::Library& library, const language::body::Unit& unit, Surroundings around);

  /// The inputs, outputs and VAR_IN_OUT of the block: of a vector its elements X[0], X[1], …, of a structure its
  /// members AXIS_POS, AXIS_SPEED, …. An instance is reported; `in_place`, left out.
  std::vector<BorderPort> ports(bool in_place);
  /// Executes the body: `inputs` by name in upper case. Gives the wires of outputs and VAR_IN_OUT by name.
  std::map<std::string, Wire> run(const std::map<std::string, Wire>& inputs);
  /// Behind run: the whole numbers that are memory.
  [[nodiscard]] const std::vector<Kept>& kept() const { return kept_; }
  /// The global variables that are its memory.
  [[nodiscard]] std::vector<const language::body::Declaration*> shared() const {
    return file_.variables_of(*source_.unit);
  }

 private:
  /// Loops unrolled, calls executed in place: so many statements are a program, not a block.
  static constexpr std::size_t most_statements = 200'000;

  BorderPort port(std::size_t declaration, const BodyType& whole, std::string name, const Place& place);
  void check_externals();
  struct Leaf {
    Plain type = Plain::Bool;
    double initial = 0.0;
    std::string path{};
    language::Span span{};
    bool memory = true;     ///< keeps its value between steps
    bool constant = false;  ///< of the file
    std::optional<Value> cell{};
    std::uint32_t node = 0;  ///< of the cell
  };
  struct State {
    std::vector<std::optional<Value>> values{};  ///< by leaf; none: what the cell holds
    Value returned{};                            ///< whether a RETURN was met, and so on
    Value exited{};
    Value continued{};
  };
  /// A place that an access means under a condition; without one, always.
  struct Choice {
    Place* place = nullptr;
    std::optional<Value> condition{};
    int bit = -1;
  };

  // Places: body_places.cpp, and what is kept: body_memory.cpp.
  std::unique_ptr<Place> make(const TypeRef& type, const std::string& path, language::Span span, bool memory);
  void make_members(Place& place, const std::vector<Member>& members, bool memory);
  void make_pins(Place& place, const std::string& path, language::Span span);
  std::uint32_t make_leaf(Plain type, double initial, const std::string& path, language::Span span, bool memory);
  void set_initial(Place& place, const language::body::Initial& initial);
  void check_subrange(const Place& place, const Value& value, language::Span span);
  bool constant(language::ExpressionId id, double& number);
  /// A delay of one step, and the number of its node, whose first input is not wired yet.
  std::pair<Value, std::uint32_t> delay(Plain plain, double initial, const std::string& name, language::Span span);
  void feed(std::uint32_t delay, const Value& next);
  /// What a leaf held at the end of the step before.
  Value cell(std::uint32_t leaf);
  Value read(std::uint32_t leaf) { return state_.values[leaf] ? *state_.values[leaf] : cell(leaf); }
  void write(std::uint32_t leaf, const Value& value);
  std::vector<Choice> choices(const language::body::Access& access);
  bool step_into(std::vector<Choice>& list, const language::body::Step& step, const language::body::Access& access);
  bool index_into(std::vector<Choice>& list, const Value& index, language::Span span);
  Place* find(const language::body::Access& access);
  std::optional<Value> named_constant(const language::body::Access& access);
  Value read(const language::body::Access& access);
  void assign(const language::body::Access& access, const Value& value, language::Span span);
  Value taken_by(const Place& place, const Value& value, const std::string& name);
  bool refuse_constant(const language::body::Access& access);
  void close_cells();
  void restart(Place& place);

  // Arrays and structures as wholes: body_wholes.cpp.
  bool is_whole(language::ExpressionId id);
  Place* whole(language::ExpressionId id);
  void assign_whole(const language::body::Access& target, language::ExpressionId id, language::Span span);
  void assign_whole(const language::body::Access& target, Place& from, language::Span span);
  void copy(Place& to, Place& from, language::Span span, const std::optional<Value>& condition = {});
  Place* keep(const TypeRef& type, const std::string& path, const std::vector<Value>& values, language::Span span);
  std::vector<Value> values_of(const Place& place);
  std::vector<Value> values_of(const std::vector<Choice>& list);
  /// A VAR_IN_OUT of which it is not known before it runs which variable it is: a place that is copied back.
  struct Lent {
    std::vector<Choice> owners{};
    Place* place = nullptr;
  };
  Place* lend(const language::body::Access& access, std::vector<Lent>& lent);
  void take_back(const std::vector<Lent>& lent, language::Span span);
  void forget(std::size_t leaves, std::size_t wholes);

  // Statements: body_statements.cpp.
  void execute(const language::body::Statements& list, std::size_t from = 0);
  void execute(const language::body::Statement& statement);
  void choose(const Value& condition, const std::function<void()>& yes, const std::function<void()>& no);
  void branches(const std::vector<language::body::Branch>& list, std::size_t at,
                const language::body::Statements& otherwise);
  void arms(const language::body::Case& node, const Value& selector, std::size_t at);
  Value selected(const language::body::Arm& arm, const Value& selector);
  void check_labels(const language::body::Case& node, const Value& selector);
  State merged(const Value& condition, State yes, State no);
  Value stopped();

  // Loops: body_loops.cpp.
  struct Counting;
  void loop(const language::body::For& node, language::Span span);
  std::optional<Counting> counting(const language::body::For& node, language::Span span);
  bool holds(const Counting& count);
  void rounds(const Counting& count, double at);
  bool round(const Counting& count, double at);
  void loop(const language::body::Loop& node, language::Span span);
  void again(const language::body::Loop& node, language::Span span, int turn);
  void unrolled(const std::function<void()>& all_rounds);
  Value left();
  void narrow(language::ExpressionId id, bool holds);
  [[nodiscard]] bool is_plain(language::ExpressionId id) const;

  // TIME(), and the timers by it: body_clock.cpp.
  std::optional<Value> of_time(const std::string& function, language::Span span);
  std::int64_t sample_time(language::Span span);
  Value clock(language::Span span);
  Value steps();
  bool runs_by_clock(Place& place) const;
  void invoke_by_clock(Place& place, language::Span span);

  // Expressions: body_values.cpp.
  Value value(language::ExpressionId id);
  Value literal(const language::body::Literal& written);
  Value condition(language::ExpressionId id);

  // Calls: body_calls.cpp; functions of the language: body_functions.cpp.
  void invoke(const language::body::Invoke& node, language::Span span);
  void invoke_one_of(const std::vector<Choice>& list, std::size_t at, const language::body::Invoke& node);
  void invoke(Place& place, const language::body::Invoke& node);
  void invoke_unit(Place& place, const language::body::Invoke& node);
  void invoke_library(Place& place, language::Span span);
  void hand_over(Place& place, const std::vector<language::body::Argument>& arguments);
  void hand_back(Place& place, const std::vector<language::body::Argument>& arguments);
  void enter(Place& place, const Source& source);
  Value call(const language::body::Call& call, language::Span span);
  /// What a FUNCTION gives: a value, or a whole array or structure.
  struct Result {
    Value value{};
    Place* whole = nullptr;
  };
  Result call_unit(const Source& source, const language::body::Call& call, language::Span span);
  std::optional<Value> conversion(const std::string& name, const std::vector<Value>& values);
  std::optional<Value> function(const std::string& name, std::vector<Value>& values);
  std::optional<Value> of_number(const std::string& name, const std::vector<Value>& values);
  std::optional<Value> chosen(const std::string& name, std::vector<Value>& values);

  const Written& written(const Source& source);
  Value refuse(int number, language::Span span, std::string cause, std::string mend);
  [[nodiscard]] const language::body::Expression& expression(language::ExpressionId id) const {
    return source_.library->expressions[id];
  }
  [[nodiscard]] language::Span place_of(language::Span span) const { return standard_call_.value_or(span); }
  std::string path_for(std::string_view name);
  Surroundings around_;
  Computer computer_;
  Source source_;  ///< of the statements that are executed now
  Types types_;
  Globals file_;  ///< its global variables
  std::unique_ptr<Place> root_{};
  std::unique_ptr<Place> globals_{};  ///< of the file
  Place* scope_ = nullptr;
  std::vector<Leaf> leaves_{};
  std::vector<std::unique_ptr<Place>> wholes_{};  ///< results that are arrays or structures, while they are needed
  State state_{};
  int conditions_ = 0;    ///< under how many a statement stands
  int called_again_ = 0;  ///< within how many instances that are called more than once places are made
  int level_ = 0;         ///< of calls in calls
  std::size_t executed_ = 0;
  std::map<std::string, int> paths_{};
  std::set<std::string> node_paths_{};
  std::map<const language::body::Unit*, Written> written_{};
  std::vector<std::pair<std::uint32_t, language::Span>> open_pins_{};  ///< not given before their block was called
  std::set<const language::body::Loop*> endless_{};                    ///< that were told
  std::set<const language::body::Case*> cases_{};                      ///< whose labels were checked
  std::vector<Kept> kept_{};
  bool lacks_sample_time_ = false;                 ///< which was told
  std::optional<Value> clock_{};                   ///< what TIME() gives in this step
  std::optional<Value> steps_{};                   ///< and CLOCK_STEPS()
  std::optional<language::Span> standard_call_{};  ///< within a block of the standard: where it was called
};

}  // namespace hysteron::bodies
