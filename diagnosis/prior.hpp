// What the siblings of a machine tell before its record is looked at: how often each family of effects was there.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

namespace hysteron::diagnosis {

/// Weights of families of effects, from what the records of M siblings say by themselves.
///
/// Of a family f, p is the mean over a sibling's records of the probability that f is there, and Σp is its sum over the
/// siblings. The rate is r_f = (Σp + r₀)/(M + 1), where r₀ is the mean of Σp/M over all families of the library: as if
/// one more sibling had each family alike, so that none is ruled out. The weight is the odds of r_f over those of r₀. A
/// set of effects has the product of the weights of its families; without siblings each weight is 1.
class Prior {
 public:
  using Probabilities = std::map<std::string, double>;  ///< by family, 0 to 1

  Prior() = default;
  /// A map for each sibling.
  explicit Prior(const std::vector<Probabilities>& siblings);

  [[nodiscard]] double weight(const std::string& family) const;
  [[nodiscard]] double weight_of_set(const std::vector<std::string>& families) const;
  [[nodiscard]] std::size_t siblings() const { return siblings_; }

 private:
  std::size_t siblings_ = 0;
  double unseen_ = 1.0;  ///< the weight of a family that no sibling has
  std::map<std::string, double> weights_{};
};

/// Reads what `hysteron fleet-report --prior` wrote. A record that is among `logs`, by its bytes, is no sibling of
/// itself, and is left out. Throws InputError HY100 where the file cannot be read or is another.
[[nodiscard]] Prior read_prior(const std::string& file, const std::vector<std::string>& logs);

}  // namespace hysteron::diagnosis
