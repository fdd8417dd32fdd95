#include "diagnosis/prior.hpp"

#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "blocks/families.hpp"
#include "support/diagnostic.hpp"
#include "support/errors.hpp"
#include "support/numbers.hpp"
#include "support/sha256.hpp"
#include "support/text_file.hpp"

namespace hysteron::diagnosis {
namespace {

constexpr std::string_view schema = "hysteron-prior/1";

double odds(double rate) {
  return rate / (1.0 - rate);
}

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError(error::unreadable_file, {.file = file}, "The file is no prior of a fleet: " + why + ".",
                   "name what `hysteron fleet-report DIR --prior FILE` wrote.");
}

/// The mean of a sibling's records, those apart that are in `own`; none where none is left.
std::optional<Prior::Probabilities> mean_of(const std::string& file, const nlohmann::json& records,
                                            const std::set<std::string>& own) {
  Prior::Probabilities sum;
  double count = 0.0;
  for (const nlohmann::json& record : records) {
    if (own.contains(record.at("log").get<std::string>())) {
      continue;
    }
    count += 1.0;
    for (const auto& [family, probability] : record.at("families").items()) {
      const double value = probability.get<double>();
      if (!(value >= 0.0 && value <= 1.0)) {
        refuse(file, "the probability of " + family + " is " + number_text(value));
      }
      sum[family] += value;
    }
  }
  if (count == 0.0) {
    return std::nullopt;
  }
  for (auto& [family, value] : sum) {
    value /= count;
  }
  return sum;
}

}  // namespace

Prior::Prior(const std::vector<Probabilities>& siblings) {
  std::map<std::string, double> sums;
  double all = 0.0;
  for (const Probabilities& one : siblings) {
    for (const auto& [family, probability] : one) {
      sums[family] += probability;
      all += probability;
    }
  }
  const auto count = static_cast<double>(siblings.size());
  if (!(all > 0.0)) {
    return;
  }
  siblings_ = siblings.size();
  const double mean = all / (count * static_cast<double>(family_texts.size()));
  const auto weight_of = [&](double sum) { return odds((sum + mean) / (count + 1.0)) / odds(mean); };
  unseen_ = weight_of(0.0);
  for (const auto& [family, sum] : sums) {
    weights_[family] = weight_of(sum);
  }
}

double Prior::weight(const std::string& family) const {
  const auto found = weights_.find(family);
  return found == weights_.end() ? unseen_ : found->second;
}

double Prior::weight_of_set(const std::vector<std::string>& families) const {
  double product = 1.0;
  for (const std::string& family : families) {
    product *= weight(family);
  }
  return product;
}

Prior read_prior(const std::string& file, const std::vector<std::string>& logs) {
  const std::string text = read_text_file(file);
  std::set<std::string> own;
  for (const std::string& log : logs) {
    own.insert(sha256(read_text_file(log)));
  }
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("schema", nlohmann::json()) != schema) {
    refuse(file, "it does not begin with \"schema\": \"" + std::string(schema) + "\"");
  }
  std::vector<Prior::Probabilities> siblings;
  try {
    for (const nlohmann::json& machine : json.at("machines")) {
      if (auto mean = mean_of(file, machine.at("records"), own)) {
        siblings.push_back(std::move(*mean));
      }
    }
  } catch (const nlohmann::json::exception& problem) {
    refuse(file, problem.what());
  }
  return Prior(siblings);
}

}  // namespace hysteron::diagnosis
