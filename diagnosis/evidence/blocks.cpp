#include "diagnosis/evidence/blocks.hpp"

#include <algorithm>

namespace hysteron::diagnosis {

Blocks::Blocks(const Task& task, std::size_t outputs, std::size_t wanted, std::size_t most_rows) : outputs_(outputs) {
  std::size_t total = 0;
  for (const records::Record& record : task.records) {
    samples_.push_back(record.size());
    total += record.size();
  }
  stride_ = std::max<std::size_t>(1, (total + most_rows - 1) / most_rows);
  const std::size_t length = std::max<std::size_t>(1, total / wanted);
  std::vector<std::vector<std::size_t>> cuts;  // by record, in thinned rows: 0, …, all
  for (const std::size_t samples : samples_) {
    const std::size_t thin = samples / stride_;
    const std::size_t parts =
        std::clamp<std::size_t>((samples + length / 2) / length, 1, std::max<std::size_t>(1, thin));
    cuts.emplace_back();
    begins_.emplace_back();
    for (std::size_t k = 0; k <= parts; ++k) {
      cuts.back().push_back(k * thin / parts);
      if (k > 0 && k < parts) {
        begins_.back().push_back(cuts.back().back() * stride_);
      }
    }
  }
  for (std::size_t output = 0; output < outputs_; ++output) {
    std::size_t block = 0;
    for (const auto& cut : cuts) {
      for (std::size_t k = 0; k + 1 < cut.size(); ++k, ++block) {
        const auto size = static_cast<Index>(cut[k + 1] - cut[k]);
        runs_.push_back({.output = output, .block = block, .first = rows_, .size = size});
        rows_ += size;
      }
    }
    count_ = block;
  }
}

MatrixXd Blocks::thinned(const MatrixXd& columns) const {
  MatrixXd result(rows_, columns.cols());
  const auto stride = static_cast<Index>(stride_);
  Index row = 0;
  Index from = 0;
  for (std::size_t output = 0; output < outputs_; ++output) {
    for (const std::size_t samples : samples_) {
      const auto thin = static_cast<Index>(samples / stride_);
      for (Index k = 0; k < thin; ++k, ++row) {
        result.row(row) = columns.middleRows(from + k * stride, stride).colwise().mean();
      }
      from += static_cast<Index>(samples);
    }
  }
  return result;
}

}  // namespace hysteron::diagnosis
