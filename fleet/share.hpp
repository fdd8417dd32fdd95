// The share of a manifest that one of several commands works: given, or from what started them.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>

namespace hysteron::fleet {

struct Share {
  std::size_t part = 1;  ///< from 1
  std::size_t parts = 1;
  std::string from{};  ///< what says so, as `SLURM_ARRAY_TASK_ID 3 of 10`
};

/// `K/N`, both whole numbers from 1, K at most N. Throws InputError HY730.
[[nodiscard]] Share share_of(const std::string& text);

/// A variable of the environment; null where it is not set.
using Variable = std::function<const char*(const char* name)>;

/// The share by the place among the processes that Open MPI (OMPI_COMM_WORLD_RANK, _SIZE), another MPI (PMI_RANK,
/// PMI_SIZE) or Slurm's srun (SLURM_PROCID, SLURM_NTASKS) started, the innermost first, within the task of a job array
/// (SLURM_ARRAY_TASK_ID, _COUNT, _MIN, _STEP). An array of 10 tasks with 4 processes each has 40 shares. The variables
/// of srun count in a step alone: a batch script by itself has them, too, and is one command. Nothing where none is
/// set. Throws InputError HY730 where they contradict each other.
[[nodiscard]] std::optional<Share> share_from(const Variable& variable);

}  // namespace hysteron::fleet
