// The share of a command, as MPI and Slurm say it.
#include "fleet/share.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>
#include <utility>

#include "support/diagnostic.hpp"

namespace hysteron::fleet {
namespace {

using Variables = std::map<std::string, std::string>;

std::optional<Share> share_in(const Variables& variables) {
  return share_from([&](const char* name) {
    const auto found = variables.find(name);
    return found == variables.end() ? nullptr : found->second.c_str();
  });
}

std::pair<std::size_t, std::size_t> numbers_in(const Variables& variables) {
  const auto share = share_in(variables);
  return share ? std::pair(share->part, share->parts) : std::pair<std::size_t, std::size_t>(0, 0);
}

using Numbers = std::pair<std::size_t, std::size_t>;

TEST(FleetShare, IsReadFromItsText) {
  EXPECT_EQ(share_of("2/3").part, 2U);
  EXPECT_EQ(share_of("2/3").parts, 3U);
  for (const char* const text : {"", "1", "0/3", "4/3", "1/", "/3", "1/3x", "-1/3", "1 / 3"}) {
    EXPECT_THROW((void)share_of(text), InputError) << text;
  }
}

TEST(FleetShare, IsThatOfTheProcess) {
  EXPECT_FALSE(share_in({}));
  EXPECT_EQ(numbers_in({{"OMPI_COMM_WORLD_RANK", "0"}, {"OMPI_COMM_WORLD_SIZE", "4"}}), Numbers(1, 4));
  EXPECT_EQ(numbers_in({{"PMI_RANK", "3"}, {"PMI_SIZE", "4"}}), Numbers(4, 4));
  EXPECT_EQ(numbers_in({{"SLURM_STEP_ID", "0"}, {"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "4"}}), Numbers(1, 4));
  EXPECT_EQ(numbers_in({{"SLURM_PROCID", "2"}, {"SLURM_NTASKS", "4"}}), Numbers(3, 4));
  EXPECT_FALSE(share_in({{"SLURM_PROCID", "0"}, {"SLURM_NTASKS", "4"}})) << "a batch script is one command";
  EXPECT_EQ(numbers_in({{"OMPI_COMM_WORLD_RANK", "5"},
                        {"OMPI_COMM_WORLD_SIZE", "8"},
                        {"SLURM_STEP_ID", "0"},
                        {"SLURM_PROCID", "1"},
                        {"SLURM_NTASKS", "2"}}),
            Numbers(6, 8))
      << "the numbers of srun are those of the daemons of mpirun";
}

TEST(FleetShare, IsThatOfTheTaskOfAnArray) {
  const auto array = [](const char* id, const char* min, const char* step) {
    return Variables{{"SLURM_ARRAY_TASK_ID", id},
                     {"SLURM_ARRAY_TASK_COUNT", "10"},
                     {"SLURM_ARRAY_TASK_MIN", min},
                     {"SLURM_ARRAY_TASK_STEP", step}};
  };
  EXPECT_EQ(numbers_in(array("0", "0", "1")), Numbers(1, 10));
  EXPECT_EQ(numbers_in(array("10", "1", "1")), Numbers(10, 10));
  EXPECT_EQ(numbers_in(array("9", "1", "4")), Numbers(3, 10));
  EXPECT_THROW((void)share_in(array("0", "1", "1")), InputError);
  EXPECT_THROW((void)share_in(array("11", "1", "1")), InputError);
  EXPECT_THROW((void)share_in(array("3", "1", "4")), InputError);
}

TEST(FleetShare, OfArraysOfProcessesEachIsAnother) {
  std::set<Numbers> seen;
  for (int task = 0; task < 3; ++task) {
    for (int rank = 0; rank < 2; ++rank) {
      const auto share = share_in({{"SLURM_ARRAY_TASK_ID", std::to_string(task)},
                                   {"SLURM_ARRAY_TASK_COUNT", "3"},
                                   {"PMI_RANK", std::to_string(rank)},
                                   {"PMI_SIZE", "2"}});
      ASSERT_TRUE(share);
      EXPECT_EQ(share->parts, 6U);
      EXPECT_TRUE(share->part >= 1 && share->part <= 6);
      seen.emplace(share->part, share->parts);
    }
  }
  EXPECT_EQ(seen.size(), 6U);
}

TEST(FleetShare, WhatContradictsItselfIsRefused) {
  const Variables cases[] = {
      {{"PMI_RANK", "0"}},
      {{"PMI_SIZE", "2"}},
      {{"PMI_RANK", "2"}, {"PMI_SIZE", "2"}},
      {{"PMI_RANK", "x"}, {"PMI_SIZE", "2"}},
      {{"SLURM_ARRAY_TASK_ID", "1"}},
      {{"PMI_RANK", "0"}, {"PMI_SIZE", "2"}, {"OMPI_COMM_WORLD_RANK", "1"}, {"OMPI_COMM_WORLD_SIZE", "2"}},
      {{"SLURM_STEP_ID", "0"}, {"SLURM_PROCID", "4"}, {"SLURM_NTASKS", "4"}},
  };
  for (const Variables& one : cases) {
    EXPECT_THROW((void)share_in(one), InputError) << one.begin()->first;
  }
}

}  // namespace
}  // namespace hysteron::fleet
