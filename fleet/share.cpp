#include "fleet/share.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <system_error>

#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/whole_number.hpp"

namespace hysteron::fleet {
namespace {

[[noreturn]] void contradict(const std::string& cause) {
  throw InputError(error::bad_usage, {}, cause, "write --share K/N, or unset these variables.");
}

std::optional<std::size_t> number_in(const Variable& variable, const char* name) {
  const char* const text = variable(name);
  if (text == nullptr || *text == '\0') {
    return std::nullopt;
  }
  const auto value = whole_number<std::size_t>(text);
  if (!value) {
    contradict(fmt::format("{} is \"{}\", which is no whole number.", name, text));
  }
  return value;
}

/// A rank from 0 among so many.
std::optional<Share> ranked(const Variable& variable, const char* rank_name, const char* size_name) {
  const auto rank = number_in(variable, rank_name);
  const auto size = number_in(variable, size_name);
  if (!rank && !size) {
    return std::nullopt;
  }
  if (!rank || !size) {
    contradict(fmt::format("{} is set, and {} is not.", rank ? rank_name : size_name, rank ? size_name : rank_name));
  }
  if (*rank >= *size) {
    contradict(fmt::format("{} is {} and {} is {}: there is no such process.", rank_name, *rank, size_name, *size));
  }
  return Share{.part = *rank + 1, .parts = *size, .from = fmt::format("{} {} of {}", rank_name, *rank, *size)};
}

std::optional<Share> process(const Variable& variable) {
  const auto open_mpi = ranked(variable, "OMPI_COMM_WORLD_RANK", "OMPI_COMM_WORLD_SIZE");
  const auto other = ranked(variable, "PMI_RANK", "PMI_SIZE");
  if (open_mpi && other && (open_mpi->part != other->part || open_mpi->parts != other->parts)) {
    contradict(fmt::format("{}, and {}: they contradict each other.", open_mpi->from, other->from));
  }
  if (open_mpi || other) {
    return open_mpi ? open_mpi : other;  // mpirun within a step of Slurm: the numbers of srun are those of its daemons
  }
  // A batch script is process 0 of the tasks that it may start; whatever it calls without srun, it calls once.
  const auto* const step = variable("SLURM_STEP_ID");
  const auto rank = number_in(variable, "SLURM_PROCID");
  const bool is_started = (step != nullptr && *step != '\0') || rank.value_or(0) > 0;
  if (!is_started) {
    return std::nullopt;
  }
  return ranked(variable, "SLURM_PROCID",
                number_in(variable, "SLURM_STEP_NUM_TASKS") ? "SLURM_STEP_NUM_TASKS" : "SLURM_NTASKS");
}

std::optional<Share> task_of_array(const Variable& variable) {
  const auto id = number_in(variable, "SLURM_ARRAY_TASK_ID");
  if (!id) {
    return std::nullopt;
  }
  const auto count = number_in(variable, "SLURM_ARRAY_TASK_COUNT");
  const std::size_t step = std::max<std::size_t>(1, number_in(variable, "SLURM_ARRAY_TASK_STEP").value_or(1));
  const std::size_t first = number_in(variable, "SLURM_ARRAY_TASK_MIN").value_or(0);
  if (!count) {
    contradict("SLURM_ARRAY_TASK_ID is set, and SLURM_ARRAY_TASK_COUNT is not.");
  }
  const std::size_t place = *id >= first ? (*id - first) / step : *count;
  if (place >= *count || (*id - first) % step != 0) {
    contradict(
        fmt::format("SLURM_ARRAY_TASK_ID is {}, which is none of the {} tasks from {} in steps of {}. An array with "
                    "gaps has no shares.",
                    *id, *count, first, step));
  }
  return Share{.part = place + 1, .parts = *count, .from = fmt::format("SLURM_ARRAY_TASK_ID {} of {}", *id, *count)};
}

}  // namespace

Share share_of(const std::string& text) {
  Share share{.from = "--share"};
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, share.part);
  const bool divided = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = divided ? std::from_chars(first.ptr + 1, end, share.parts) : first;
  if (!divided || second.ec != std::errc() || second.ptr != end || share.part < 1 || share.part > share.parts) {
    throw InputError(error::bad_usage, {}, fmt::format("--share is \"{}\", which is no share.", text),
                     "write K/N with K from 1 to N, as 1/4.");
  }
  return share;
}

std::optional<Share> share_from(const Variable& variable) {
  const auto inner = process(variable);
  const auto outer = task_of_array(variable);
  if (!inner || !outer) {
    return inner ? inner : outer;
  }
  return Share{.part = (outer->part - 1) * inner->parts + inner->part,
               .parts = outer->parts * inner->parts,
               .from = outer->from + ", " + inner->from};
}

}  // namespace hysteron::fleet
