#include "bindings/c/messages.hpp"

#include <fmt/format.h>

#include <memory>

#include "support/errors.hpp"
#include "support/render.hpp"

using hysteron::Place;

namespace hysteron::bindings {
namespace {

constexpr int fault_of_library = -1;

void add_message(hysteron_messages& messages, int severity, int code, Place place, std::string cause,
                 std::string mend) {
  hysteron_messages::Message& message = messages.list.emplace_back();
  message.severity = severity;
  message.code = code;
  message.place = std::move(place);
  message.cause = std::move(cause);
  message.mend = std::move(mend);
}

hysteron_messages made_out_of_memory() {
  hysteron_messages messages;
  add_message(messages, HYSTERON_ERROR, fault_of_library, {}, "No memory is left.", "use shorter records.");
  messages.text = "error: No memory is left.\nmend: use shorter records.\n";
  return messages;
}

/// Where even the message finds no memory: it was made before.
hysteron_messages& out_of_memory() {
  static hysteron_messages messages = made_out_of_memory();
  return messages;
}

const hysteron_messages& made_at_load = out_of_memory();

const hysteron_messages::Message* at(const hysteron_messages* messages, std::size_t index) {
  return messages != nullptr && index < messages->list.size() ? &messages->list[index] : nullptr;
}

}  // namespace

void Call::note(const std::string& file, const std::vector<std::string>& notes) {
  for (const std::string& one : notes) {
    notes_.emplace_back(file, one);
  }
}

void Call::hand_out(const Diagnostics& diagnostics) const {
  auto messages = std::make_unique<hysteron_messages>();
  messages->found = diagnostics;
  messages->notes = notes_;
  messages->memory_file = memory_file_;
  messages->memory_text = memory_text_;
  messages->word_for(Caller::C);
  *out_ = messages.release();
}

void Call::tell() {
  if (out_ != nullptr && !(diagnostics_.all().empty() && notes_.empty())) {
    hand_out(diagnostics_);
  }
}

void Call::fail() noexcept {
  if (out_ == nullptr) {
    return;
  }
  try {
    try {
      throw;
    } catch (const InputError& error) {
      notes_.clear();
      hand_out(error.diagnostics());
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      auto messages = std::make_unique<hysteron_messages>();
      add_message(*messages, HYSTERON_ERROR, fault_of_library, {}, error.what(),
                  "this is a fault of the library: report it with the input.");
      messages->text = fmt::format("error: {}\n", error.what());
      *out_ = messages.release();
    }
  } catch (...) {
    *out_ = &out_of_memory();
  }
}

void require(const void* pointer, std::string_view what) {
  if (pointer == nullptr) {
    throw InputError(error::bad_usage, {}, fmt::format("{} is NULL.", what), "give one.");
  }
}

}  // namespace hysteron::bindings

void hysteron_messages::word_for(hysteron::Caller caller) {
  const hysteron::Diagnostics worded = hysteron::in_words_of(caller, found);
  hysteron::Sources sources;
  if (!memory_text.empty()) {
    sources.put(memory_file, memory_text);
  }
  hysteron_messages made;
  for (const hysteron::Diagnostic& one : worded.all()) {
    hysteron::bindings::add_message(made, one.severity == hysteron::Severity::Error ? HYSTERON_ERROR : HYSTERON_WARNING,
                                    one.number, one.place, one.cause, one.mend);
  }
  made.text = worded.all().empty() ? std::string() : hysteron::as_text(worded, sources);
  for (const auto& [file, note] : notes) {
    const std::string said = hysteron::in_words_of(caller, note);
    hysteron::bindings::add_message(made, HYSTERON_NOTE, 0, {.file = file}, said, {});
    made.text += fmt::format("note: {}: {}\n", file, said);
  }
  list = std::move(made.list);
  text = std::move(made.text);
}

using hysteron::bindings::at;

extern "C" {

int hysteron_abi(void) {
  return HYSTERON_ABI;
}

const char* hysteron_version(void) {
  return HYSTERON_VERSION;
}

size_t hysteron_messages_count(const hysteron_messages* messages) {
  return messages != nullptr ? messages->list.size() : 0;
}

int hysteron_message_severity(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->severity : HYSTERON_NOTE;
}

int hysteron_message_code(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->code : 0;
}

const char* hysteron_message_file(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->place.file.c_str() : "";
}

unsigned hysteron_message_line(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->place.line : 0;
}

unsigned hysteron_message_column(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->place.column : 0;
}

const char* hysteron_message_cause(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->cause.c_str() : "";
}

const char* hysteron_message_mend(const hysteron_messages* messages, size_t index) {
  const auto* const message = at(messages, index);
  return message != nullptr ? message->mend.c_str() : "";
}

const char* hysteron_messages_text(const hysteron_messages* messages) {
  return messages != nullptr ? messages->text.c_str() : "";
}

void hysteron_messages_for(hysteron_messages* messages, int caller) {
  const bool is_worded = messages != nullptr && !(messages->found.all().empty() && messages->notes.empty());
  if (!is_worded) {  // no memory is left, or a fault of the library: no option is named
    return;
  }
  try {
    messages->word_for(caller == HYSTERON_FOR_PYTHON ? hysteron::Caller::Python : hysteron::Caller::C);
  } catch (...) {  // no memory: they stay as they are
  }
}

void hysteron_messages_free(hysteron_messages* messages) {
  if (messages != &hysteron::bindings::out_of_memory()) {
    delete messages;
  }
}

}  // extern "C"
