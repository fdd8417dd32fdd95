// Values within a block that are alike: each computed from the one before, or side by side. They become a local array,
// which a loop fills.
//
// Two values are alike where what is written for them differs in places of arrays alone, and these grow evenly from one
// to the next. Of a chain, x[i] = a[i] + c · x[i−1], the value before is one of these places.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "codegen/backends/shared/step_writer.hpp"

namespace hysteron {
namespace {

/// What is written for a value, in order: operations, leaves, names; and a place, of what is an element.
struct Sign {
  std::uint64_t kind = 0;
  std::uint64_t which = 0;
  std::int64_t place = 0;
  ValueId name = no_value;  ///< of a value that has a name
};
using Signs = std::vector<Sign>;

enum Kind : std::uint64_t { Operation, Leaf, OfCell, OfInput, OfParameter, OfArray, Name };

/// Reads values as what is written for them.
class SignReader {
 public:
  template <class Named>
  SignReader(const Graph& graph, const Routine& routine, const std::vector<std::pair<std::uint32_t, std::int64_t>>& at,
             Named named)
      : tape_(routine.tape), at_(at), named_(routine.tape.size()) {
    for (ValueId id = 0; id < tape_.size(); ++id) {
      named_[id] = named(id);
    }
    for (const PortGroup& group : cell_groups(routine.cells)) {
      cells_.insert(cells_.end(), group.length, group);
    }
    for (const PortGroup& group : port_groups(graph.inputs)) {
      inputs_.insert(inputs_.end(), group.length, group);
    }
  }

  [[nodiscard]] Signs of(ValueId root) const {
    Signs signs;
    read(root, true, signs);
    return signs;
  }

 private:
  void read(ValueId id, bool is_root, Signs& signs) const {
    const Value& value = tape_[id];
    if (!is_root && at_[id].first != no_value) {
      return signs.push_back({OfArray, at_[id].first, at_[id].second, id});
    }
    if (!is_root && named_[id]) {
      return signs.push_back({Name, id, 0, id});
    }
    if (value.op == Op::Cell && cells_[value.index].is_array()) {
      return signs.push_back({OfCell, cells_[value.index].first, value.index});
    }
    if (value.op == Op::Input && inputs_[value.index].is_array()) {
      return signs.push_back({OfInput, inputs_[value.index].first, value.index});
    }
    if (is_leaf(value.op)) {
      return signs.push_back({Leaf, id});
    }
    if (value.op == Op::At && is_literal(tape_[value.args[1]].op)) {
      return signs.push_back({OfParameter, value.args[0], static_cast<std::int64_t>(tape_[value.args[1]].literal)});
    }
    signs.push_back({Operation, static_cast<std::uint64_t>(value.op)});
    for (const ValueId arg : value.args) {
      if (arg != no_value) {
        read(arg, false, signs);
      }
    }
  }

  const Tape& tape_;
  const std::vector<std::pair<std::uint32_t, std::int64_t>>& at_;  ///< by value: its array, and its place in it
  std::vector<bool> named_;
  std::vector<PortGroup> cells_;   ///< by cell
  std::vector<PortGroup> inputs_;  ///< by input
};

/// Values that follow each other, as far as they are found.
struct Family {
  std::vector<ValueId> values{};
  Signs first{};
  Signs last{};
  std::vector<std::int64_t> steps{};     ///< by sign, from the second value on: by how much its place grows
  std::optional<std::size_t> chained{};  ///< the sign that is the value before

  /// Whether a value follows, and then takes it.
  bool take(ValueId id, const Signs& signs) {
    if (signs.size() != last.size()) {
      return false;
    }
    std::vector<std::int64_t> grown(signs.size());
    for (std::size_t i = 0; i < signs.size(); ++i) {
      const bool is_before = i == chained;
      if (is_before ? signs[i].name != values.back()
                    : signs[i].kind != last[i].kind || signs[i].which != last[i].which) {
        return false;
      }
      grown[i] = is_before ? 0 : signs[i].place - last[i].place;
    }
    const bool is_odd = values.size() > 1 && grown != steps;
    const bool is_still = !chained && std::ranges::all_of(grown, [](std::int64_t by) { return by == 0; });
    if (is_odd || is_still) {
      return false;
    }
    steps = std::move(grown);
    values.push_back(id);
    last = signs;
    return true;
  }
};

bool begin_chain(std::vector<Family>& found, ValueId id, const Signs& signs) {
  for (std::size_t i = 0; i < signs.size(); ++i) {
    const auto before = std::ranges::find_if(
        found, [&](const Family& one) { return one.values.size() == 1 && one.values.front() == signs[i].name; });
    if (before == found.end()) {
      continue;
    }
    Family chain = *before;
    chain.chained = i;
    if (chain.take(id, signs)) {
      *before = std::move(chain);
      return true;
    }
  }
  return false;
}

/// x[i] = f(x[i−1]), from what the first one is computed from on.
std::vector<std::vector<ValueId>> chains_of(const std::vector<ValueId>& section, const SignReader& reader) {
  std::vector<Family> found;
  for (const ValueId id : section) {
    const Signs signs = reader.of(id);
    const bool taken = std::ranges::any_of(found, [&](Family& one) { return one.chained && one.take(id, signs); });
    if (!taken && !begin_chain(found, id, signs)) {
      found.push_back({.values = {id}, .first = signs, .last = signs});
    }
  }
  std::unordered_set<ValueId> taken;
  std::vector<std::vector<ValueId>> chains;
  for (const Family& one : found) {
    if (one.values.size() < shortest_family) {
      continue;
    }
    chains.push_back(one.values);
    taken.insert(one.values.begin(), one.values.end());
    const ValueId head = one.first[*one.chained].name;
    if (head != no_value && !taken.contains(head) && std::ranges::find(section, head) != section.end()) {
      taken.insert(head);
      chains.back().insert(chains.back().begin(), head);
    }
  }
  return chains;
}

/// Whether two values differ in places alone.
bool are_alike(const Signs& a, const Signs& b) {
  return std::ranges::equal(a, b, [](const Sign& x, const Sign& y) { return x.kind == y.kind && x.which == y.which; });
}

/// y[i] = f(a[i], x[i]), by rising places.
std::vector<std::vector<ValueId>> rows_of(const std::vector<ValueId>& section, const SignReader& reader) {
  struct One {
    ValueId id;
    Signs signs;
  };
  std::vector<std::vector<One>> groups;
  for (const ValueId id : section) {
    Signs signs = reader.of(id);
    const auto group =
        std::ranges::find_if(groups, [&](const std::vector<One>& one) { return are_alike(one.front().signs, signs); });
    (group == groups.end() ? groups.emplace_back() : *group).push_back({id, std::move(signs)});
  }
  std::vector<std::vector<ValueId>> rows;
  for (std::vector<One>& group : groups) {
    std::ranges::stable_sort(group, [](const One& a, const One& b) {
      return std::ranges::lexicographical_compare(a.signs, b.signs, {}, &Sign::place, &Sign::place);
    });
    for (std::size_t i = 0; i < group.size();) {
      Family run{.values = {group[i].id}, .first = group[i].signs, .last = group[i].signs};
      for (++i; i < group.size() && run.take(group[i].id, group[i].signs); ++i) {
      }
      if (run.values.size() >= shortest_family) {
        rows.push_back(std::move(run.values));
      }
    }
  }
  return rows;
}

/// By section of a block the values that are wanted, in the order in which they are written.
template <class IsWanted>
std::vector<std::vector<ValueId>> values_by_section(const Graph& graph, const Routine& routine, IsWanted is_wanted) {
  std::vector<std::vector<ValueId>> sections(1);
  std::vector<bool> seen(routine.tape.size(), false);
  bool of_block = false;
  const auto visit = [&](const auto& self, ValueId id) -> void {
    if (id == no_value || is_leaf(routine.tape[id].op) || seen[id]) {
      return;
    }
    seen[id] = true;
    for (const ValueId arg : routine.tape[id].args) {
      self(self, arg);
    }
    if (of_block && is_wanted(id)) {
      sections.back().push_back(id);
    }
  };
  for (const Statement& one : routine.step) {
    if (one.kind == Statement::Kind::Section) {
      sections.emplace_back();
      of_block = graph.nodes[one.target].block != nullptr;
    } else {
      visit(visit, one.value);
      visit(visit, one.index);
    }
  }
  return sections;
}

}  // namespace

/// Factors of what a sum adds: where two sums read an element, each reads it where it is, and both may be loops.
void StepWriter::find_elements_in_place() {
  const Tape& tape = routine.tape;
  std::vector<bool> is_added(tape.size(), false);
  in_place_.assign(tape.size(), false);
  for (ValueId id = 0; id < tape.size(); ++id) {
    const Value& value = tape[id];
    in_place_[id] = value.op == Op::At && tape[value.args[0]].op == Op::Parameter && is_literal(tape[value.args[1]].op);
    if (routine.uses[id] > 0 && (value.op == Op::Add || value.op == Op::Subtract)) {
      is_added[value.args[1]] = true;
    }
  }
  for (ValueId id = 0; id < tape.size(); ++id) {
    const bool is_term = tape[id].op == Op::Multiply && routine.uses[id] == 1 && is_added[id];
    for (const ValueId arg : tape[id].args) {
      if (arg != no_value && routine.uses[id] > 0 && !is_term) {
        in_place_[arg] = false;
      }
    }
  }
  for (const Statement& one : routine.step) {
    if (one.kind != Statement::Kind::Section && one.value != no_value) {
      in_place_[one.value] = false;
    }
  }
}

/// Before any of them is written. Chains come first: a row may read their elements.
void StepWriter::find_families() {
  std::vector<bool> has_statement(routine.tape.size(), false);
  for (const Statement& one : routine.step) {
    if (one.kind == Statement::Kind::Define) {
      has_statement[one.value] = true;
    }
  }
  for (const bool chains : {true, false}) {
    std::vector<std::pair<std::uint32_t, std::int64_t>> at(routine.tape.size(), {no_value, 0});
    for (std::uint32_t a = 0; a < arrays_.size(); ++a) {
      for (std::size_t i = 0; i < arrays_[a].values.size(); ++i) {
        at[arrays_[a].values[i]] = {a, static_cast<std::int64_t>(i)};
      }
    }
    const SignReader reader(graph, routine, at, [this](ValueId id) { return has_name(id); });
    const auto sections = values_by_section(graph, routine, [&](ValueId id) {
      const bool must = id < must_be_named.size() && must_be_named[id];
      return needs_name(id) && !has_statement[id] && !is_output(id) && family_of_[id] == no_array && !must &&
             !shapes_.is_sum(id);
    });
    for (const std::vector<ValueId>& section : sections) {
      for (std::vector<ValueId>& values : chains ? chains_of(section, reader) : rows_of(section, reader)) {
        keep_family(std::move(values), chains);
      }
    }
    drop_families();
  }
}

void StepWriter::keep_family(std::vector<ValueId> values, bool reads_last) {
  const Type type = routine.tape[values.front()].type;
  if (std::ranges::any_of(values, [&](ValueId id) { return routine.tape[id].type != type; })) {
    return;
  }
  for (const ValueId id : values) {
    family_of_[id] = static_cast<std::uint32_t>(arrays_.size());
  }
  arrays_.push_back({.values = std::move(values), .reads_last = reads_last});
}

/// Drops those that no loop can fill. With each array more values are sums, and these have names of their own.
void StepWriter::drop_families() {
  bool all_fit = false;
  while (!all_fit) {
    find_shapes();
    all_fit = true;
    for (LocalArray& array : arrays_) {
      if (!is_in_order(array)) {
        for (const ValueId id : array.values) {
          family_of_[id] = no_array;
        }
        array.values.clear();
        all_fit = false;
      }
    }
  }
}

/// Whether a loop can compute the elements: none needs another one, but that a chain reads those before.
bool StepWriter::is_in_order(const LocalArray& array) const {
  std::unordered_map<ValueId, std::size_t> place;
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    place.emplace(array.values[i], i);
  }
  std::vector<bool> needs_element(routine.tape.size(), false);
  for (ValueId id = 0; id < routine.tape.size(); ++id) {
    needs_element[id] = std::ranges::any_of(routine.tape[id].args, [&](ValueId arg) {
      return arg != no_value && (needs_element[arg] || place.contains(arg));
    });
  }
  for (std::size_t i = 0; i < array.values.size(); ++i) {
    std::vector<ValueId> stack{array.values[i]};
    while (!stack.empty()) {
      const ValueId id = stack.back();
      stack.pop_back();
      if (array.reads_last && shapes_.is_sum(id)) {
        return false;
      }
      for (const ValueId arg : routine.tape[id].args) {
        if (arg == no_value || is_leaf(routine.tape[arg].op)) {
          continue;
        }
        if (const auto found = place.find(arg); found != place.end()) {
          if (!array.reads_last || found->second >= i) {
            return false;
          }
        } else if (!has_name(arg)) {
          stack.push_back(arg);
        } else if (needs_element[arg]) {
          return false;
        }
      }
    }
  }
  return true;
}

}  // namespace hysteron
