#include "runtime/task/retain.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "runtime/task/carry.hpp"
#include "runtime/task/layout_text.hpp"

namespace hysteron::runtime {
namespace {

constexpr std::array<char, 8> magic{'H', 'Y', 'R', 'E', 'T', 'A', 'I', '2'};
/// Of files without a description of their values.
constexpr std::array<char, 8> magic_before{'H', 'Y', 'R', 'E', 'T', 'A', 'I', '1'};
constexpr std::uint32_t polynomial = 0x82F63B78;  // Castagnoli's, reflected

constexpr std::array<std::uint32_t, 256> make_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t i = 0; i < 256; ++i) {
    std::uint32_t rest = i;
    for (int bit = 0; bit < 8; ++bit) {
      rest = (rest >> 1) ^ ((rest & 1) != 0 ? polynomial : 0);
    }
    table[i] = rest;
  }
  return table;
}

constexpr auto crc_table = make_table();

void append(std::vector<std::byte>& bytes, const void* data, std::size_t size) {
  const std::size_t at = bytes.size();
  bytes.resize(at + size);
  if (size > 0) {
    std::memcpy(bytes.data() + at, data, size);
  }
}

template <class T>
void append(std::vector<std::byte>& bytes, const T& value) {
  append(bytes, &value, sizeof(T));
}

/// Reads forward, and never beyond the end.
class Cursor {
 public:
  explicit Cursor(std::span<const std::byte> bytes) : rest_(bytes) {}
  bool read(void* into, std::size_t size) {
    if (rest_.size() < size) {
      return false;
    }
    if (size > 0) {
      std::memcpy(into, rest_.data(), size);
    }
    rest_ = rest_.subspan(size);
    return true;
  }
  /// The length of a list whose items are so many bytes; false where the rest cannot hold it.
  bool read_length(std::size_t& length, std::size_t item) {
    std::uint32_t number = 0;
    const bool read_it = read(&number, sizeof(number));
    length = number;
    return read_it && length <= rest_.size() / item;
  }
  [[nodiscard]] bool at_end() const { return rest_.empty(); }

 private:
  std::span<const std::byte> rest_;
};

bool decode(std::span<const std::byte> bytes, RetainedValues& values) {
  std::uint32_t sum = 0;
  if (bytes.size() < magic.size() + sizeof(sum)) {
    return false;
  }
  const auto body = bytes.first(bytes.size() - sizeof(sum));
  std::memcpy(&sum, bytes.data() + body.size(), sizeof(sum));
  const bool is_described = std::memcmp(body.data(), magic.data(), magic.size()) == 0;
  const bool is_of_before = std::memcmp(body.data(), magic_before.data(), magic.size()) == 0;
  if (!(is_described || is_of_before) || crc32c(body) != sum) {
    return false;
  }
  Cursor cursor(body.subspan(magic.size()));
  std::size_t length = 0;
  const auto read_text = [&](std::string& text) {
    if (!cursor.read_length(length, 1)) {
      return false;
    }
    text.resize(length);
    return cursor.read(text.data(), length);
  };
  if (!cursor.read(&values.sequence, sizeof(values.sequence)) || !read_text(values.layout) ||
      (is_described && !read_text(values.described)) || !cursor.read_length(length, sizeof(double))) {
    return false;
  }
  values.parameters.resize(length);
  if (!cursor.read(values.parameters.data(), length * sizeof(double)) || !cursor.read_length(length, 1)) {
    return false;
  }
  values.state.resize(length);
  if (!cursor.read(values.state.data(), length) || cursor.at_end()) {
    return cursor.at_end();  // a file of before there were inputs in it, or one that is cut
  }
  if (!cursor.read_length(length, sizeof(double))) {
    return false;
  }
  values.inputs.resize(length);
  return cursor.read(values.inputs.data(), length * sizeof(double)) && cursor.at_end();
}

}  // namespace

std::uint32_t crc32c(std::span<const std::byte> bytes) noexcept {
  std::uint32_t rest = ~0U;
  for (const std::byte byte : bytes) {
    rest = crc_table[(rest ^ static_cast<std::uint32_t>(byte)) & 0xFF] ^ (rest >> 8);
  }
  return ~rest;
}

std::vector<std::byte> encode_slot(const RetainedValues& values) {
  std::vector<std::byte> bytes;
  append(bytes, magic);
  append(bytes, values.sequence);
  append(bytes, static_cast<std::uint32_t>(values.layout.size()));
  append(bytes, values.layout.data(), values.layout.size());
  append(bytes, static_cast<std::uint32_t>(values.described.size()));
  append(bytes, values.described.data(), values.described.size());
  append(bytes, static_cast<std::uint32_t>(values.parameters.size()));
  append(bytes, values.parameters.data(), values.parameters.size() * sizeof(double));
  append(bytes, static_cast<std::uint32_t>(values.state.size()));
  append(bytes, values.state.data(), values.state.size());
  append(bytes, static_cast<std::uint32_t>(values.inputs.size()));
  append(bytes, values.inputs.data(), values.inputs.size() * sizeof(double));
  append(bytes, crc32c(bytes));
  return bytes;
}

Slot decode_slot(std::span<const std::byte> bytes) {
  Slot slot;
  slot.status = decode(bytes, slot.values) ? SlotStatus::whole : SlotStatus::broken;
  if (slot.status == SlotStatus::broken) {
    slot.values = {};
  }
  return slot;
}

Recovery recover(RetainFiles& files, const std::string& layout, MismatchPolicy policy, const RetainChecks& checks) {
  std::array<Slot, 2> slots;
  std::string unsound;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    if (const auto bytes = files.read(i)) {
      slots[i] = decode_slot(*bytes);
    }
    if (slots[i].status == SlotStatus::whole && slots[i].values.layout == layout && checks.not_finite) {
      if (const std::string name = checks.not_finite(slots[i].values); !name.empty()) {
        slots[i].status = SlotStatus::broken;
        unsound = name;
      }
    }
  }
  const auto sequence_of = [](const Slot& slot) { return slot.status == SlotStatus::whole ? slot.values.sequence : 0; };
  const std::size_t newest = sequence_of(slots[1]) > sequence_of(slots[0]) ? 1 : 0;
  const Slot& slot = slots[newest];
  Recovery recovery{.sequence = sequence_of(slot), .next_slot = 1 - newest};
  const bool any_broken = std::ranges::any_of(slots, [](const Slot& one) { return one.status == SlotStatus::broken; });
  const bool is_whole = slot.status == SlotStatus::whole;
  const bool is_of_layout = is_whole && diagram_of(slot.values.layout) == diagram_of(layout);
  const std::string other_unit = is_of_layout && checks.other_unit ? checks.other_unit(slot.values) : "";
  const bool is_of_diagram = is_of_layout && other_unit.empty();
  const std::string unfit = is_of_diagram && checks.refusal ? checks.refusal(slot.values) : "";
  const bool is_taken = is_of_diagram && unfit.empty() && slot.values.layout == layout;
  const bool is_of_other_engine = is_of_diagram && unfit.empty() && !is_taken && !slot.values.described.empty();
  const bool is_edited =
      policy == MismatchPolicy::carry && is_whole && !is_taken && !is_of_other_engine && !slot.values.described.empty();
  if (is_taken || is_of_other_engine || is_edited) {
    recovery.values = slot.values;
    recovery.by_name = !is_taken;
    if (!unsound.empty()) {
      recovery.note = "in one retain slot " + unsound + " was not finite; the other was taken";
      recovery.loss = "in one slot " + unsound + " is not finite. The other was taken";
    } else if (any_broken) {
      recovery.note = "one retain slot was broken; the other was taken";
      recovery.loss = "one slot is damaged: see to the disk. The other was taken";
    }
    if (any_broken) {
      recovery.loss += ", state " + std::to_string(recovery.sequence) + ": what was set after it may be lost.";
    }
    recovery.aside.at(newest) = is_edited;
    return recovery;
  }
  if (!is_whole && !any_broken) {
    recovery.next_slot = 0;
    return recovery;  // a first start
  }
  const std::string what = !unfit.empty()        ? "The retained parameters cannot be: " + unfit
                           : !other_unit.empty() ? "The retained values are of other units: " + other_unit + "."
                           : is_whole            ? "The retained values are of another diagram."
                           : !unsound.empty()    ? "No retain slot can be taken: " + unsound + " is not finite."
                                                 : "No retain slot is whole.";
  if (policy != MismatchPolicy::cold) {
    recovery.refused = what;
    recovery.refusal = !unfit.empty()     ? RetainRefusal::unfit
                       : is_whole         ? RetainRefusal::of_another
                       : !unsound.empty() ? RetainRefusal::not_finite
                                          : RetainRefusal::damaged;
    return recovery;
  }
  recovery.note = "started cold; the retained files were put aside";
  if (!is_whole) {  // to leave another diagram's is what was asked for
    recovery.loss = what + " The task begins without them, and the files are put aside.";
  }
  recovery.next_slot = 0;
  for (std::size_t i = 0; i < slots.size(); ++i) {
    recovery.aside.at(i) = slots[i].status != SlotStatus::missing;
  }
  return recovery;
}

std::string put_aside(RetainFiles& files, Recovery& recovery) {
  for (std::size_t i = 0; i < recovery.aside.size(); ++i) {
    std::string problem;
    if (recovery.aside.at(i)) {
      problem = recovery.by_name ? files.copy_aside(i) : files.put_aside(i);
    }
    if (!problem.empty()) {
      return problem;
    }
    recovery.aside.at(i) = false;
  }
  return {};
}

RetainImage::RetainImage(const StepProgram& program, std::vector<std::byte> after_reset,
                         const std::vector<std::size_t>& inputs)
    : shape_(&program.shape()),
      after_reset_(std::move(after_reset)),
      newest_(RetainedValues{.layout = program.shape().layout,
                             .described = describe(program.shape(), inputs),
                             .parameters = std::vector<double>(program.shape().parameters.size()),
                             .state = std::vector<std::byte>(program.state_size()),
                             .inputs = std::vector<double>(inputs.size())}) {}

Retainer::Retainer(RetainFiles& files, const StepProgram& program, const Recovery& start,
                   std::vector<std::byte> after_reset, std::vector<std::size_t> inputs)
    : files_(&files),
      inputs_(std::move(inputs)),
      first_(program, std::move(after_reset), inputs_),
      start_(start),
      slot_(start.next_slot),
      sequence_(start.sequence),
      written_(start.sequence) {
  writer_ = std::thread([this] {
    while (!stop_.load(std::memory_order_relaxed)) {
      write_newest();
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    write_newest();
  });
}

void Retainer::finish() {
  stop_.store(true, std::memory_order_relaxed);
  if (writer_.joinable()) {
    writer_.join();
  }
}

std::string Retainer::problem() const {
  const std::scoped_lock lock(mutex_);
  return problem_;
}

std::string Retainer::mend() const {
  const std::scoped_lock lock(mutex_);
  return mend_;
}

void Retainer::offer(const StepProgram& program, std::uint64_t commits, std::span<const double> inputs) noexcept {
  Latest<RetainedValues>& newest = image_.load(std::memory_order_relaxed)->newest_;
  RetainedValues& values = newest.filling();
  values.commits = commits;
  copy_parameters(program, values.parameters);
  program.save(values.state);
  for (std::size_t i = 0; i < values.inputs.size(); ++i) {
    values.inputs[i] = inputs[inputs_[i]];
  }
  newest.publish();
}

std::string Retainer::write(const RetainImage& image, const RetainedValues& values) {
  const std::string bad = image.after_reset_.empty() ? "" : not_finite(*image.shape_, values.state, image.after_reset_);
  if (!bad.empty()) {
    return bad + " is not finite";
  }
  const std::string problem = put_aside(*files_, start_);
  return problem.empty() ? files_->write(slot_, encode_slot(values)) : problem;
}

void Retainer::write_newest() {
  const std::scoped_lock reading(writing_);
  RetainImage& image = *image_.load(std::memory_order_acquire);
  const RetainedValues* const taken = image.newest_.take();
  if (taken == nullptr) {
    return;
  }
  RetainedValues values = *taken;
  values.sequence = sequence_ + 1;
  std::string problem = write(image, values);
  if (problem.empty()) {
    sequence_ = values.sequence;
    slot_ = 1 - slot_;
    written_.store(sequence_, std::memory_order_relaxed);
    image.written_.fetch_add(1, std::memory_order_relaxed);
    saved_commits_.store(values.commits, std::memory_order_relaxed);
  } else {
    failures_.fetch_add(1, std::memory_order_relaxed);
  }
  if (std::string remark = files_->take_remark(); !remark.empty()) {
    remarks_.say(std::move(remark));
  }
  const std::scoped_lock lock(mutex_);
  is_failing_.store(!problem.empty(), std::memory_order_relaxed);
  problem_ = std::move(problem);
  mend_ = files_->mend();
}

}  // namespace hysteron::runtime
