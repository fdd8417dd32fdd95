// The samples of a diagnosis, thinned and cut into blocks that are held out one at a time.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnosis/model/model.hpp"

namespace hysteron::diagnosis {

/// How the rows of a task's residuals (output by output, record by record) become those of the evidence: means of so
/// many consecutive samples, and each row in a block.
class Blocks {
 public:
  /// A run of rows of one output that lies in one block.
  struct Run {
    std::size_t output = 0;
    std::size_t block = 0;
    Index first = 0;
    Index size = 0;
  };

  /// About `wanted` blocks over all records, in each at least one; at most `most_rows` rows of each output.
  Blocks(const Task& task, std::size_t outputs, std::size_t wanted, std::size_t most_rows);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t outputs() const { return outputs_; }
  [[nodiscard]] Index rows() const { return rows_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] const std::vector<Run>& runs() const { return runs_; }
  /// Of the whole record: the step at which each block but a record's first begins, by record.
  [[nodiscard]] const std::vector<std::vector<std::size_t>>& begins() const { return begins_; }

  /// Means of consecutive samples, for each column; what is left over at a record's end is dropped.
  [[nodiscard]] MatrixXd thinned(const MatrixXd& columns) const;

 private:
  std::size_t outputs_ = 0;
  std::size_t stride_ = 1;
  std::size_t count_ = 0;
  Index rows_ = 0;
  std::vector<std::size_t> samples_{};  ///< by record
  std::vector<Run> runs_{};
  std::vector<std::vector<std::size_t>> begins_{};
};

}  // namespace hysteron::diagnosis
