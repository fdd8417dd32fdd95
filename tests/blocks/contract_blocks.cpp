#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "blocks/catalogue.hpp"
#include "tests/blocks/contract.hpp"
#include "tests/blocks/explicit_double.hpp"

namespace hysteron::testing {

const std::vector<ContractBlock>& contract_blocks() {
  static const std::vector<ContractBlock> blocks = [] {
    std::vector<ContractBlock> result;
    result.reserve(Catalogue::size);
    Catalogue::for_each([&]<class B> {
      result.push_back({AnyBlock::of<B>(), make_run<B, float>, make_run<B, ExplicitDouble>, FunctionBlock<B>,
                        std::is_trivially_copyable_v<typename B::template State<double>> &&
                            std::is_trivially_copyable_v<typename B::template Params<double>>});
    });
    return result;
  }();
  return blocks;
}

const ContractBlock& contract_block(std::string_view name) {
  const auto found =
      std::ranges::find(contract_blocks(), name, [](const ContractBlock& block) { return block.about->name; });
  if (found == contract_blocks().end()) {
    throw std::out_of_range(std::string(name));
  }
  return *found;
}

}  // namespace hysteron::testing
