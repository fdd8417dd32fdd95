#include "diagnosis/effects/drivers.hpp"

#include <utility>

#include "diagnosis/model/parallel.hpp"

namespace hysteron::diagnosis {

Drivers::Drivers(const Task& task, const std::vector<Candidate>& candidates, const VectorXd& known, unsigned threads) {
  std::map<std::string, const Candidate*> first;
  for (const Candidate& candidate : candidates) {
    if (candidate.input.from != Wire::From::Nothing) {
      first.emplace(candidate.family, &candidate);
    }
  }
  const std::vector<std::pair<std::string, const Candidate*>> list(first.begin(), first.end());
  std::vector<Driven> found(list.size());
  in_parallel(list.size(), threads, [&](std::size_t i) {
    const Candidate& candidate = *list[i].second;
    std::vector<Wire> wires{candidate.input};
    if (!candidate.auxiliary.empty()) {
      wires.push_back(candidate.auxiliary.front());
    }
    std::vector<RecordSignals> values = wire_signals(task, *candidate.variant.program, wires, known);
    const double sample_time = task.records.front().sample_time();
    found[i].input_values = std::move(values.front());
    found[i].input = extent_of(found[i].input_values, sample_time);
    if (values.size() > 1) {
      found[i].auxiliary_values = std::move(values.back());
      found[i].auxiliary = extent_of(*found[i].auxiliary_values, sample_time);
    }
  });
  for (std::size_t i = 0; i < list.size(); ++i) {
    signals_.emplace(list[i].first, std::move(found[i]));
  }
}

const Driven* Drivers::find(const Candidate& candidate) const {
  const auto found = signals_.find(candidate.family);
  return found == signals_.end() ? nullptr : &found->second;
}

}  // namespace hysteron::diagnosis
